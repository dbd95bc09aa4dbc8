// controls.js - form controls for the values of parameters. A control has
//
//   node      the element for the form
//   main      the element that its label belongs to, and that gets the focus first
//   isSaid    whether the user has given a value
//   clear()   removes the value
//   read()    returns the value, undefined if there is none; throws a Problem for a mistake
//
// and, if the user can fill it by clicks in the view, take(id, place) with the id of the clicked
// element and, if it is a vertex, its position. fields.js chooses the control of a parameter.

import { make } from './dom.js';
import { numbersOf, slip, toggleWord, wordsOf } from './numbers.js';

// A text field; "" means no value.
class Field {
    constructor(node) {
        this.node = node;
    }

    get main() {
        return this.node;
    }

    get isSaid() {
        return this.node.value !== '';
    }

    clear() {
        this.node.value = '';
    }

    read() {
        return this.node.value || undefined;
    }
}

// A list from which one text is chosen; `options` is an array of [value, text].
export class Choice extends Field {
    constructor(options, value) {
        super(make('select'));
        this.node.append(...options.map(([value, text]) => make('option', { value }, text)));
        this.node.value = value;
    }
}

export class Flag {
    node = make('input', { type: 'checkbox' });
    isSaid = true;

    constructor(isSet) {
        this.node.checked = isSet;
    }

    get main() {
        return this.node;
    }

    clear() {
        this.node.checked = false;
    }

    read() {
        return this.node.checked;
    }
}

// A choice between yes and no, or no value.
export class Whether extends Choice {
    constructor() {
        super([['', 'unchanged'], ['yes', 'yes'], ['no', 'no']], '');
    }

    read() {
        return this.isSaid ? this.node.value === 'yes' : undefined;
    }
}

export class Text extends Field {
    constructor() {
        super(make('input', { type: 'text', autocomplete: 'off', spellcheck: false }));
    }
}

// One text field for the numbers of a colour: red, green and blue, and an opacity if `most` is 4.
export class Color extends Text {
    #name;
    #most;

