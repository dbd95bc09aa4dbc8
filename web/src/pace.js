// pace.js - how the slider of levels runs, and how long it takes to play them. Pure.
//
// Each step of the slider refines a mesh by about the same part of its faces, for that is what one
// sees: of few levels each has a position, of many the coarse ones lie as far apart as the fine.

// Positions the slider has at most, beside 0.
const MOST = 1000;

// A split has two faces, and seconds for each time they double.
const FACES = 2;
const SECONDS = 0.35;
const [LEAST_SECONDS, MOST_SECONDS] = [1.5, 7];

export class Pace {
    positions;
    seconds; // to play all
    #faces;
    #levels;
    #growth; // how many times the faces of the base there are in the end

    // `faces` of the base, and levels beside it.
    constructor(faces, levels) {
        this.#faces = Math.max(faces, 1);
        this.#levels = levels;
        this.#growth = (this.#faces + FACES * levels) / this.#faces;
        this.positions = Math.min(levels, MOST);
        const seconds = SECONDS * Math.log2(this.#growth);
        this.seconds = Math.min(Math.max(seconds, LEAST_SECONDS), MOST_SECONDS);
    }

    // The level at a position, which need be no whole number.
    levelAt(position) {
        if (position >= this.positions) {
            return this.#levels;
        }
        const faces = this.#faces * this.#growth ** (position / this.positions);
        const level = Math.round((faces - this.#faces) / FACES);
        // No two positions have one level.
        return Math.min(Math.max(level, Math.floor(position)), this.#levels);
    }

    // The first position with a level, or a finer one.
    positionOf(level) {
        let [low, high] = [0, this.positions];
        while (low < high) {
            const middle = Math.floor((low + high) / 2);
            [low, high] = this.levelAt(middle) < level ? [middle + 1, high] : [low, middle];
        }
        return low;
    }
}
