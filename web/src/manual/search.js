// search.js - finds pages of the manual by words, in a list that is read when the reader first
// searches.

import { make } from '../kit/dom.js';
import { readIndex } from '../wire/api.js';

const MOST = 12;

const KINDS = { guide: 'Guide', operation: 'Operation', route: 'Route', problem: 'Problem', type: 'Type', list: 'List' };

// "edge_split" and "edge split" are the same words.
const plain = (text) => text.toLowerCase().replaceAll(/[_\-/{}]+/g, ' ');

// Returns how well a page fits the words, 0 if it does not.
function scoreOf([title, , kind, label, words], asked) {
    const [name, other] = [plain(title), plain(`${label} ${words}`)];
    const whole = asked.join(' ');
    let score = 0;
    for (const word of asked) {
        const at = ` ${name}`.indexOf(` ${word}`);
        const here = at >= 0 ? 6 : name.includes(word) ? 3 : ` ${other}`.includes(` ${word}`) ? 2 : other.includes(word) ? 1 : 0;
        if (here === 0) {
            return 0;
        }
        score += here;
    }
    // The label of a route is its method and path; readers give the path alone, too.
    const told = plain(label).trim();
    const isExact = name === whole || told === whole || (kind === 'route' && told.replace(/^\w+ +/, '') === whole);
    const bonus = isExact && kind !== 'type' ? 20 : name.startsWith(whole) ? 4 : 0;
    return score + bonus + (kind === 'guide' ? 1 : 0) - (kind === 'type' ? 1 : 0) + 1 / (1 + name.length);
}

// Returns the rows of `index` that fit a text, the best first.
export function find(index, text) {
    const asked = plain(text).split(' ').filter(Boolean);
    if (asked.length === 0) {
        return [];
    }
    return index
        .map((row) => [scoreOf(row, asked), row])
        .filter(([score]) => score > 0)
        .sort(([a], [b]) => b - a)
        .slice(0, MOST)
        .map(([, row]) => row);
}

export class Search {
    constructor(root, address) {
        this.root = root;
        this.address = address;
        this.index = null;
        this.field = make('input', { type: 'search', id: 'search', placeholder: 'Search', autocomplete: 'off' });
        this.field.setAttribute('aria-label', 'Search the manual');
        this.field.setAttribute('aria-controls', 'found');
        this.list = make('ul', { id: 'found' });
        this.said = make('p', { className: 'small', role: 'status' });
        this.panel = make('div', { className: 'found', hidden: true }, this.said, this.list);
        this.element = make('div', { className: 'search', role: 'search' }, this.field, this.panel);
        this.field.addEventListener('input', () => this.show());
        this.field.addEventListener('focus', () => this.show());
        this.element.addEventListener('keydown', (event) => this.press(event));
        this.element.addEventListener('focusout', ({ relatedTarget }) => {
            if (relatedTarget !== null && !this.element.contains(relatedTarget)) {
                this.panel.hidden = true;
            }
        });
        document.addEventListener('click', ({ target }) => {
            if (!this.element.contains(target)) {
                this.panel.hidden = true;
            }
        });
        document.addEventListener('keydown', (event) => {
            const isField = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName) && event.target.type !== 'radio';
            if (event.key === '/' && !isField && !event.ctrlKey && !event.metaKey) {
                event.preventDefault();
                this.field.focus();
            }
        });
    }

    async show() {
        const text = this.field.value;
        if (text.trim() === '') {
            this.panel.hidden = true;
            return;
        }
        try {
            this.index ??= await readIndex(this.address);
        } catch (error) {
            this.panel.hidden = false;
            this.said.textContent = error.message;
            return;
        }
        if (text !== this.field.value) {
            return; // another key was pressed meanwhile, and has shown its own list
        }
        const rows = find(this.index, text);
        this.list.replaceChildren(...rows.map(([title, path, kind, label]) =>
            make('li', {}, make('a', { href: this.root + path }, make('strong', {}, title), make('span', { className: 'small' }, ` ${KINDS[kind]}${label ? ` ${label}` : ''}`)))));
        this.said.textContent = rows.length === 0 ? `No page has “${text.trim()}”.` : rows.length === 1 ? '1 page' : `${rows.length} pages`;
        this.panel.hidden = false;
    }

    press(event) {
        const links = [...this.list.querySelectorAll('a')];
        const at = links.indexOf(document.activeElement);
        if (event.key === 'Escape' && !this.panel.hidden) {
            event.preventDefault(); // browsers would also empty the field
            this.panel.hidden = true;
            this.field.focus();
        } else if (event.key === 'ArrowDown' && links.length > 0) {
            event.preventDefault();
            links[Math.min(at + 1, links.length - 1)].focus();
        } else if (event.key === 'ArrowUp' && at >= 0) {
            event.preventDefault();
            (links[at - 1] ?? this.field).focus();
        } else if (event.key === 'Enter' && at < 0 && links.length > 0) {
            links[0].click();
        }
    }
}
