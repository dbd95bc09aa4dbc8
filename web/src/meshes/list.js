// list.js - the list of meshes, in an order that the user chooses, and only those whose names
// contain what the user types.

import { MOST_LISTED } from '../wire/api.js';
import { nameInText, seenName } from '../wire/names.js';
import { formatAbout, keepFocusIn, make } from '../kit/dom.js';

// A filter is applied when it has not changed for this many milliseconds.
const DELAY = 200;

// With so many meshes or more, the order and the filter are shown.
const MANY = 5;

// With a filter, a page of the server may be empty although there are more; at most so many pages
// are read for one of the list.
const MOST_PAGES = 50;

// Number of meshes in a page of the list. The next page is read when the list is scrolled to less than
// NEAR pixels from its end.
const PAGE = 200;
const NEAR = 400;

export class MeshList {
    #list;
    #more;
    #find;
    #none;
    #readPage;
    #onOpen;
    #onMore;
    #onError;
    #current = null;
    #cursor = null;
    #reading = 0;
    #appending = null; // the reading and the cursor of the page that is being added
    #hasFailed = false; // the last page could not be read, so scrolling does not ask for it again
    #stop = null; // the row that the Tab key reaches
    #leaving = new Set(); // ids of meshes that are about to be deleted

    // `find` contains the fields `filter` and `order`, and `none` is the element that says that
    // there is no such mesh. `readPage({sort, contains, cursor, limit})` reads a page of the list,
    // {items, next}; `onOpen(id)` is called when the user chooses a mesh, `onMore(button, {id, name})` when
    // the user wants the menu of its actions.
    constructor({ list, more, find, none }, { readPage, onOpen, onMore, onError }) {
        this.#list = list;
        this.#more = more;
        this.#find = find;
        this.#none = none;
        this.#readPage = readPage;
        this.#onOpen = onOpen;
        this.#onMore = onMore;
        this.#onError = onError;
        more.addEventListener('click', () => this.#append().catch(onError));
        list.addEventListener('scroll', () => this.#hasFailed || this.#appendIfNearEnd());
        list.addEventListener('keydown', (event) => this.#onKey(event));
        list.addEventListener('focusin', (event) => this.#setStop(event.target.closest('li')));
        const again = () => this.#show(PAGE).catch(onError);
        let timer = 0;
        find.filter.addEventListener('input', () => {
            clearTimeout(timer);
            timer = setTimeout(again, DELAY);
        });
        find.order.addEventListener('change', again);
    }

    // The text that the names of the listed meshes contain, or ''.
    get filter() {
        return this.#find.filter.value.trim();
    }

    // Reads on until there are meshes to show, or no more pages.
    async #read(cursor, limit = PAGE) {
        const contains = this.filter;
        const sort = this.#find.order.value;
        let page = await this.#readPage({ sort, contains, cursor, limit });
        for (let i = 1; page.items.length === 0 && page.next !== null && i < MOST_PAGES; i++) {
            page = await this.#readPage({ sort, contains, cursor: page.next, limit });
        }
        return page;
    }

    // Reads the list of meshes again, as many as it shows now. Returns their ids.
    refresh() {
        return this.#show(Math.min(Math.max(this.#list.children.length, PAGE), MOST_LISTED));
    }

    async #show(limit) {
        const reading = ++this.#reading;
        const { items, next } = await this.#read(null, limit);
        if (reading === this.#reading) {
            this.#keepFocus(() => {
                this.#list.replaceChildren(...items.map((item) => this.#row(item)));
            });
            this.#bringIntoSight();
            this.#setNext(next);
            this.#hasFailed = false;
            this.#setStop(this.#currentRow ?? this.#list.firstElementChild);
            this.#showFound(items.length);
        }
        return items.map(({ id }) => id);
    }

    // The names of the meshes in the list.
    get names() {
        return [...this.#list.querySelectorAll('.mesh-name')].map((name) => name.textContent);
    }

    // The row of the open mesh, or null.
    get #currentRow() {
        return this.#list.querySelector('li:has([aria-current])');
    }

