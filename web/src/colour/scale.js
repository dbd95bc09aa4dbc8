// scale.js - the part of the page that shows which colour stands for which number, with a histogram,
// and in which the user chooses the colours and the range that they cover.

import { formatMeasure, formatNumberOf, make } from '../kit/dom.js';
import { BINS, histogramOf, paint } from './bars.js';
import { COLOURS, MISSING, indexOf } from './maps.js';

const STEPS = 200; // of a handle of the range

// If there are more categories than this, the rest is shown after a click on a button.
const MOST = 24;

const NAMES = { sequential: 'Dark to light', diverging: 'Blue to red', categorical: 'Distinct colours' };

export class Scale {
    #box;
    #acts;
    #shown = null;
    #drawn = null; // the nodes that change with the range

    // `box` gets the contents. `onMap(name)` is called when the user chooses a map, `onRange(range)`
    // when the range is changed, `onBin(bin)` when a bar of the histogram is clicked, `onValue(value)`
    // when a category is clicked, and `onRangeSelect()` when the elements in the range are wanted.
    constructor(box, acts) {
        this.#box = box;
        this.#acts = acts;
    }

    clear() {
        this.#shown = null;
        this.#box.replaceChildren();
    }

    // Shows the colours of a column. `shown` is {column, map, maps, bytes, range, usual, categories,
    // textOf, noun}: `maps` are the names of the maps that may be chosen, `bytes` the colours of
    // `map`, `usual` the range without a choice of the user, `textOf(number)` the text of a number,
    // `noun(count)` names as many elements. If the user moves a handle, it keeps the focus.
    show(shown) {
        const isSame = this.#shown?.column === shown.column && this.#shown?.map === shown.map;
        this.#shown = shown;
        if (isSame && this.#drawn !== null) {
            this.#refresh();
            return;
        }
        const focused = this.#box.contains(document.activeElement)
            ? document.activeElement.dataset.part
            : undefined;
        this.#drawn = null;
        this.#box.replaceChildren(
            this.#mapChoice(),
            ...(shown.map === 'categorical' ? [this.#categories()] : this.#range()),
            ...this.#missing(),
        );
        this.#box.querySelector(`[data-part="${focused}"]`)?.focus();
    }

    #mapChoice() {
        const { map, maps } = this.#shown;
        const select = make(
            'select',
            { className: 'wide', 'aria-label': 'Colours', 'data-part': 'map' },
            ...maps.map((name) => make('option', { value: name }, NAMES[name])),
        );
        select.value = map;
        select.addEventListener('change', () => this.#acts.onMap(select.value));
        return select;
    }

    // --- a range of numbers ---

    // The values at the ends of the picture: the data and what the colours cover.
    get #axis() {
        const { column, range, usual } = this.#shown;
        return [Math.min(column.least, usual[0], range[0]), Math.max(column.most, usual[1], range[1])];
    }

