// history.js - the list of the open mesh's revisions, newest first; a click on a revision undoes
// all edits since.

import { formatCount, make } from '../kit/dom.js';
import { wordsOf } from '../open/entry.js';

const KINDS = ['vertices', 'edges', 'faces'];

export class History {
    #list;
    #more;
    #readPage;
    #onUndo;
    #onError;
    #shown = null; // the history whose entries are in the list
    #isEnabled = true;
    #hasFocus = false; // a button of the list was pressed, so the list keeps the focus
    #beginning = null; // the revision before the first step that can be undone
    #isTopShown = false; // whether the row of the present state is in the list

    // `readPage(cursor)` reads the next page of the history; `onUndo(revision)` is called when the
    // user chooses the revision to go back to.
    constructor({ list, more }, { readPage, onUndo, onError }) {
        this.#list = list;
        this.#more = more;
        this.#readPage = readPage;
        this.#onUndo = onUndo;
        this.#onError = onError;
        more.addEventListener('click', () => this.#readOn().catch(onError));
    }

    // Shows the first page of the history, as the server sent it.
    show(history) {
        const hadFocus = this.#hasFocus || this.#list.contains(document.activeElement);
        this.#hasFocus = false;
        this.#shown = history;
        this.#isTopShown = false;
        this.#list.replaceChildren();
        this.#append(history);
        if (hadFocus) {
            this.#list.focus(); // the element that had the focus is gone
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
        // If the mesh was edited while the page was being read, the list already shows a newer
        // history, and the page is dropped.
        if (this.#shown === first) {
            this.#append(page);
        }
    }

    #append({ entries, next, undo }) {
        const rows = entries.map((entry) => this.#row(entry));
        const first = entries.findLast((entry) => entry.undoable);
        this.#beginning = first === undefined ? this.#beginning : first.revision - 1;
        if (next === null && undo > 0) {
            const words = [make('span', { className: 'ops' }, 'original')];
            rows.push(this.#goBack(this.#beginning, words));
        }
        this.#list.append(...rows);
        this.#more.dataset.cursor = next ?? '';
        this.#more.hidden = next === null;
    }

    // Returns the row of an entry. The newest entry that can be undone is the present state, which
    // is marked; the undoable entries before it are buttons; other entries cannot be undone.
    #row(entry) {
        const { undoable } = entry;
        const words = [
            make('span', { className: 'ops' }, wordsOf(entry)),
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
                title: `Undo all edits since revision ${revision}`,
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

// Returns how many elements an edit created and deleted, as in "+6 −1".
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

// Returns how many elements of each kind an edit changed, as in "+1 vertices, +3 edges".
function tallyOf(entry) {
    return Object.keys(signs)
        .flatMap((name) => KINDS.map((kind) => [signs[name], entry[name]?.[kind] ?? 0, kind]))
        .filter(([, count]) => count > 0)
        .map(([sign, count, kind]) => `${sign}${formatCount(count)} ${kind}`)
        .join(', ');
}
