// chooser.js - the list of the server's operations, grouped by the kind of element, with a search.

import { make } from './dom.js';

// The group in which the list shows an operation, by the first word of the operation's name.
// Operations with another first word are in the group 'Mesh'.
const GROUPS = { vertex: 'Vertex', edge: 'Edge', face: 'Face', loop: 'Loop', hole: 'Loop' };
const GROUP_NAMES = [...new Set(Object.values(GROUPS)), 'Mesh'];

export class Chooser {
    #select;
    #search;
    #onChange;
    #operations = [];

    // `onChange(isChosen)` is called when another operation becomes the selected one; `isChosen` is
    // true if the user chose it in the list. `onEnter(name)` is called when the user presses Enter
    // in the search field.
    constructor({ select, search }, { onChange, onEnter }) {
        [this.#select, this.#search, this.#onChange] = [select, search, onChange];
        select.addEventListener('change', () => onChange(true));
        search.addEventListener('input', () => this.#list());
        search.addEventListener('keydown', (event) => {
            if (event.key === 'Enter' && this.operation !== undefined) {
                event.preventDefault(); // otherwise the key would also apply the form that it opens
                onEnter(this.operation.name);
            }
        });
    }

    setOperations(operations) {
        this.#operations = operations;
        this.#list();
    }

    get all() {
        return this.#operations;
    }

    // Returns the operation with a name, or undefined.
    find(name) {
        return this.#operations.find((operation) => operation.name === name);
    }

    // Returns the selected operation, or undefined if the search finds none.
    get operation() {
        return this.find(this.#select.value);
    }

    // Selects the operation with this name, which must exist, and clears the search.
    set(name) {
        this.#search.value = '';
        this.#fill(this.#operations);
        this.#select.value = name;
    }

    // Lists the operations that match the search.
    #list() {
        const text = this.#search.value.trim().toLowerCase();
        const words = text.split(/\s+/);
        const before = this.#select.value;
        const found = this.#operations.filter(({ name, doc }) =>
            words.every((word) => `${name} ${doc}`.toLowerCase().includes(word)),
        );
        this.#fill(found);
        this.#select.value = bestOf(found, text, words, before);
        if (this.#select.value !== before) {
            this.#onChange(false);
        }
    }

    #fill(operations) {
        const names = operations.map(({ name }) => name);
        const groups = GROUP_NAMES.map((label) => {
            const own = names.filter((name) => groupOf(name) === label);
            const options = own.map((name) => make('option', { value: name }, name));
            return make('optgroup', { label }, ...options);
        });
        this.#select.replaceChildren(...groups.filter((group) => group.children.length > 0));
    }
}

// Returns the name of the operation to select: the operation with the name `text`, if there is one;
// else the first operation whose name contains all words of `text`; else the one that was selected
// before; else the first of `operations`.
function bestOf(operations, text, words, before) {
    const names = operations.map(({ name }) => name);
    const named =
        names.find((name) => name === text) ??
        names.find((name) => text !== '' && words.every((word) => name.includes(word)));
    return named ?? (names.includes(before) ? before : (names[0] ?? ''));
}

function groupOf(name) {
    return GROUPS[name.split('_')[0]] ?? 'Mesh';
}
