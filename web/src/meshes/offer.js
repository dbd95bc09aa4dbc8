// offer.js - the dialog that offers repairs for a file: it says what is wrong and where, and what
// each repair would do.
//
// What the repairs do is found by trying them: the file is imported with them as a mesh of its own.
// If the user takes that mesh, it stays, else the page deletes it again, also when the page is left.

import * as api from '../wire/api.js';
import { Ask, field } from '../kit/ask.js';
import { Flag, Numeral } from '../kit/controls.js';
import { doneBy, repairWords, sizesOf } from './defects.js';
import { make } from '../kit/dom.js';
import { parametersOf } from '../wire/schema.js';

// A trial begins when the choice of repairs has not changed for this many milliseconds.
const DELAY = 300;

// The number that a repair takes, by the name of the repair: the parameter, its label, and what the
// server takes if none is given.
const NUMBERS = {
    weld: { name: 'tolerance', label: 'Largest distance', usual: '0', step: 'any' },
    fill: { name: 'hole_edges', label: 'Most edges of a hole', usual: '16', step: '1' },
};

// Opens the dialog. `batch` is the file, see batches.js; `title` and `lead` say what happened to it;
// `found` lists what is wrong, see defects.js; `chosen` are the repairs to try first; `go` is the
// label of the button that takes the repaired mesh, and `onTake(summary)` is called for it. Returns
// when the dialog is closed.
export async function offerRepairs(batch, words, { found, chosen }, onTake) {
    const parameters = parametersOf(await api.getDescription(), 'create_mesh');
    const { values } = parameters.find(({ name }) => name === 'repair');
    await new Promise((resolve) => {
        new Offer(batch, words, { found, chosen, names: values }, { onTake, onClose: resolve });
    });
}

class Offer {
    #batch;
    #onTake;
    #onClose;
    #ask;
    #repairs = new Map(); // name -> {flag, number, did}
    #outcome = make('div', { className: 'outcome', role: 'status' });
    #timer = 0;
    #running = null; // {cancel, isOver} of the trial that runs
    #made = null; // {summary, tag} of the mesh of the last trial that succeeded
    #onLeave = () => this.#discard(true);

