// value_text.js - writes the values by which a mesh is coloured as text. Pure.

import { formatMeasure } from '../kit/dom.js';
import { withUnit } from './scale.js';

// Writes the values of a source that were read, `numbers` by id; `column` has the numbers that are shown,
// or is null if the values are shown as vectors.
export class ValueText {
    #source;
    #numbers;
    #column;

    constructor(source, { numbers }, column) {
        [this.#source, this.#numbers, this.#column] = [source, numbers, column];
    }

    // Returns whether an element has a value.
    isKnown(id) {
        const own = this.#own(id);
        return own.length === this.#source.components && own.every((number) => Number.isFinite(number));
    }

    #own(id) {
        const { components } = this.#source;
        return this.#numbers.subarray(components * id, components * (id + 1));
    }

    // Returns the text of a number: its label, if the attribute has labels.
    ofNumber(number) {
        const label = this.#source.labels?.[number];
        return label === undefined ? formatMeasure(number) : label === '' ? '(no name)' : label;
    }

    // Returns the value of an element as text.
    of(id) {
        const { unit, labels } = this.#source;
        if (this.#column === null) {
            return this.isKnown(id)
                ? [...this.#own(id)].map((number) => formatMeasure(number, 4)).join(' ')
                : 'no value';
        }
        const number = this.#column.at(id);
        if (Number.isNaN(number)) {
            return 'no value';
        }
        return labels === null ? withUnit(number, unit) : this.ofNumber(number);
    }
}
