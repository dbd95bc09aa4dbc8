// mend.js - one way to mend a finding of the check lens: it is tried first, its result is shown
// in words, and a button then does it.

import { formatCount, make } from '../kit/dom.js';

// If operations of a mend are refused, the others are tried again without them, at most this often.
const MOST_REFUSED = 32;

let count = 0;

export class Mend {
    node;

    #mend;
    #acts;
    #button;
    #words;
    #trying = new AbortController();
    #operations = null; // what the button does; null until it was tried
    #isEnabled;

    // `mend` is described in mends.js. `acts` has functions: facesOf(face, signal) reads the
    // faces of a component; attempt(operations, signal) makes a dry run and returns its result in
    // words, or throws a Problem; run(operations, done) does them.
    constructor(mend, isEnabled, acts) {
        this.#mend = mend;
        this.#acts = acts;
        this.#isEnabled = isEnabled;
        const id = `mend-${++count}`;
        this.#words = make('p', { id, className: 'small', role: 'status' });
        this.#button = make(
            'button',
            {
                type: 'button',
                disabled: true,
                'aria-describedby': id,
                onclick: () => this.#acts.run(this.#operations, mend.done),
            },
            mend.label,
        );
        this.node = make('div', { className: 'mend' }, this.#button, this.#words);
    }

    setEnabled(isEnabled) {
        this.#isEnabled = isEnabled;
        this.#button.disabled = !isEnabled || this.#operations === null;
    }

    // Ends a trial whose result nobody needs any more.
    cancel() {
        this.#trying.abort();
    }

    // Makes the dry run and shows what it says.
    async attempt() {
        const { signal } = this.#trying;
        this.#say('Trying\u2026', false);
        try {
            const all = await this.#mend.make((face) => this.#acts.facesOf(face, signal));
            const tried = await this.#tryMost(all, signal);
            if (!signal.aborted) {
                this.#show(tried, all.length);
            }
        } catch (error) {
            if (!signal.aborted) {
                this.#say(`Not possible: ${error.detail || error.message}`, true);
            }
        }
    }

    // Tries operations; if one of several parts is refused, tries the others without it. Returns
    // {operations, words, refusal}, where `refusal` is the first refusal, or undefined.
    async #tryMost(all, signal) {
        let operations = all;
        let refusal;
        for (let refused = 0; ; refused++) {
            try {
                return { operations, words: await this.#acts.attempt(operations, signal), refusal };
            } catch (error) {
                const [, at] = /^\/ops\/(\d+)/.exec(error.pointer ?? '') ?? [];
                const isPart = this.#mend.parts !== undefined && at !== undefined;
                if (!isPart || operations.length === 1 || refused === MOST_REFUSED) {
                    throw refusal ?? error;
                }
                refusal ??= error;
                operations = operations.filter((one, i) => i !== Number(at));
            }
        }
    }

    #show({ operations, words, refusal }, total) {
        const left = total - operations.length;
        if (left > 0) {
            const [one, many] = this.#mend.parts;
            const names = left === 1 ? `1 ${one} is` : `${formatCount(left)} ${many} are`;
            const why = refusal.detail || refusal.message;
            this.#say(`${words} But ${names} left out: ${why}`, false);
        } else {
            this.#say(words, false);
        }
        this.#operations = operations;
        this.setEnabled(this.#isEnabled);
    }

    #say(text, isRefused) {
        this.#words.textContent = text;
        this.#words.classList.toggle('refused', isRefused);
    }
}