    constructor(name, most) {
        super();
        [this.#name, this.#most] = [name, most];
        this.node.placeholder = most > 3 ? 'red green blue opacity' : 'red green blue';
    }

    read() {
        const numbers = numbersOf(this.node.value, this.#name);
        if (numbers.length === 0) {
            return undefined;
        }
        if (numbers.length < 3 || numbers.length > this.#most) {
            const count = this.#most > 3 ? 'three or four' : 'three';
            throw slip(this.#name, 'Not a colour', `${this.#name} must be ${count} numbers.`);
        }
        return numbers;
    }
}

// What a user writes into a field to name all elements that are selected in the page, and the value
// that such a field has, until the page replaces it by their ids.
const SELECTION_NAME = 'the selection';
export const SELECTION = Object.freeze({ [SELECTION_NAME]: true });

// Returns the set that a text names: "selected" means {selected: true}, the elements whose bool
// attribute `selected` is true, and "patch=3" means {patch: 3}. Returns null if the text names no
// set; a text that begins with a digit or a sign is a list of ids.
export function setOf(text) {
    const [, name, value] = /^([^\s\d=+.,;()[\]-][^=]*?)(?:\s*=\s*(-?\d{1,10}))?$/.exec(text) ?? [];
    return name === undefined ? null : { [name]: value === undefined ? true : Number(value) };
}

// A text field for ids of elements: `isList` allows several ids, `isNullable` allows none, and
// `isSet` allows the name of a set, see setOf(), or of the selection. Sets of `plural` are offered.
export class Ids {
    node = make('input', { type: 'text', autocomplete: 'off', spellcheck: false });
    #name;
    #isList;
    #isNullable;
    #isSet;

    constructor(name, { isList = false, isNullable = false, isSet = false, plural } = {}) {
        [this.#name, this.#isList, this.#isNullable] = [name, isList, isNullable];
        this.#isSet = isSet;
        this.node.placeholder = isSet
            ? 'ids, or a set such as selected'
            : isList
              ? 'ids'
              : isNullable
                ? 'id or none'
                : 'id';
        if (isSet && plural !== undefined) {
            this.node.setAttribute('list', `sets-${plural}`);
        }
        if (!isList && !isNullable) {
            this.node.inputMode = 'numeric';
        }
    }

    get main() {
        return this.node;
    }

    get isSaid() {
        return this.#isNullable || this.node.value.trim() !== '';
    }

    clear() {
        this.node.value = '';
    }

    set(ids) {
        this.node.value = ids.join(' ');
    }

    // Names the selection in place of ids.
    setSelection() {
        this.node.value = SELECTION_NAME;
    }

    // Returns the valid ids in the text.
    get ids() {
        return wordsOf(this.node.value).filter((word) => /^\d{1,9}$/.test(word)).map(Number);
    }

    take(id) {
        const text = this.#isSet && setOf(this.node.value.trim()) !== null ? '' : this.node.value;
        this.node.value = this.#isList ? toggleWord(text, id) : `${id}`;
    }

    // Returns an array of ids if the field takes several, or a set; else one id, or null for "none".
    read() {
        const text = this.node.value.trim();
        if (this.#isSet && text === SELECTION_NAME) {
            return SELECTION;
        }
        const set = this.#isSet ? setOf(text) : null;
        if (set !== null) {
            return set;
        }
        if (this.#isNullable && (text === '' || text === 'none')) {
            return null;
        }
        const ids = numbersOf(text, this.#name);
        if (ids.length === 0) {
            return undefined;
        }
        if (!this.#isList && ids.length > 1) {
            throw slip(
                this.#name,
                'One number',
                `${this.#name} must be one number, not \u201c${text}\u201d.`,
            );
        }
        return this.#isList ? ids : ids[0];
    }
}

// A text area for the corners of a polygon, one in each line, or for the numbers of a matrix, as
// `parse(numbers)` reads them.
export class Numbers extends Field {
    #name;
    #parse;

    constructor(name, placeholder, parse) {
        super(make('textarea', { rows: 4, placeholder, spellcheck: false }));
        [this.#name, this.#parse] = [name, parse];
    }

    set(rows) {
        this.node.value = rows.map((row) => row.join(' ')).join('\n');
    }

    read() {
        const numbers = numbersOf(this.node.value, this.#name);
        return numbers.length === 0 ? undefined : this.#parse(numbers);
    }
}

// Returns a control for the corners [x, y] of a polygon.
export function polygon(name) {
    return new Numbers(name, 'x y, one corner in each line', (numbers) => {
        if (numbers.length % 2 !== 0) {
            throw slip(name, 'Two numbers', `${name}: the last corner lacks its y.`);
        }
        return Array.from({ length: numbers.length / 2 }, (_, i) =>
            numbers.slice(2 * i, 2 * i + 2),
        );
    });
}

// A field for a number; it may be empty.
export class Numeral {
    node;
    #name;

    // `step` is '1' for whole numbers and 'any' for other numbers.
    constructor(name, placeholder, step = 'any') {
        this.#name = name;
        this.node = make('input', { type: 'number', step, placeholder });
        // The field loses the focus when the wheel is turned, because otherwise scrolling over the
        // field would change the number.
        this.node.addEventListener('wheel', () => this.node.blur(), { passive: true });
    }

    get main() {
        return this.node;
    }

    get isSaid() {
        return this.node.value !== '' || this.node.validity.badInput;
    }

    clear() {
        this.node.value = '';
    }

    read() {
        if (this.node.validity.badInput) {
            throw slip(
                this.#name,
                'Not a number',
                `${this.#name} must be a number.`,
            );
        }
        return this.node.value === '' ? undefined : Number(this.node.value);
    }
}

const AXES = ['x', 'y', 'z'];

// A point or a vector: three numbers, which can be pasted into one of the fields together. `usual`
// is the value of an empty field if other fields have values; if `usual` is undefined, either all
// three fields or none must have values.
export class Vector {
    node;
    #name;
    #usual;
    #fields;

    // `onMore(numbers)` is called if more numbers are pasted than there are fields.
    constructor(name, { usual, onMore = () => {} } = {}) {
        [this.#name, this.#usual] = [name, usual];
        this.#fields = AXES.map((axis) => new Numeral(`${name} ${axis}`, axis));
        const inputs = this.#fields.map(({ node }, i) => {
            node.setAttribute('aria-label', `${name} ${AXES[i]}`);
            node.addEventListener('paste', (event) => this.#paste(event, i, onMore));
            return node;
        });
        this.node = make('div', { className: 'vector' }, ...inputs);
    }

    get main() {
        return this.#fields[0].node;
    }

    get isSaid() {
        return this.#fields.some((field) => field.isSaid);
    }

    clear() {
        this.#fields.forEach((field) => field.clear());
    }

    get text() {
        return this.#fields.map(({ node }) => node.value).join(' ').trim();
    }

    take(_, place) {
        this.#fields.forEach(({ node }, i) => {
            node.value = place[i];
        });
    }

    read() {
        if (!this.isSaid) {
            return undefined;
        }
        return this.#fields.map((field, i) => {
            const value = field.read() ?? this.#usual;
            if (value === undefined) {
                const missing = `${this.#name} needs its ${AXES[i]}.`;
                throw slip(this.#name, 'Three numbers', missing);
            }
            return value;
        });
    }

    // Handles the pasting of several numbers: two fill this field and the next, three or more fill
    // all fields.
    #paste(event, at, onMore) {
        const words = wordsOf(event.clipboardData.getData('text'));
        if (words.length < 2) {
            return;
        }
        event.preventDefault();
        const first = words.length < AXES.length ? at : 0;
        this.#fields.slice(first).forEach(({ node }, i) => {
            node.value = words[i] ?? node.value;
        });
        if (words.length > AXES.length) {
            onMore(words);
        }
        event.target.dispatchEvent(new Event('input', { bubbles: true }));
    }
}

// A control that consists of another control with simple fields and, for values that these fields
// cannot express, of a text area; a button switches between the two. `easy` is the control with the
// fields, `write()` returns the value of the fields as text, and `parse(text)` returns the value
// that a text means.
export class WithText {
    node;
    #easy;
    #text;
    #button;
    #parse;
    #write;
    #labels;

