// rows.js - an array of geometry.js as a texture that is ROW texels wide, which can be uploaded in
// parts.

import { DataTexture, NearestFilter } from 'three';

import { ROW } from '../geometry/geometry.js';

// If more than this fraction of all texels has changed, the whole texture is uploaded: the fraction
// is MANY for changes of single texels, MOST for changes of long ranges.
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

    // Called when the texels at `places` of the array have changed (null: any texels), or when the
    // array was replaced. Returns the texture to use from now on, a new one if the array is new.
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

    // Called when the array has changed within some ranges of texels, [begin, end], which are in
    // ascending order and each within one row of the texture.
    updateWithin(ranges) {
        const texels = ranges.reduce((sum, [begin, end]) => sum + end - begin, 0);
        this.#send(texels >= MOST * (this.image.data.length / 4) ? null : ranges);
    }

    // Uploads ranges, or everything (null).
    #send(ranges) {
        if (ranges?.length === 0) {
            return;
        }
        // The first upload must be of the whole texture: with a range set, three.js would upload
        // only that range.
        if (this.#isSent && ranges !== null) {
            ranges.forEach(([begin, end]) => this.addUpdateRange(4 * begin, 4 * (end - begin)));
        } else {
            this.forget();
        }
        this.needsUpdate = true;
    }

    // Called when the copy in graphics memory is lost or outdated: next time the whole texture is
    // uploaded.
    forget() {
        this.#isSent = false;
        this.clearUpdateRanges();
    }
}

// Combines indices in ascending order into few ranges, each within one row.
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
