// new_shape.js - the dialog that makes a mesh from a shape. The shapes and their parameters are
// those of the server's OpenAPI document, so that a new shape appears without a change here.

import * as api from '../wire/api.js';
import { Ask, field } from '../kit/ask.js';
import { Choice, Flag, Numeral, Text } from '../kit/controls.js';
import { formatCount, make } from '../kit/dom.js';
import { shapesOf } from '../wire/schema.js';

// A limit of this size only keeps numbers finite, and is not shown.
const ENDLESS = 1e100;

let lastShape = 'cube'; // the shape that was chosen last

// Opens the dialog. `onMade(summary)` is called with the summary of the new mesh.
export async function askShape(onMade) {
    new NewShape(shapesOf(await api.getDescription()), onMade).showShape();
}

// Returns a name of the API in words, such as "Major segments" for major_segments. Pure.
export function wordsFor(name) {
    const words = name.replaceAll('_', ' ');
    return `${words[0].toUpperCase()}${words.slice(1)}`;
}

// Returns the range of a parameter in words, such as "from 3 to 16,777,216" or "above 0", or '' if
// every number is allowed. Pure.
export function rangeOf({ min, max, exclusive }) {
    const parts = [];
    if (min > -ENDLESS) {
        parts.push(exclusive ? `above ${formatCount(min)}` : `from ${formatCount(min)}`);
    }
    if (max < ENDLESS) {
        parts.push(`to ${formatCount(max)}`);
    }
    return parts.join(' ');
}

class NewShape {
    #shapes;
    #onMade;
    #ask;
    #shape;
    #name = new Text();
    #doc = make('span');
    #rows = make('div', { className: 'ask-rows' });
    #controls = new Map(); // name of a parameter of the shape -> its control

    constructor(shapes, onMade) {
        [this.#shapes, this.#onMade] = [shapes, onMade];
        const first = shapes.find(({ name }) => name === lastShape) ?? shapes[0];
        this.#shape = new Choice(shapes.map(({ name }) => [name, wordsFor(name)]), first.name);
        this.#shape.node.addEventListener('change', () => this.showShape());
        this.#ask = new Ask(
            { title: 'New mesh from a shape', go: 'Create', onGo: () => this.#create() },
            field('shape', 'Shape', this.#shape, this.#doc),
            this.#rows,
            field('name', 'Name', this.#name),
        );
    }

    // Shows the fields of the chosen shape, filled with what the server would take for them.
    showShape() {
        const { name: shape, doc, params } = this.#shapes.find(
            ({ name }) => name === this.#shape.read(),
        );
        this.#doc.textContent = doc;
        this.#name.node.placeholder = wordsFor(shape);
        this.#controls.clear();
        const rows = params.map((param) => {
            const control = controlOf(param);
            this.#controls.set(param.name, control);
            return field(param.name, wordsFor(param.name), control, helpOf(param));
        });
        this.#ask.setRows(this.#rows, rows);
    }

    async #create() {
        const shape = this.#shape.read();
        lastShape = shape;
        const values = Object.fromEntries(
            [...this.#controls].map(([name, control]) => [name, control.read()]),
        );
        const name = this.#name.read() ?? wordsFor(shape);
        this.#ask.start(`Making ${name}`);
        await this.#onMade(await api.create({ shape, name, ...values }, this.#ask));
    }
}

function controlOf({ name, type, default: usual }) {
    if (type === 'boolean') {
        return new Flag(usual);
    }
    const control = new Numeral(name, `${usual}`, type === 'integer' ? '1' : 'any');
    control.node.value = usual;
    return control;
}

// Returns what a parameter is for, and its range.
function helpOf(param) {
    const doc = `${param.doc[0].toUpperCase()}${param.doc.slice(1)}`;
    const marks = param.type === 'boolean' ? '' : rangeOf(param);
    return marks === '' ? `${doc}.` : `${doc}, ${marks}.`;
}