    // `labels` are the two labels of the button: the first is shown while the fields are shown, the
    // second while the text area is shown.
    constructor(easy, { name, placeholder, write, parse, labels }) {
        [this.#easy, this.#parse, this.#write, this.#labels] = [easy, parse, write, labels];
        this.#text = make('textarea', {
            rows: 4,
            placeholder,
            hidden: true,
            spellcheck: false,
            'aria-label': `${name} as text`,
        });
        this.#button = make('button', {
            type: 'button',
            className: 'quiet',
            onclick: () => {
                this.showText(!this.#isText);
                this.main.focus();
                this.node.dispatchEvent(new Event('input', { bubbles: true }));
            },
        });
        this.node = make('div', { className: 'with-text' }, easy.node, this.#text, this.#button);
        this.showText(false);
    }

    get #isText() {
        return !this.#text.hidden;
    }

    // Shows the text area with `text` in it, or shows the fields again with their former values.
    showText(isText, text = isText ? this.#write() : '') {
        this.#text.value = text;
        this.#text.hidden = !isText;
        this.#easy.node.hidden = isText;
        this.#button.textContent = this.#labels[isText ? 1 : 0];
    }

    get main() {
        return this.#isText ? this.#text : this.#easy.main;
    }

    get isSaid() {
        return this.#isText ? this.#text.value.trim() !== '' : this.#easy.isSaid;
    }

    clear() {
        this.#text.value = '';
        this.#easy.clear();
    }

    take(id, place) {
        this.showText(false);
        this.#easy.take(id, place);
    }

    read() {
        if (this.#isText) {
            const text = this.#text.value.trim();
            return text === '' ? undefined : this.#parse(text);
        }
        return this.#easy.read();
    }
}

// Returns a control for vectors: its fields take one vector for all elements, its text area takes a
// list with one vector for each element.
export function vectors(name) {
    const parse = (text) => {
        const numbers = numbersOf(text, name);
        const rows = Array.from({ length: Math.ceil(numbers.length / 3) }, (_, i) =>
            numbers.slice(3 * i, 3 * i + 3),
        );
        return rows.length === 1 ? rows[0] : rows;
    };
    const onMore = (words) => {
        const rows = words.map((word, i) => word + (i % 3 === 2 ? '\n' : ' '));
        control.showText(true, rows.join('').trim());
    };
    const vector = new Vector(name, { onMore });
    const control = new WithText(vector, {
        name,
        placeholder: 'x y z, one point in each line',
        write: () => vector.text,
        parse,
        labels: ['A list, one for each', 'One for all'],
    });
    return control;
}
