// history.js - the revisions of the open mesh, the newest first, to go back to by a click.

import { formatCount, make } from './dom.js';

const KINDS = ['vertices', 'edges', 'faces'];

export class History {
    #list;
    #more;
    #readPage;
    #onUndo;
    #onError;
    #shown = null; // the history whose entries are in the list
    #isEnabled = true;
    #hasFocus = false; // a button was pressed, which disables it
    #beginning = null; // what the first step that can be undone was taken on
    #isTopShown = false; // the state that the mesh is in has its row

    // `readPage(cursor)` reads on; `onUndo(revision)` is called when one is chosen.
    constructor({ list, more }, { readPage, onUndo, onError }) {
        this.#list = list;
        this.#more = more;
        this.#readPage = readPage;
        this.#onUndo = onUndo;
        this.#onError = onError;
        more.addEventListener('click', () => this.#readOn().catch(onError));
    }

    // The first page, as the server says it.
    show(history) {
        const hadFocus = this.#hasFocus || this.#list.contains(document.activeElement);
        this.#hasFocus = false;
        this.#shown = history;
        this.#isTopShown = false;
        this.#list.replaceChildren();
        this.#append(history);
        if (hadFocus) {
            this.#list.focus(); // what had it is not there any more
        }
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#list.querySelectorAll('button')) {
            button.disabled = !enabled;
        }
    }

    async #readOn() {
        const first = this.#shown;
        const page = await this.#readPage(this.#more.dataset.cursor);
        // An edit meanwhile begins the list anew.
        if (this.#shown === first) {
            this.#append(page);
        }
    }

    #append({ entries, next, undo }) {
        const rows = entries.map((entry) => this.#row(entry));
        const first = entries.findLast((entry) => entry.undoable);
        this.#beginning = first === undefined ? this.#beginning : first.revision - 1;
        if (next === null && undo > 0) {
            const words = [make('span', { className: 'ops' }, 'the beginning')];
            rows.push(this.#goBack(this.#beginning, words));
        }
        this.#list.append(...rows);
        this.#more.dataset.cursor = next ?? '';
        this.#more.hidden = next === null;
    }

    // The newest step that can be undone is what the mesh is now.
    #row(entry) {
        const { action, undoable } = entry;
        const ops = entry.ops.join(', ') || action;
        const words = [
            make('span', { className: 'ops' }, action === 'edit' ? ops : `${action} of ${ops}`),
            make('span', { className: 'small', title: tallyOf(entry) }, sumOf(entry)),
        ];
        if (undoable && this.#isTopShown) {
            return this.#goBack(entry.revision, words);
        }
        const row = make('li', { className: undoable ? 'entry' : 'entry passed' });
        row.append(make('span', { className: 'number' }, `${entry.revision}`), ...words);
        row.dataset.revision = entry.revision;
        if (undoable) {
            this.#isTopShown = true;
            row.setAttribute('aria-current', 'step');
        }
        return row;
    }

    #goBack(revision, words) {
        const button = make(
            'button',
            {
                type: 'button',
                className: 'entry',
                title: `Undo all since revision ${revision}`,
                disabled: !this.#isEnabled,
                onclick: () => {
                    this.#hasFocus = true;
                    this.#onUndo(revision);
                },
            },
            make('span', { className: 'number' }, `${revision}`),
            ...words,
        );
        const row = make('li', {}, button);
        row.dataset.revision = revision;
        return row;
    }
}

const signs = { created: '+', deleted: '\u2212', modified: '~' };

// "+6 −1": how many elements came and went.
function sumOf(entry) {
    return ['created', 'deleted']
        .map((name) => [
            signs[name],
            KINDS.reduce((sum, kind) => sum + (entry[name]?.[kind] ?? 0), 0),
        ])
        .filter(([, sum]) => sum > 0)
        .map(([sign, sum]) => `${sign}${formatCount(sum)}`)
        .join(' ');
}

// "+1 vertices, +3 edges": of which kinds.
function tallyOf(entry) {
    return Object.keys(signs)
        .flatMap((name) => KINDS.map((kind) => [signs[name], entry[name]?.[kind] ?? 0, kind]))
        .filter(([, count]) => count > 0)
        .map(([sign, count, kind]) => `${sign}${formatCount(count)} ${kind}`)
        .join(', ');
}
