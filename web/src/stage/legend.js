// legend.js - lists the materials of the open mesh with names and colours, and has the checkbox
// that shows or hides their colours on faces.

import { formatMeasure, make } from '../kit/dom.js';
import { toScreen } from '../open/materials.js';

// If there are more materials than this, the rest is shown after a click on a button.
const MOST = 50;

export class Legend {
    #section;
    #list;
    #current = '';

    // `section` contains the list and the checkbox, `toggle`; `onToggle(isOn)` is called when the
    // checkbox changes.
    constructor({ section, list, toggle }, { onToggle }) {
        this.#section = section;
        this.#list = list;
        toggle.addEventListener('change', () => onToggle(toggle.checked));
    }

    // Shows the materials of a mesh, see Materials.
    show(materials) {
        const rows = materials.list.map(rowOf);
        this.#section.hidden = materials.isEmpty;
        this.#list.replaceChildren(...rows.slice(0, MOST));
        if (rows.length > MOST) {
            this.#offerRest(rows.slice(MOST));
        }
        this.#mark();
    }

    #offerRest(rest) {
        const button = make(
            'button',
            {
                type: 'button',
                className: 'quiet',
                onclick: () => {
                    button.parentElement.replaceWith(...rest);
                    this.#mark();
                },
            },
            `Show ${rest.length} more`,
        );
        this.#list.append(make('li', {}, button));
    }

    // Marks the material of the selected face in the list; `name` is '' if there is none.
    setCurrent(name) {
        this.#current = name;
        this.#mark();
    }

    #mark() {
        for (const row of this.#list.querySelectorAll('[data-material]')) {
            if (this.#current !== '' && row.dataset.material === this.#current) {
                row.setAttribute('aria-current', 'true');
            } else {
                row.removeAttribute('aria-current');
            }
        }
    }
}

function rowOf({ name, look }) {
    const swatch = make('span', { className: 'swatch', 'aria-hidden': 'true' });
    swatch.classList.toggle('unknown', look === null);
    if (look !== null) {
        swatch.style.backgroundColor = colorOf(look.base_color);
        // A material that emits light gets a glow around its swatch.
        if (look.emission.some((part) => part > 0)) {
            swatch.style.boxShadow = `0 0 6px 1px ${colorOf([...look.emission, 1])}`;
        }
    }
    const row = make(
        'li',
        {},
        swatch,
        make('span', { className: 'material-name', title: name }, name),
        make('span', { className: 'material-notes' }, notesOf(look).join(', ')),
    );
    row.dataset.material = name;
    return row;
}

function colorOf([red, green, blue, opacity]) {
    const parts = [red, green, blue].map((part) => Math.round(255 * toScreen(part)));
    return `rgb(${parts.join(' ')} / ${opacity})`;
}

// Returns notes on those properties of a material that the patch of colour in the list does not
// show.
function notesOf(look) {
    if (look === null) {
        return ['unknown colour'];
    }
    const notes = [];
    if (look.base_color[3] < 1) {
        notes.push(`opacity ${formatMeasure(look.base_color[3], 3)}`);
    }
    if (look.metallic > 0) {
        notes.push(`metallic ${formatMeasure(look.metallic, 3)}`);
    }
    if (look.two_sided) {
        notes.push('two-sided');
    }
    return notes;
}