    // Whether the list has more meshes and is scrolled almost to the end of those that it shows. On a
    // narrow page it is a line that is scrolled sidewards.
    get #isNearEnd() {
        const { scrollLeft, scrollTop, clientWidth, clientHeight, scrollWidth, scrollHeight } = this.#list;
        const isNear =
            scrollTop + clientHeight > scrollHeight - NEAR && scrollLeft + clientWidth > scrollWidth - NEAR;
        return isNear && !this.#more.hidden;
    }

    // --- keys ---

    // The list is one stop of the Tab key, so that many meshes are not in the way. From there, the
    // arrow keys, Home and End move through it.
    #onKey(event) {
        const row = event.target.closest('li');
        const { firstElementChild: first, lastElementChild: last } = this.#list;
        const next = {
            ArrowDown: row?.nextElementSibling,
            ArrowRight: row?.nextElementSibling,
            ArrowUp: row?.previousElementSibling,
            ArrowLeft: row?.previousElementSibling,
            Home: first,
            End: last,
        }[event.key];
        if (next instanceof Element) {
            event.preventDefault();
            next.querySelector(`.${event.target.classList[0]}`).focus();
        }
    }

    // Makes a row, if there is one, the only one whose buttons the Tab key reaches.
    #setStop(row) {
        if (row !== null) {
            this.#stop?.querySelectorAll('button').forEach((button) => (button.tabIndex = -1));
            row.querySelectorAll('button').forEach((button) => (button.tabIndex = 0));
            this.#stop = row;
        }
    }

    #keepFocus(act) {
        keepFocusIn(this.#list, (row) => row.firstElementChild.dataset.mesh, act);
    }

    // Marks the open mesh.
    setCurrent(id) {
        this.#current = id;
        for (const row of this.#list.children) {
            this.#mark(row.firstElementChild);
        }
        this.#bringIntoSight();
        this.#setStop(this.#currentRow);
    }

    // Scrolls the list, but not the page, so that the row of the open mesh is seen.
    #bringIntoSight() {
        const row = this.#currentRow;
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
                const made = this.#row(summary);
                this.#keepFocus(() => row.replaceWith(made));
                if (row === this.#stop) {
                    this.#setStop(made);
                }
                return;
            }
        }
    }

    // Says that the connection is back: what scrolling has asked for in vain is read now.
    goOn() {
        if (this.#hasFailed) {
            this.#hasFailed = false;
            this.#appendIfNearEnd();
        }
    }

    #appendIfNearEnd() {
        if (this.#isNearEnd) {
            this.#append().catch(this.#onError);
        }
    }

    // Adds the next page, unless it is being read already.
    async #append() {
        const [reading, cursor] = [this.#reading, this.#cursor];
        const page = `${reading} ${cursor}`;
        if (page === this.#appending) {
            return;
        }
        this.#appending = page;
        try {
            const { items, next } = await this.#read(cursor);
            if (reading === this.#reading && cursor === this.#cursor) {
                this.#list.append(...items.map((item) => this.#row(item)));
                this.#setNext(next);
                this.#hasFailed = false;
            }
        } catch (error) {
            this.#hasFailed ||= reading === this.#reading;
            throw error;
        } finally {
            // After a change of the filter or the order, another page may be read already.
            if (page === this.#appending) {
                this.#appending = null;
            }
        }
    }

    // Shows the fields of the search if they are of use, and says if nothing was found.
    #showFound(count) {
        const { filter } = this;
        this.#find.box.hidden = filter === '' && count < MANY;
        this.#none.textContent = filter !== '' && count === 0 ? `No name contains \u201c${filter}\u201d.` : '';
    }

    #setNext(next) {
        this.#cursor = next;
        this.#more.hidden = next === null;
    }

    #row({ id, name, counts }) {
        const button = make(
            'button',
            { type: 'button', className: 'mesh', tabIndex: -1, onclick: () => this.#onOpen(id) },
            make('span', { className: 'mesh-name', dir: 'auto' }, seenName(name || id)),
            make(
                'span',
                { className: 'mesh-counts' },
                `${formatAbout(counts.vertices)} ${counts.vertices === 1 ? 'vertex' : 'vertices'}, ` +
                    `${formatAbout(counts.faces)} ${counts.faces === 1 ? 'face' : 'faces'}`,
            ),
        );
        button.dataset.mesh = id;
        const more = make(
            'button',
            {
                type: 'button',
                className: 'more edits',
                tabIndex: -1,
                'aria-label': `Actions for ${nameInText(name || id)}`,
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
