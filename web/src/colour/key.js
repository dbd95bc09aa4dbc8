// key.js - the small legend over the view: what the colours mean, and the value under the pointer.

import { make } from '../kit/dom.js';
import { paint } from './bars.js';
import { indexOf } from './maps.js';

// The number of categories that fit.
const MOST = 6;

export class Key {
    #box;
    #value = make('p', { className: 'key-value' });

    constructor(box) {
        this.#box = box;
    }

    hide() {
        this.#box.hidden = true;
        this.#value.textContent = '';
    }

    // Shows a title, and below it the colours of a range, some categories, or nothing. `shown` is as
    // in Scale.show(), or null.
    show(title, shown) {
        this.#box.hidden = false;
        const parts = [make('p', { className: 'key-title' }, title)];
        if (shown !== null && shown.map === 'categorical') {
            parts.push(this.#categories(shown));
        } else if (shown !== null && shown.column.count > 0) {
            parts.push(...this.#range(shown));
        }
        this.#box.replaceChildren(...parts, this.#value);
    }

    #range({ bytes, range, textOf }) {
        const strip = make('canvas', { className: 'strip', 'aria-hidden': 'true' });
        paint(strip, range, (value) => {
            const at = 4 * indexOf(value, range);
            return `rgb(${bytes[at]} ${bytes[at + 1]} ${bytes[at + 2]})`;
        });
        const ends = range.map((value) => make('span', {}, textOf(value)));
        return [strip, make('p', { className: 'key-ends' }, ...ends)];
    }

    #categories({ categories, bytes, textOf }) {
        const rows = categories.slice(0, MOST).map(({ value }, i) => {
            const swatch = make('span', { className: 'swatch', 'aria-hidden': 'true' });
            swatch.style.backgroundColor = `rgb(${bytes[4 * i]} ${bytes[4 * i + 1]} ${bytes[4 * i + 2]})`;
            return make('li', {}, swatch, textOf(value));
        });
        if (categories.length > MOST) {
            rows.push(make('li', {}, `${categories.length - MOST} more`));
        }
        return make('ul', {}, ...rows);
    }

    // Shows the value of an element as text; '' removes it.
    setValue(text) {
        this.#value.textContent = text;
    }
}
