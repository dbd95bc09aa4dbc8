// chooser.js - the list of the server's operations, by what they work on, and the search in it.

import { make } from './dom.js';

// What operations begin with, as groups of the list; what begins otherwise is of the whole mesh.
const GROUPS = { vertex: 'Vertex', edge: 'Edge', face: 'Face', loop: 'Loop', hole: 'Loop' };
const GROUP_NAMES = [...new Set(Object.values(GROUPS)), 'Mesh'];

export class Chooser {
    #select;
    #search;
    #onChange;
    #operations = [];

    // `onChange(isChosen)` is called when another operation is the current one, `isChosen` where a
    // visitor took it from the list; `onEnter(name)` when the search is over.
    constructor({ select, search }, { onChange, onEnter }) {
        [this.#select, this.#search, this.#onChange] = [select, search, onChange];
        select.addEventListener('change', () => onChange(true));
        search.addEventListener('input', () => this.#list());
        search.addEventListener('keydown', (event) => {
            if (event.key === 'Enter' && this.operation !== undefined) {
                event.preventDefault(); // the key would apply what it opens
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

    // That of a name, undefined where the server has none.
    find(name) {
        return this.#operations.find((operation) => operation.name === name);
    }

    // The current one, undefined where nothing is found.
    get operation() {
        return this.find(this.#select.value);
    }

    // Make one that there is the current one, whatever is searched for.
    set(name) {
        this.#search.value = '';
        this.#fill(this.#operations);
        this.#select.value = name;
    }

    // Those that what is searched for is in.
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

// What is named as the text comes before what speaks of it, and what there was before the first.
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
