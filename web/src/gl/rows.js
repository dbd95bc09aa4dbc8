// rows.js - an array of geometry.js as a texture of ROW texels across, of which parts can be sent
// to the graphics memory again. With render.js the only module that knows three.

import { DataTexture, NearestFilter } from 'three';

import { ROW } from '../geometry.js';

// More changed texels than this part of all of them are sent as a whole; in ranges that are long
// already a larger part.
const MANY = 1 / 8;
const MOST = 1 / 2;

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

    // The array was changed at some places, or anywhere (null), or it is another one. Returns the
    // texture to use from now on, which is another one where the array is.
    update(array, places) {
        if (array !== this.image.data) {
            const longer = new Rows(array, this.format, this.type);
            this.dispose();
            return longer;
        }
        const isMany = places === null || places.length >= MANY * (array.length / 4);
        this.#send(isMany ? null : rangesOf(places));
        return this;
    }

    // The array was changed in some ranges [begin, end] in rising order, none of which goes beyond
    // its row.
    updateWithin(ranges) {
        const texels = ranges.reduce((sum, [begin, end]) => sum + end - begin, 0);
        this.#send(texels >= MOST * (this.image.data.length / 4) ? null : ranges);
    }

    // Ranges, or all of it (null).
    #send(ranges) {
        if (ranges?.length === 0) {
            return;
        }
        // What was never sent is sent whole, and a range would keep it from that.
        if (this.#isSent && ranges !== null) {
            ranges.forEach(([begin, end]) => this.addUpdateRange(4 * begin, 4 * (end - begin)));
        } else {
            this.forget();
        }
        this.needsUpdate = true;
    }

    // What the graphics memory had of it is lost or old: all of it is sent next time.
    forget() {
        this.#isSent = false;
        this.clearUpdateRanges();
    }
}

// Places in rising order as few ranges, none of which goes beyond its row.
function rangesOf(places) {
    const ranges = [];
    let begin = 0;
    for (let i = 1; i <= places.length; i++) {
        const goesOn = places[i] === places[i - 1] + 1 && places[i] % ROW !== 0;
        if (!goesOn) {
            ranges.push([places[begin], places[i - 1] + 1]);
            begin = i;
        }
    }
    return ranges;
}
