// angle.js - a form control for an angle. People think in degrees, the server takes radians.

import { Numeral } from './controls.js';
import { slip } from './numbers.js';

// The digits that are kept when radians are written in degrees. Limits such as pi become whole numbers
// by that.
const DIGITS = 10;

export function degreesOf(radians) {
    return Number(((radians / Math.PI) * 180).toPrecision(DIGITS));
}

// A field for an angle in degrees, with a value in radians; it may be empty. An angle outside of `min`
// to `max`, which are in radians, is refused here, because the server would name limits in radians.
export class Angle extends Numeral {
    #name;
    #limits;

    constructor(name, placeholder, { min = -Infinity, max = Infinity } = {}) {
        super(name, placeholder);
        [this.#name, this.#limits] = [name, [min, max].map(degreesOf)];
    }

    read() {
        const degrees = super.read();
        const [min, max] = this.#limits;
        if (degrees < min || degrees > max) {
            throw slip(
                this.#name,
                'Out of range',
                `${this.#name} must be from ${min} to ${max} degrees.`,
            );
        }
        return degrees === undefined ? undefined : (degrees / 180) * Math.PI;
    }
}
