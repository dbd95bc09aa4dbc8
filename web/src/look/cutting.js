// cutting.js - computes the outline of a section, without blocking the page. While the user drags the
// slider, the newest plane is taken up when the outline of the one before is done, so that the cut
// follows however large the mesh is.

import { cutOutline } from '../geometry/outline.js';
import { inSlices } from '../kit/slices.js';

export class Cutting {
    #acts;
    #wanted = null;
    #running = null; // AbortController of the outline that is being computed

    // `onCut(plane, outline)` is called with each outline, see cutOutline().
    constructor({ onCut, onError }) {
        this.#acts = { onCut, onError };
    }

    get isRunning() {
        return this.#running !== null;
    }

    // Computes the outline of a plane; `isChanged` says that the geometry has changed since the last
    // call, so that what is being computed is worthless.
    want(geometry, plane, isChanged) {
        this.#wanted = { geometry, plane };
        if (isChanged) {
            this.#running?.abort();
        }
        if (this.#running === null) {
            this.#run();
        }
    }

    // Computes no outline any more.
    cancel() {
        this.#wanted = null;
        this.#running?.abort();
    }

    async #run() {
        while (this.#wanted !== null) {
            const { geometry, plane } = this.#wanted;
            const running = new AbortController();
            [this.#wanted, this.#running] = [null, running];
            try {
                const outline = await inSlices(cutOutline(geometry, plane), running.signal);
                if (!running.signal.aborted) {
                    this.#acts.onCut(plane, outline);
                }
            } catch (error) {
                if (!running.signal.aborted) {
                    this.#acts.onError(error);
                }
            }
        }
        this.#running = null;
    }
}
