// list.js - the list of meshes.

import { formatAbout, make } from './dom.js';

export class MeshList {
    #list;
    #more;
    #readPage;
    #onOpen;
    #onError;
    #current = null;
    #cursor = null;
    #reading = 0;

    // `readPage(cursor)` reads a page of the list, {items, next}; `onOpen(id)` is called when the
    // user chooses a mesh.
    constructor({ list, more }, { readPage, onOpen, onError }) {
        this.#list = list;
        this.#more = more;
        this.#readPage = readPage;
        this.#onOpen = onOpen;
        this.#onError = onError;
        more.addEventListener('click', () => this.#append().catch(onError));
    }

    // Reads the list of meshes again. Returns the ids of its first page.
    async refresh() {
        const reading = ++this.#reading;
        const { items, next } = await this.#readPage(null);
        if (reading === this.#reading) {
            this.#list.replaceChildren(...items.map((item) => this.#row(item)));
            this.#setNext(next);
        }
        return items.map(({ id }) => id);
    }

    // Marks the open mesh.
    setCurrent(id) {
        this.#current = id;
        for (const row of this.#list.children) {
            this.#mark(row.firstElementChild);
        }
    }

    // Updates the row of the mesh that a summary describes.
    update(summary) {
        for (const row of this.#list.children) {
            if (row.firstElementChild.dataset.mesh === summary.id) {
                row.replaceWith(this.#row(summary));
                return;
            }
        }
    }

    async #append() {
        const reading = this.#reading;
        const { items, next } = await this.#readPage(this.#cursor);
        if (reading === this.#reading) {
            this.#list.append(...items.map((item) => this.#row(item)));
            this.#setNext(next);
        }
    }

    #setNext(next) {
        this.#cursor = next;
        this.#more.hidden = next === null;
    }

    #row({ id, name, counts }) {
        const button = make(
            'button',
            { type: 'button', className: 'mesh', onclick: () => this.#onOpen(id) },
            make('span', { className: 'mesh-name' }, name || id),
            make(
                'span',
                { className: 'mesh-counts' },
                `${formatAbout(counts.vertices)} vertices, ${formatAbout(counts.faces)} faces`,
            ),
        );
        button.dataset.mesh = id;
        this.#mark(button);
        return make('li', {}, button);
    }

    #mark(button) {
        if (button.dataset.mesh === this.#current) {
            button.setAttribute('aria-current', 'true');
        } else {
            button.removeAttribute('aria-current');
        }
    }
}