    constructor(batch, { title, lead, go }, { found, chosen, names }, { onTake, onClose }) {
        [this.#batch, this.#onTake, this.#onClose] = [batch, onTake, onClose];
        const rows = names.map((name) => this.#row(name, chosen.includes(name)));
        this.#ask = new Ask(
            {
                title,
                go,
                onGo: () => this.#take(),
                onClose: () => this.#leave(),
                foot: [this.#outcome],
                isRead: true,
            },
            make('p', { className: 'lead' }, lead),
            make('ul', { className: 'found' }, ...found.map(placesOf)),
            make('h3', {}, 'Repairs'),
            make('div', { className: 'repairs' }, ...rows),
        );
        window.addEventListener('pagehide', this.#onLeave);
        this.#change(0);
    }

    #row(name, isChosen) {
        const [label, doc] = repairWords(name);
        const flag = new Flag(isChosen);
        const did = make('p', { className: 'did' });
        const row = field(name, label, flag, doc);
        const entry = { flag, did, number: null, box: null };
        this.#repairs.set(name, entry);
        if (NUMBERS[name] !== undefined) {
            const { name: parameter, label: text, usual, step } = NUMBERS[name];
            entry.number = new Numeral(parameter, usual, step);
            entry.box = field(parameter, text, entry.number);
            entry.box.classList.add('beside');
            row.append(entry.box);
        }
        row.append(did);
        row.addEventListener('input', () => this.#change(DELAY));
        return row;
    }

    // Called when the choice of repairs has changed: tries it after some milliseconds.
    #change(delay) {
        clearTimeout(this.#timer);
        this.#stop();
        this.#discard();
        this.#ask.setEnabled(false);
        const chosen = [...this.#repairs].filter(([, { flag }]) => flag.read());
        for (const { flag, box, did } of this.#repairs.values()) {
            did.textContent = '';
            if (box !== null) {
                box.hidden = !flag.read();
            }
        }
        if (chosen.length === 0) {
            this.#say('Choose a repair to see what it does.', false);
            return;
        }
        this.#say('', false);
        this.#timer = setTimeout(() => {
            try {
                this.#try(choicesOf(chosen));
            } catch (error) {
                this.#say(error.detail, true); // not a number
            }
        }, delay);
    }

    async #try(choices) {
        const running = { cancel: () => {}, isSafe: true, isOver: false };
        this.#running = running;
        this.#ask.start('Trying the repairs');
        const show = (part) => running.isOver || this.#ask.show(part);
        const work = {
            // The import runs on the server as a job, which can be cancelled at any time.
            begin: (cancel) => Object.assign(running, { cancel, isSafe: true }),
            show,
        };
        const onProgress = (part) => {
            // When all was sent and there is no answer yet, a mesh may be made of which the page
            // would not know, so the answer is waited for.
            running.isSafe = part < 1;
            show({ progress: part });
        };
        try {
            const summary = await api.upload(this.#batch, onProgress, work, choices);
            const made = { summary, tag: await api.getTag(summary.id) };
            if (running.isOver) {
                discard(made);
                return;
            }
            this.#made = made;
            this.#show(summary);
        } catch (error) {
            if (!running.isOver) {
                this.#say(this.#refusalOf(error), true);
            }
        } finally {
            if (!running.isOver) {
                running.isOver = true;
                this.#ask.end();
            }
        }
    }

    #show(summary) {
        for (const report of summary.import.repairs) {
            this.#repairs.get(report.repair).did.textContent = doneBy(report);
        }
        this.#say(`The repaired mesh has ${sizesOf(summary)}.`, false);
        this.#ask.setEnabled(true);
    }

    // Returns why a trial was refused, and which repairs would be needed as well.
    #refusalOf({ detail, message, repair }) {
        const [why] = (detail || message).split('; the body is accepted with');
        const missing = repair.filter((name) => !this.#repairs.get(name)?.flag.read());
        const labels = missing.map((name) => repairWords(name)[0]);
        const end = labels.length > 0 ? ` Also needed: ${labels.join('; ')}.` : '';
        return `These repairs are not enough: ${why}.${end}`;
    }

    #say(text, isRefused) {
        this.#outcome.textContent = text;
        this.#outcome.classList.toggle('refused', isRefused);
    }

    // Stops the trial that runs. If its mesh is made all the same, #try() deletes the mesh.
    #stop() {
        const running = this.#running;
        if (running !== null && !running.isOver) {
            running.isOver = true;
            this.#ask.end();
            if (running.isSafe) {
                Promise.resolve(running.cancel()).catch(() => {});
            }
        }
    }

    #discard(isLeaving = false) {
        if (this.#made !== null) {
            discard(this.#made, isLeaving);
            this.#made = null;
        }
    }

    async #take() {
        const { summary } = this.#made;
        this.#made = null;
        await this.#onTake(summary);
    }

    #leave() {
        window.removeEventListener('pagehide', this.#onLeave);
        clearTimeout(this.#timer);
        this.#stop();
        this.#discard();
        this.#onClose();
    }
}

// Returns the query parameters for an import with repairs. Throws a Problem for a mistake in a
// number.
function choicesOf(chosen) {
    const choices = { repair: chosen.map(([name]) => name).join(',') };
    for (const [name, { number }] of chosen) {
        const value = number?.read();
        if (value !== undefined) {
            choices[NUMBERS[name].name] = value;
        }
    }
    return choices;
}

// Deletes the mesh of a trial. If that fails, another client has changed the mesh, which then
// stays, or the server is gone.
function discard({ summary, tag }, isLeaving = false) {
    api.remove(summary.id, tag, isLeaving).catch(() => {});
}

// Returns a row that says what is wrong, and on demand where.
function placesOf({ text, where, more }) {
    if (where.length === 0) {
        return make('li', {}, text);
    }
    const places = where.map((place) => make('li', {}, place));
    const rest = more > 0 ? [make('li', {}, `and ${more} more`)] : [];
    return make(
        'li',
        {},
        make(
            'details',
            {},
            make('summary', {}, text, make('span', { className: 'small' }, ' \u2013 where?')),
            make('ul', { className: 'places' }, ...places, ...rest),
        ),
    );
}
