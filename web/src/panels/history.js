// history.js - the list of the open mesh's revisions, newest first; a click on a revision undoes
// all edits since. Each revision can be looked at and named.

import { formatCount, make } from '../kit/dom.js';
import { wordsOfTime } from '../kit/when.js';
import { wordsOf } from '../open/entry.js';
import { momentButtons } from '../time/moments.js';

const KINDS = ['vertices', 'edges', 'faces'];

export class History {
    #list;
    #more;
    #readPage;
    #onUndo;
    #onReturn;
    #acts;
    #shown = null; // the history whose entries are in the list
    #isEnabled = true;
    #hasFocus = false; // a button of the list was pressed, so the list keeps the focus
    #beginning = null; // the revision before the first step that can be undone
    #isTopShown = false; // whether the row of the present state is in the list
    #mesh = null;
    #kept = null; // a row of the history before, whose revision is not in the list yet

    // `readPage(cursor)` reads the next page of the history; `onUndo(revision)` is called when the
    // user chooses the revision to go back to, `onReturn(entry)` if it is one with a name that was
    // left by an undo. `onLook` and `onName` are as in momentButtons().
    constructor({ list, more }, { readPage, onUndo, onReturn, onLook, onName, onError }) {
        this.#list = list;
        this.#more = more;
        this.#readPage = readPage;
        this.#onUndo = onUndo;
        this.#onReturn = onReturn;
        this.#acts = { onLook, onName, onError };
        more.addEventListener('click', () => this.#readOn().catch(onError));
        document.addEventListener('visibilitychange', () => this.#tellTimes());
    }

    // Writes again when the revisions were made: in a page that was left open, "14:03" may have become
    // "yesterday 14:03".
    #tellTimes() {
        for (const node of this.#list.querySelectorAll('time')) {
            node.textContent = wordsOfTime(new Date(node.dateTime), new Date());
        }
    }

    // Shows the first page of the history of a mesh, as the server sent it. The row in which the user
    // is writing a name stays where it is, so that the field keeps its text, selection and focus, unless
    // its revision is not in the history any more.
    show(history, mesh) {
        const hadFocus = this.#hasFocus || this.#list.contains(document.activeElement);
        this.#hasFocus = false;
        this.#shown = history;
        this.#isTopShown = false;
        this.#kept = mesh === this.#mesh ? this.#named : null;
        this.#mesh = mesh;
        [...this.#list.children].filter((row) => row !== this.#kept).forEach(remove);
        this.#append(history);
        this.#bringPresentIntoSight();
        if (hadFocus && !this.#list.contains(document.activeElement)) {
            this.#list.focus(); // the element that had the focus is gone
        }
    }

    // The row in which the user is writing a name, or null.
    get #named() {
        return this.#list.querySelector('li:has(.moment-name)');
    }

    // Adds rows, newest first. The row in which the user is writing a name gets the words of the row of
    // its revision, and is not moved, because an element that is moved loses the focus.
    #place(rows) {
        const named = this.#named;
        const at = named === null ? -1 : Number(named.dataset.revision);
        for (const row of rows) {
            const revision = Number(row.dataset.revision);
            if (named !== null && revision > at) {
                named.before(row);
            } else if (revision === at && row.querySelector('.moment') !== null) {
                named.firstElementChild.replaceWith(row.firstElementChild);
                named.ariaCurrent = row.ariaCurrent;
                this.#kept = null;
            } else {
                this.#list.append(row);
            }
        }
    }

    // Removes the row that was kept if the page that was added, {entries, next}, reaches to its revision and
    // does not have it: the mesh was replaced, or the step was forgotten.
    #dropKept({ entries, next }) {
        const oldest = next === null ? -Infinity : entries.at(-1).revision;
        if (this.#kept !== null && Number(this.#kept.dataset.revision) >= oldest) {
            remove(this.#kept);
            this.#kept = null;
        }
    }

