// section.js - the controls of the section plane: its direction, its position, and what the cut
// measures.

import { formatNumberOf } from '../kit/dom.js';
import { formatSize, unitText } from '../kit/units.js';
import { AXES, anglesOf, normalOfAngles } from './state.js';

const STEPS = 1000; // of the slider

export class SectionForm {
    #elements;
    #acts;
    #section = null;
    #range = [0, 0];

    // `elements` are `axes`, which contains the radio buttons for the direction; `box`, which is shown
    // while there is a section, with `slider`, `at`, `unit`, `flip`, and `length`, `area` and `loops`
    // for the measures; and `free`, which is shown for a free direction, with `turn`, `tilt` and `view`.
    //
    // `onChange(section)` is called with another section, see state.js; `rangeOf(normal)` returns
    // [least, most] of its position; `direction()` returns the direction from the mesh to the camera.
    constructor(elements, { onChange, rangeOf, direction }) {
        this.#elements = elements;
        this.#acts = { onChange, rangeOf, direction };
        const { axes, slider, at, flip, turn, tilt, view } = elements;
        axes.addEventListener('change', ({ target }) => this.#choose(target.value));
        slider.addEventListener('input', () => {
            const [least, most] = this.#range;
            // As many digits as the steps of the slider need.
            const place = least + ((most - least) * Number(slider.value)) / STEPS;
            this.#change({ at: roundTo(place, (most - least) / STEPS) });
        });
        at.addEventListener('change', () => {
            if (at.value !== '' && at.validity.valid) {
                this.#change({ at: Number(at.value) });
            } else {
                this.show(this.#section);
            }
        });
        flip.addEventListener('click', () => this.#change({ isFlipped: !this.#section.isFlipped }));
        for (const slope of [turn, tilt]) {
            slope.addEventListener('input', () => {
                this.#turnTo(normalOfAngles(Number(turn.value), Number(tilt.value)));
            });
        }
        view.addEventListener('click', () => this.#turnTo(this.#acts.direction()));
    }

    #choose(axis) {
        if (axis === 'none') {
            this.#acts.onChange(null);
            return;
        }
        // A free plane begins as the one that was there.
        const normal = AXES[axis] ?? this.#section?.normal ?? AXES.x;
        const isKept = axis === 'free' && this.#section !== null;
        this.#acts.onChange({
            axis,
            normal,
            at: isKept ? this.#section.at : middleOf(this.#acts.rangeOf(normal)),
            isFlipped: this.#section?.isFlipped ?? false,
        });
    }

    // Turns the plane around its place: its part of the way through the mesh stays the same.
    #turnTo(normal) {
        const [least, most] = this.#range;
        const part = most > least ? (this.#section.at - least) / (most - least) : 0.5;
        const [low, high] = this.#acts.rangeOf(normal);
        const at = roundTo(low + part * (high - low), (high - low) / STEPS);
        this.#change({ normal, at });
    }

    #change(part) {
        this.#acts.onChange({ ...this.#section, ...part });
    }

    // Shows a section, or none (null).
    show(section) {
        this.#section = section;
        const { axes, box, slider, at, unit, flip, free, turn, tilt } = this.#elements;
        axes.querySelector(`input[value="${section?.axis ?? 'none'}"]`).checked = true;
        box.hidden = section === null;
        if (section === null) {
            return;
        }
        this.#range = this.#acts.rangeOf(section.normal);
        const [least, most] = this.#range;
        const part = most > least ? (section.at - least) / (most - least) : 0.5;
        slider.value = Math.round(STEPS * part);
        slider.setAttribute('aria-valuetext', formatSize(section.at));
        at.value = section.at;
        unit.textContent = unitText();
        flip.setAttribute('aria-pressed', `${section.isFlipped}`);
        free.hidden = section.axis !== 'free';
        const angles = anglesOf(section.normal);
        [turn.value, tilt.value] = [angles.turn, angles.tilt];
        turn.setAttribute('aria-valuetext', `${angles.turn}\u00b0`);
        tilt.setAttribute('aria-valuetext', `${angles.tilt}\u00b0`);
    }

    // Shows what the cut measures, {length, area, closed, open} in the coordinates of the mesh; null if
    // it is not known.
    measure(cut) {
        const { length, area, loops } = this.#elements;
        length.textContent = cut === null ? '\u2026' : formatSize(cut.length);
        area.textContent = cut === null ? '\u2026' : formatSize(cut.area, 2);
        loops.textContent = cut === null ? '\u2026' : loopsOf(cut);
    }
}

function middleOf([least, most]) {
    return roundTo((least + most) / 2, (most - least) / STEPS);
}

// Rounds a number to a decimal fraction; the error is less than a tenth of `step`.
function roundTo(value, step) {
    if (!(step > 0)) {
        return value;
    }
    const digits = Math.min(Math.max(Math.ceil(-Math.log10(step)) + 1, 0), 20);
    return Number(value.toFixed(digits));
}

function loopsOf({ closed, open }) {
    if (closed + open === 0) {
        return 'none';
    }
    const parts = [
        ...(closed > 0 ? [formatNumberOf(closed, 'closed loop')] : []),
        ...(open > 0 ? [formatNumberOf(open, 'open line')] : []),
    ];
    return parts.join(', ');
}
