// list.js - the list of meshes.

import { formatAbout, make } from './dom.js';

export class MeshList {
    #list;
    #more;
    #readPage;
    #onOpen;
    #onMore;
    #onError;
    #current = null;
    #cursor = null;
    #reading = 0;
    #leaving = new Set(); // ids of meshes that are about to be deleted

    // `readPage(cursor)` reads a page of the list, {items, next}; `onOpen(id)` is called when the
    // user chooses a mesh, `onMore(button, {id, name})` when the user wants the menu of its actions.
    constructor({ list, more }, { readPage, onOpen, onMore, onError }) {
        this.#list = list;
        this.#more = more;
        this.#readPage = readPage;
        this.#onOpen = onOpen;
        this.#onMore = onMore;
        this.#onError = onError;
        more.addEventListener('click', () => this.#append().catch(onError));
    }

    // Reads the list of meshes again. Returns the ids of its first page.
    async refresh() {
        const reading = ++this.#reading;
        const { items, next } = await this.#readPage(null);
        if (reading === this.#reading) {
            this.#keepFocus(() => {
                this.#list.replaceChildren(...items.map((item) => this.#row(item)));
            });
            this.#bringIntoSight();
            this.#setNext(next);
        }
        return items.map(({ id }) => id);
    }

    // The names of the meshes in the list.
    get names() {
        return [...this.#list.querySelectorAll('.mesh-name')].map((name) => name.textContent);
    }

    // Moves the focus to the open mesh, or else to the first mesh of the list.
    focus() {
        const current = this.#list.querySelector('[aria-current]');
        (current ?? this.#list.querySelector('button'))?.focus();
    }

    // Changes rows by calling `act()`. If a button in them has the focus, the button that takes its
    // place gets the focus.
    #keepFocus(act) {
        const { activeElement: focused } = document;
        const { mesh } = focused?.closest('li')?.firstElementChild.dataset ?? {};
        const isInside = this.#list.contains(focused);
        act();
        if (isInside && !focused.isConnected) {
            const row = [...this.#list.children].find(
                ({ firstElementChild: button }) => button.dataset.mesh === mesh,
            );
            row?.querySelector(`.${focused.classList[0]}`)?.focus();
        }
    }

    // Marks the open mesh.
    setCurrent(id) {
        this.#current = id;
        for (const row of this.#list.children) {
            this.#mark(row.firstElementChild);
        }
        this.#bringIntoSight();
    }

    // Scrolls the list, but not the page, so that the row of the open mesh is seen.
    #bringIntoSight() {
        const row = this.#list.querySelector('li:has([aria-current])');
        if (row !== null) {
            const [list, box] = [this.#list, row].map((one) => one.getBoundingClientRect());
            const over = (from, to, least, most) => Math.min(from - least, 0) || Math.max(to - most, 0);
            this.#list.scrollBy(
                over(box.left, box.right, list.left, list.right),
                over(box.top, box.bottom, list.top, list.bottom),
            );
        }
    }

    // Marks a mesh that is about to be deleted.
    setLeaving(id, isLeaving) {
        if (isLeaving) {
            this.#leaving.add(id);
        } else {
            this.#leaving.delete(id);
        }
        for (const row of this.#list.children) {
            this.#mark(row.firstElementChild);
        }
    }

    // The id of the mesh after this one in the list, or before it if it is the last; null if it is
    // the only one or is not in the list.
    neighbour(id) {
        const rows = [...this.#list.children].map((row) => row.firstElementChild.dataset.mesh);
        const at = rows.indexOf(id);
        return at < 0 ? null : (rows[at + 1] ?? rows[at - 1] ?? null);
    }

    // Updates the row of the mesh that a summary describes.
    update(summary) {
        for (const row of this.#list.children) {
            if (row.firstElementChild.dataset.mesh === summary.id) {
                this.#keepFocus(() => row.replaceWith(this.#row(summary)));
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
        const more = make(
            'button',
            {
                type: 'button',
                className: 'more edits',
                'aria-label': `Actions for ${name || id}`,
                'aria-haspopup': 'menu',
                'aria-expanded': 'false',
                onclick: () => this.#onMore(more, { id, name }),
            },
            '\u22ef',
        );
        const row = make('li', {}, button, more);
        this.#mark(button);
        return row;
    }

    #mark(button) {
        if (button.dataset.mesh === this.#current) {
            button.setAttribute('aria-current', 'true');
        } else {
            button.removeAttribute('aria-current');
        }
        const isLeaving = this.#leaving.has(button.dataset.mesh);
        button.parentElement?.classList.toggle('leaving', isLeaving);
    }
}
