// motion.js - whether the camera is moving, and whether the frames meanwhile are slow.

// The camera moves until it has not moved for this many milliseconds.
const REST = 200;

// A frame is slow if it is drawn later than this many milliseconds after it was asked for, because
// earlier frames are still being drawn. Several slow frames in a row count.
const SLOW = 50;
const MANY = 2;

export class Motion {
    isMoving = false;
    #timer = 0;
    #asked = 0;
    #slow = 0;
    #onRest;

    // `onRest()` is called when the camera has come to rest.
    constructor(onRest) {
        this.#onRest = onRest;
    }

    moved() {
        this.isMoving = true;
        clearTimeout(this.#timer);
        this.#timer = setTimeout(() => {
            this.isMoving = false;
            this.#slow = 0;
            this.#onRest();
        }, REST);
    }

    ask() {
        this.#asked = performance.now();
    }

    // Called when a frame is about to be drawn. Returns whether it is one of several slow frames.
    isSlow() {
        if (this.isMoving) {
            this.#slow = performance.now() - this.#asked > SLOW ? this.#slow + 1 : 0;
        }
        return this.#slow >= MANY;
    }
}
