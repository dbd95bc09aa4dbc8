// chooser.js - the list of the server's operations, grouped by the kind of element, with a search.
// While elements are selected, the list has only the operations that take them, unless the user
// wants all; the search finds the others, too.

import { make } from '../kit/dom.js';

// The group in which the list shows an operation, by the first word of the operation's name.
// Operations with another first word are in the group 'Mesh'.
const GROUPS = { vertex: 'Vertex', edge: 'Edge', face: 'Face', loop: 'Loop', hole: 'Loop' };
const GROUP_NAMES = [...new Set(Object.values(GROUPS)), 'Mesh'];

export class Chooser {
    #select;
    #search;
    #all;
    #onChange;
    #operations = [];
    #filter = null; // {title, takes}, see setFilter()

    // `all` is the checkbox with which the user asks for all operations; its label is its parent.
    // `onChange(isChosen)` is called when another operation becomes the selected one; `isChosen` is
    // true if the user chose it in the list. `onEnter(name)` is called when the user presses Enter
    // in the search field.
    constructor({ select, search, all }, { onChange, onEnter }) {
        [this.#select, this.#search, this.#all] = [select, search, all];
        this.#onChange = onChange;
        select.addEventListener('change', () => onChange(true));
        search.addEventListener('input', () => this.#list());
        all.addEventListener('change', () => this.#list());
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

    // Restricts the list to the operations for which `takes(operation)` is true, in a group with a
    // title; null ends that. The selected operation stays in the list.
    setFilter(filter) {
        this.#filter = filter;
        const isFiltering = filter !== null && !this.#operations.every(filter.takes);
        this.#all.parentElement.hidden = !isFiltering;
        this.#list();
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
        this.#fill(this.#operations.filter((one) => this.#isOffered(one) || one.name === name));
        this.#select.value = name;
    }

    #takes(operation) {
        return this.#filter !== null && this.#filter.takes(operation);
    }

    // Whether the list has an operation when nothing is searched for.
    #isOffered(operation) {
        return this.#filter === null || this.#all.checked || this.#filter.takes(operation);
    }

    // Lists the operations that match the search, or, without a search, those that are offered and
    // the selected one.
    #list() {
        const text = this.#search.value.trim().toLowerCase();
        const words = text.split(/\s+/);
        const before = this.#select.value;
        const isFound = ({ name, doc }) =>
            words.every((word) => `${name} ${doc}`.toLowerCase().includes(word));
        const isListed = (one) => this.#isOffered(one) || one.name === before;
        const found = this.#operations.filter(text === '' ? isListed : isFound);
        this.#fill(found);
        this.#select.value = bestOf(found, text, words, before);
        if (this.#select.value !== before) {
            this.#onChange(false);
        }
    }

    #fill(operations) {
        const taking = operations.filter((one) => this.#takes(one));
        const others = operations.filter((one) => !this.#takes(one));
        const groups = GROUP_NAMES.map((label) =>
            groupWith(label, others.filter((one) => groupOf(one) === label)),
        );
        const all = [groupWith(this.#filter?.title ?? '', taking), ...groups];
        this.#select.replaceChildren(...all.filter((group) => group.children.length > 0));
    }
}

function groupWith(label, operations) {
    const options = operations.map(({ name }) => make('option', { value: name }, name));
    return make('optgroup', { label }, ...options);
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

function groupOf({ name }) {
    return GROUPS[name.split('_')[0]] ?? 'Mesh';
}
