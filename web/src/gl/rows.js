// rows.js - an array of geometry.js as a texture of ROW texels across, of which parts can be sent to
// the graphics memory again. With render.js the only module that knows three.

import { DataTexture, NearestFilter } from 'three';

import { ROW } from '../geometry.js';

// More changed texels than this part of all of them are sent as a whole.
const MANY = 1 / 8;

export class Rows extends DataTexture {
    #isSent = false;

    constructor(array, format, type) {
        super(array, ROW, array.length / (4 * ROW), format, type);
        this.minFilter = NearestFilter;
        this.magFilter = NearestFilter;
        this.needsUpdate = true;
        this.onUpdate = () => {
            this.#isSent = true;
        };
    }

    // The array was changed at some places, or it is another one and longer. Returns the texture to
    // use from now on, which is another one where the array is.
    update(array, places) {
        if (array !== this.image.data) {
            const longer = new Rows(array, this.format, this.type);
            this.dispose();
            return longer;
        }
        if (places.length === 0) {
            return this;
        }
        // What was never sent is sent whole, and a range would keep it from that.
        if (this.#isSent && places.length < MANY * (array.length / 4)) {
            this.#addRanges(places);
        } else {
            this.forget();
        }
        this.needsUpdate = true;
        return this;
    }

    // Places in rising order, as few ranges, none of which goes beyond its row.
    #addRanges(places) {
        let begin = 0;
        for (let i = 1; i <= places.length; i++) {
            const goesOn = places[i] === places[i - 1] + 1 && places[i] % ROW !== 0;
            if (!goesOn) {
                this.addUpdateRange(4 * places[begin], 4 * (i - begin));
                begin = i;
            }
        }
    }

    // What the graphics memory had of it is lost or old: all of it is sent next time.
    forget() {
        this.#isSent = false;
        this.clearUpdateRanges();
    }
}