    #colourAt(value) {
        const { bytes, range } = this.#shown;
        const at = 4 * indexOf(value, range);
        return `rgb(${bytes[at]} ${bytes[at + 1]} ${bytes[at + 2]})`;
    }

    #range() {
        if (this.#shown.column.count === 0) {
            return [];
        }
        const picture = make('div', { className: 'bars' });
        const strip = make('canvas', { className: 'strip', 'aria-hidden': 'true' });
        const [low, high] = ['Lowest', 'Highest'].map((title, end) => this.#handle(title, end));
        const [from, to] = ['Lowest', 'Highest'].map((title, end) => this.#field(title, end));
        const reset = make(
            'button',
            {
                type: 'button',
                className: 'quiet',
                'data-part': 'reset',
                onclick: () => this.#acts.onRange(null),
            },
            'Reset the range',
        );
        const select = make(
            'button',
            {
                type: 'button',
                className: 'quiet',
                'data-part': 'select',
                onclick: () => this.#acts.onRangeSelect(),
            },
            'Select what is in the range',
        );
        this.#drawn = { picture, strip, handles: [low, high], fields: [from, to] };
        this.#refresh();
        return [
            picture,
            strip,
            make('div', { className: 'handles' }, low, high),
            make('div', { className: 'ends' }, from, to),
            make('div', { className: 'range-acts' }, reset, select),
        ];
    }

    #handle(title, end) {
        const handle = make('input', {
            type: 'range',
            min: 0,
            max: STEPS,
            step: 1,
            autocomplete: 'off',
            'aria-label': `${title} colour`,
            'data-part': `handle-${end}`,
        });
        handle.addEventListener('input', () => {
            const [from, to] = this.#drawn.axis;
            this.#set(end, from + ((to - from) * handle.valueAsNumber) / STEPS);
        });
        return handle;
    }

    #field(title, end) {
        const field = make('input', {
            type: 'number',
            step: 'any',
            autocomplete: 'off',
            'aria-label': `${title} value`,
            'data-part': `field-${end}`,
        });
        field.addEventListener('change', () => {
            if (field.value === '' || !Number.isFinite(field.valueAsNumber)) {
                this.#refresh();
            } else {
                this.#set(end, field.valueAsNumber);
            }
        });
        return field;
    }

    // Moves one end of the range; it cannot pass the other end.
    #set(end, value) {
        const range = [...this.#shown.range];
        range[end] = end === 0 ? Math.min(value, range[1]) : Math.max(value, range[0]);
        this.#acts.onRange(range);
        this.#refresh();
    }

    #refresh() {
        const { column, range, textOf } = this.#shown;
        const { picture, strip, handles, fields } = this.#drawn;
        // While a handle is dragged, the axis stays, so that the handle stays under the pointer.
        const isHeld = handles.includes(document.activeElement) && this.#drawn.axis !== undefined;
        const axis = isHeld ? this.#drawn.axis : this.#axis;
        this.#drawn.axis = axis;
        const colourAt = (value) => this.#colourAt(value);
        const { least, most } = column;
        const counts = column.histogram(BINS);
        picture.replaceChildren(
            histogramOf({ counts, least, most, axis, colourAt }, this.#acts.onBin),
        );
        paint(strip, axis, colourAt);
        const width = axis[1] - axis[0];
        range.forEach((value, end) => {
            const part = width > 0 ? (value - axis[0]) / width : end;
            handles[end].valueAsNumber = Math.round(part * STEPS);
            handles[end].setAttribute('aria-valuetext', textOf(value));
            if (document.activeElement !== fields[end] || !fields[end].matches(':invalid')) {
                fields[end].value = String(Number(value.toPrecision(6)));
            }
        });
    }

    // --- categories ---

    #categories() {
        const { categories, bytes, textOf, noun } = this.#shown;
        const rows = categories.map(({ value, count }, i) => {
            const swatch = make('span', { className: 'swatch', 'aria-hidden': 'true' });
            const at = 4 * (i % COLOURS);
            swatch.style.backgroundColor = `rgb(${bytes[at]} ${bytes[at + 1]} ${bytes[at + 2]})`;
            const button = make(
                'button',
                {
                    type: 'button',
                    className: 'category',
                    title: `Select ${noun(count)}`,
                    onclick: () => this.#acts.onValue(value),
                },
                swatch,
                make('span', { className: 'material-name' }, textOf(value)),
                make('span', { className: 'material-notes' }, noun(count)),
            );
            const row = make('li', {}, button);
            row.dataset.value = value;
            return row;
        });
        const list = make('ul', { className: 'materials' }, ...rows.slice(0, MOST));
        const rest = rows.slice(MOST);
        if (rest.length > 0) {
            const button = make(
                'button',
                {
                    type: 'button',
                    className: 'quiet',
                    onclick: () => button.parentElement.replaceWith(...rest),
                },
                `Show ${rest.length} more`,
            );
            list.append(make('li', {}, button));
        }
        return list;
    }

    // Says how many elements have no value, and in which colour they are.
    #missing() {
        const { column, noun } = this.#shown;
        return column.missing === 0 ? [] : [missingNote(noun(column.missing))];
    }
}

// Returns a line that says what has no value; `what` is as in "3 faces".
export function missingNote(what) {
    const swatch = make('span', { className: 'swatch', 'aria-hidden': 'true' });
    swatch.style.backgroundColor = `rgb(${MISSING.join(' ')})`;
    return make('p', { className: 'small missing' }, swatch, `No value: ${what}`);
}

// Returns the text of a number with its unit.
export function withUnit(number, unit) {
    return unit === '' ? formatMeasure(number) : `${formatMeasure(number)} ${unit}`;
}

// Returns a function that names elements of a kind: 'face' as "1 face" or "1,234 faces".
export function nounOf(kind) {
    return (count) => formatNumberOf(count, kind, kind === 'vertex' ? 'vertices' : `${kind}s`);
}
