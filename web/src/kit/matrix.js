// matrix.js - the form control for an affine map, with fields for scaling, rotation and translation
// or a text area for the 16 numbers of its matrix. See controls.js.

import { compose, textOf } from './affine.js';
import { Vector, WithText } from './controls.js';
import { make } from './dom.js';
import { numbersOf } from './numbers.js';

// Each row is [parameter of compose(), its label in the form, the value of an empty field].
const STEPS = [
    ['scale', 'Scale', 1],
    ['rotate', 'Rotate, degrees', 0],
    ['translate', 'Move', 0],
];

class Steps {
    node;
    #vectors;
    #about;

    // `pickable(name, control)` returns an element with the control's node and a button; after a
    // click on the button, a click in the view fills the control.
    constructor(pickable) {
        const all = [...STEPS, ['about', 'Around the point', 0]];
        this.#vectors = Object.fromEntries(
            all.map(([member, , usual]) => [member, new Vector(member, { usual })]),
        );
        this.#about = this.#vectors.about;
        const rows = all.map(([member, label]) => {
            const control = this.#vectors[member];
            const node = member === 'about' ? pickable(member, control) : control.node;
            return make('div', { className: 'step' }, make('span', {}, label), node);
        });
        this.node = make('div', { className: 'steps' }, ...rows);
    }

    get main() {
        return this.#vectors.scale.main;
    }

    // A centre of rotation alone changes nothing, so the control has no value if only the centre is
    // given.
    get isSaid() {
        return STEPS.some(([member]) => this.#vectors[member].isSaid);
    }

    clear() {
        Object.values(this.#vectors).forEach((vector) => vector.clear());
    }

    read() {
        if (!this.isSaid) {
            return undefined;
        }
        const usual = { scale: [1, 1, 1] };
        const said = Object.entries(this.#vectors).map(([member, vector]) => [
            member,
            vector.read() ?? usual[member] ?? [0, 0, 0],
        ]);
        return compose(Object.fromEntries(said));
    }
}

export function matrix(name, pickable) {
    const steps = new Steps(pickable);
    return new WithText(steps, {
        name,
        placeholder: '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1',
        write: () => (steps.isSaid ? textOf(steps.read()) : ''),
        parse: (text) => numbersOf(text, name),
        labels: ['As 16 numbers', 'As steps'],
    });
}
