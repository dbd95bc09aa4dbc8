// bend.js - bends what is around a moved part: while the part is dragged, the server computes where
// all vertices would be, and the view shows the mesh there without an edit. The edit that is run at
// the end is one `deform`.
//
//     begin(vertices)   the vertices that will move are chosen
//     move(by)          they shall be moved by this vector from where they were; the newest wins
//     end()             the drag is over; what is shown stays until settle()
//     cancel()          shows the mesh as it is

import { heldAround } from './ways.js';

// The number of steps times the number of vertices is at most WORK, so that a step of the drag stays
// quick. It is the same for a preview and for the edit, so that both lead to the same positions.
const WORK = 60000;
const MOST_STEPS = 8;

// The position of the slider at which everything bends.
const ALL = 100;

export class Bend {
    #elements;
    #acts;
    #drag = null; // {vertices, fixed, geometry, wanted, isEnding}
    #asking = null; // AbortController of the request that runs

    // `box` is shown while something can be bent; it has the checkbox `toggle` and, in `row`, the
    // slider `radius` with the output `reach`; errors of a preview are shown in `said`. `acts`:
    // geometry() returns the arrays of the mesh that is shown, or null; ask(operation, signal)
    // returns {ids, positions} of the deformed vertices; show(ids, places) shows vertices at other
    // places, in view coordinates, and show(null) where they are.
    constructor({ box, toggle, row, radius, reach, said }, acts) {
        this.#elements = { box, toggle, row, radius, reach, said };
        this.#acts = acts;
        toggle.addEventListener('change', () => {
            row.hidden = !toggle.checked;
            this.cancel();
        });
        radius.addEventListener('input', () => {
            this.#tellReach();
            this.cancel();
        });
        row.hidden = !toggle.checked;
        this.#tellReach();
    }

    // Shows or hides the choice whether to bend.
    offer(isOffered) {
        this.#elements.box.hidden = !isOffered;
        this.#say('');
    }

    get isOn() {
        return !this.#elements.box.hidden && this.#elements.toggle.checked;
    }

    // Takes the result of a drag with the tool Move, see drag() in gesture.js. Returns it unchanged
    // if nothing is to bend, or if all of the mesh moves, so that nothing is left to bend; else one
    // whose operation bends, and moves the preview. A drag that begins while the edit of an earlier
    // one is awaited is a drag of its own.
    follow(result) {
        const { operation } = result;
        if (!this.isOn || operation?.op !== 'vertex_move') {
            return result;
        }
        if (this.#drag === null || this.#drag.isEnding) {
            this.begin(operation.vertices);
        }
        if (this.#drag.fixed.length === 0) {
            return result;
        }
        this.move(operation.by);
        return { ...result, lines: [], operation: this.#operation(operation.by) };
    }

    begin(vertices) {
        if (this.#drag !== null) {
            this.#forget();
        }
        const geometry = this.#acts.geometry();
        const fixed = heldAround(geometry, vertices, Number(this.#elements.radius.value) / ALL);
        this.#drag = { vertices, fixed, geometry, wanted: null, isEnding: false };
    }

    // Moves the vertices by a vector in coordinates of the mesh. While the answer to an earlier call
    // is awaited, only the last vector is kept.
    move(by) {
        const drag = this.#drag;
        drag.wanted = by;
        if (this.#asking === null) {
            this.#askOn(drag);
        }
    }

    // Ends the drag. The last answer stays in the view until settle() is called, when the edit has
    // been made or has failed.
    end() {
        if (this.#drag !== null) {
            this.#drag.isEnding = true;
            this.#drag.wanted = null;
        }
    }

    settle() {
        if (this.#drag?.isEnding) {
            this.#forget();
        }
    }

    // Called when a drag was given up, or the mesh has changed.
    cancel() {
        if (this.#drag !== null && !this.#drag.isEnding) {
            this.#forget();
        }
    }

    #forget() {
        this.#drag = null;
        this.#asking?.abort();
        this.#asking = null;
        this.#acts.show(null);
    }

    #operation(by) {
        const { vertices, fixed, geometry } = this.#drag;
        const steps = Math.min(Math.max(Math.floor(WORK / geometry.vertexCount), 1), MOST_STEPS);
        return { op: 'deform', method: 'arap', steps, vertices, by, fixed };
    }

    // Asks for one position after the other, as long as newer ones are wanted.
    async #askOn(drag) {
        const asking = new AbortController();
        this.#asking = asking;
        try {
            while (drag === this.#drag && drag.wanted !== null) {
                const by = drag.wanted;
                drag.wanted = null;
                const answer = await this.#acts.ask(this.#operation(by), asking.signal);
                if (drag === this.#drag) {
                    this.#acts.show(answer.ids, placesOf(answer.positions, drag.geometry.frame));
                    this.#say('');
                }
            }
        } catch (error) {
            if (drag === this.#drag) {
                this.#say(error.message);
            }
        } finally {
            if (this.#asking === asking) {
                this.#asking = null;
            }
        }
    }

    #say(text) {
        this.#elements.said.textContent = text;
    }

    #tellReach() {
        const { radius, reach } = this.#elements;
        const text = Number(radius.value) === ALL ? 'all but the farthest' : `${radius.value} %`;
        reach.textContent = text;
        radius.setAttribute('aria-valuetext', text);
    }
}

// Returns positions of the mesh (three numbers each) in view coordinates.
export function placesOf(positions, { origin, scale }) {
    const places = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i++) {
        places[i] = (positions[i] - origin[i % 3]) * scale;
    }
    return places;
}
