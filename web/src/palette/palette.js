// palette.js - a list of everything that can be done, opened by Ctrl+K: the server's operations and
// the page's own acts. The user types some letters of a name, and presses Enter.

import { byId } from '../kit/dom.js';
import { actsOf, rowOf } from './acts.js';
import { found } from './fuzzy.js';

export class Palette {
    #dialog = byId('palette');
    #input = byId('palette-input');
    #list = byId('palette-list');
    #none = byId('palette-none');
    #operations;
    #onOpen;
    #items = []; // everything that can be done
    #shown = []; // the items that the list shows
    #at = 0; // index of the current item in #shown

    // `operations()` returns the server's table of operations; `onOpen(name)` shows the form of an
    // operation.
    constructor({ operations, onOpen }) {
        [this.#operations, this.#onOpen] = [operations, onOpen];
        window.addEventListener('keydown', (event) => {
            const isKey = (event.ctrlKey || event.metaKey) && !event.shiftKey && !event.altKey;
            if (isKey && event.key.toLowerCase() === 'k') {
                event.preventDefault();
                this.open();
            }
        });
        byId('palette-button').addEventListener('click', () => this.open());
        this.#input.addEventListener('input', () => this.#find());
        this.#input.addEventListener('keydown', (event) => this.#onKey(event));
        this.#list.addEventListener('click', (event) => {
            const row = event.target.closest('[role="option"]');
            if (row !== null) {
                this.#run([...this.#list.children].indexOf(row));
            }
        });
        // A click beside the dialog closes it.
        this.#dialog.addEventListener('click', (event) => {
            if (event.target === this.#dialog) {
                this.#dialog.close();
            }
        });
    }

    // Opens the palette, unless a dialog is open.
    open() {
        if (document.querySelector('dialog[open]') !== null) {
            return;
        }
        const operations = this.#operations().map(({ name, doc }) => ({
            label: name,
            about: doc.replaceAll('`', ''),
            kind: 'operation',
            run: () => this.#onOpen(name),
        }));
        this.#items = [...actsOf(document), ...operations];
        this.#input.value = '';
        this.#dialog.showModal();
        this.#input.focus();
        this.#find();
    }

    #find() {
        this.#shown = found(this.#input.value, this.#items);
        this.#list.replaceChildren(...this.#shown.map((item, i) => rowOf(item, `palette-${i}`)));
        const count = this.#shown.length;
        this.#none.textContent = count === 0 ? 'Nothing has this name.' : '';
        this.#set(0);
    }

    // Makes an item the current one.
    #set(at) {
        const rows = this.#list.children;
        rows[this.#at]?.setAttribute('aria-selected', 'false');
        this.#at = at;
        const row = rows[at];
        if (row === undefined) {
            this.#input.removeAttribute('aria-activedescendant');
        } else {
            row.setAttribute('aria-selected', 'true');
            row.scrollIntoView({ block: 'nearest' });
            this.#input.setAttribute('aria-activedescendant', row.id);
        }
    }

    #onKey(event) {
        const { length } = this.#shown;
        const next = {
            ArrowDown: this.#at + 1,
            ArrowUp: this.#at - 1 + length,
            PageDown: Math.min(this.#at + 8, length - 1),
            PageUp: Math.max(this.#at - 8, 0),
        }[event.key];
        if (event.key === 'Enter') {
            event.preventDefault();
            this.#run(this.#at);
        } else if (next !== undefined && length > 0) {
            event.preventDefault();
            this.#set(next % length);
        }
    }

    #run(at) {
        const item = this.#shown[at];
        if (item !== undefined) {
            this.#dialog.close();
            item.run();
        }
    }
}
