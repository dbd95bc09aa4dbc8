// background.js - what is computed from the mesh for its look while the page goes on: a task, and the
// simpler mesh that is drawn while the camera moves.

import { cornerNormals } from '../geometry/normals.js';
import { proxyOf } from '../geometry/proxy.js';
import { inSlices } from '../kit/slices.js';

// A mesh with fewer triangles than this is never slow.
const LEAST = 20000;

// The crease angle of the simpler mesh. Its shape is rough, so it is drawn rather smoothly.
const PROXY_CREASE = 60;

// One computation, of which only the last one that was begun counts.
export class Task {
    #running = null;
    #onError;

    constructor(onError) {
        this.#onError = onError;
    }

    get isRunning() {
        return this.#running !== null;
    }

    // Computes what a generator returns and passes it to `use`.
    async begin(steps, use) {
        this.cancel();
        const running = new AbortController();
        this.#running = running;
        try {
            const result = await inSlices(steps, running.signal);
            if (running === this.#running) {
                this.#running = null;
                use(result);
            }
        } catch (error) {
            if (running === this.#running) {
                this.#running = null;
                this.#onError(error);
            }
        }
    }

    cancel() {
        this.#running?.abort();
        this.#running = null;
    }
}

// A generator that returns the simpler mesh, see Surface.setProxy(), or null if there is none.
export function* proxyFor(geometry) {
    if (geometry.triangleCount < LEAST) {
        return null;
    }
    const proxy = yield* proxyOf(geometry);
    if (proxy === null) {
        return null;
    }
    const { vertices, vertexCount } = geometry;
    const normals = yield* cornerNormals({ ...proxy, vertices, vertexCount }, PROXY_CREASE);
    return { ...proxy, normals };
}
