// pace.js - computes which level of detail each position of the slider shows, and how long it takes
// to play all levels from coarse to fine. Pure.
//
// Each step of the slider refines a mesh by about the same part of its faces, because that is what
// the eye notices. If there are few levels, each has its own position of the slider; if there are
// many, several fine levels share a position.

// The largest position of the slider; the smallest is 0.
const MOST = 1000;

// A vertex split, which leads from one level to the next, adds two faces. Playing takes SECONDS
// each time the number of faces doubles, but in all at least LEAST_SECONDS and at most
// MOST_SECONDS.
const FACES = 2;
const SECONDS = 0.35;
const [LEAST_SECONDS, MOST_SECONDS] = [1.5, 7];

export class Pace {
    positions;
    seconds; // time to play all levels
    #faces;
    #levels;
    #growth; // number of faces of the finest level divided by that of the base

    // `faces` is the number of faces of the base, the coarsest level; `levels` is the number of
    // levels besides the base.
    constructor(faces, levels) {
        this.#faces = Math.max(faces, 1);
        this.#levels = levels;
        this.#growth = (this.#faces + FACES * levels) / this.#faces;
        this.positions = Math.min(levels, MOST);
        const seconds = SECONDS * Math.log2(this.#growth);
        this.seconds = Math.min(Math.max(seconds, LEAST_SECONDS), MOST_SECONDS);
    }

    // Returns the level at a position of the slider, which need not be a whole number.
    levelAt(position) {
        if (position >= this.positions) {
            return this.#levels;
        }
        const faces = this.#faces * this.#growth ** (position / this.positions);
        const level = Math.round((faces - this.#faces) / FACES);
        // The result is at least the whole part of the position, so that two positions which are
        // whole numbers show different levels.
        return Math.min(Math.max(level, Math.floor(position)), this.#levels);
    }

    // Returns the first position of the slider that has this level or a finer one.
    positionOf(level) {
        let [low, high] = [0, this.positions];
        while (low < high) {
            const middle = Math.floor((low + high) / 2);
            [low, high] = this.levelAt(middle) < level ? [middle + 1, high] : [low, middle];
        }
        return low;
    }
}