    // Scrolls the list, and nothing else, to the present state, which an undo may have moved down.
    #bringPresentIntoSight() {
        const row = this.#list.querySelector('[aria-current]');
        if (row !== null && row !== this.#list.firstElementChild) {
            const below = row.getBoundingClientRect().bottom - this.#list.getBoundingClientRect().bottom;
            this.#list.scrollTop += Math.max(below, 0);
        }
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#list.querySelectorAll('button.entry, .moment button.edits')) {
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
        const rows = entries.map((entry) => {
            const row = this.#row(entry);
            const moment = momentButtons(entry, this.#acts, this.#isEnabled);
            moment.prepend(timeOf(entry));
            row.append(moment);
            return row;
        });
        const first = entries.findLast((entry) => entry.undoable);
        this.#beginning = first === undefined ? this.#beginning : first.revision - 1;
        const words = [make('span', { className: 'ops' }, 'original')];
        if (next === null && undo > 0) {
            rows.push(this.#goBack(this.#beginning, words));
        } else if (next === null && entries.length > 0 && !this.#isTopShown) {
            rows.push(this.#present(this.#shown.entries[0].state, [...words, make('span', {})]));
        }
        this.#place(rows);
        this.#dropKept({ entries, next });
        this.#more.dataset.cursor = next ?? '';
        this.#more.hidden = next === null;
    }

    // Returns the row of an entry. The present state is marked: the newest entry that can be undone,
    // or the change after which there is none. The undoable entries before it are buttons, and so
    // are entries with a name; other entries cannot be undone.
    #row(entry) {
        const { revision, undoable, name } = entry;
        const words = [
            make(
                'span',
                { className: 'ops', title: wordsOf(entry) },
                ...(name === undefined ? [] : [make('bdi', { className: 'named' }, name), ' ']),
                wordsOf(entry),
            ),
            make('span', { className: 'small', title: tallyOf(entry) }, sumOf(entry)),
        ];
        const isPresent = undoable || revision === this.#shown.entries[0].state;
        if (isPresent && !this.#isTopShown) {
            return this.#present(revision, words);
        }
        if (undoable) {
            return this.#goBack(revision, words);
        }
        if (name !== undefined && entry.state !== this.#shown.entries[0].state) {
            const title = `Go to the content of revision ${revision}`;
            return this.#button(revision, words, title, () => this.#onReturn(entry));
        }
        const number = make('span', { className: 'number' }, `${revision}`);
        const row = make('li', {}, make('div', { className: 'entry passed' }, number, ...words));
        row.dataset.revision = revision;
        return row;
    }

    // Returns the row of the state that the mesh has now.
    #present(revision, [words, sum]) {
        this.#isTopShown = true;
        sum.prepend(make('span', { className: 'now' }, 'now '));
        const number = make('span', { className: 'number' }, `${revision}`);
        const row = make('li', {}, make('div', { className: 'entry' }, number, words, sum));
        row.dataset.revision = revision;
        row.setAttribute('aria-current', 'step');
        return row;
    }

    #goBack(revision, words) {
        const title = `Undo all edits since revision ${revision}`;
        return this.#button(revision, words, title, () => this.#onUndo(revision));
    }

    #button(revision, words, title, onclick) {
        const button = make(
            'button',
            {
                type: 'button',
                className: 'entry',
                title,
                disabled: !this.#isEnabled,
                onclick: () => {
                    this.#hasFocus = true;
                    onclick();
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

// Removes a row. What is being written in it is given up: a field that has the focus would else send the
// name when it is removed, although its revision, or its mesh, is gone.
function remove(row) {
    row.querySelector('.moment-name')?.dispatchEvent(new Event('cancel'));
    row.remove();
}

// Returns when a revision was made.
function timeOf({ time }) {
    const date = new Date(time);
    const title = date.toLocaleString();
    return make('time', { dateTime: time, title, className: 'small' }, wordsOfTime(date, new Date()));
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
