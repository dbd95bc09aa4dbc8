// paint.js - a brush: what the pointer paints over in the view is selected.

import { faceOf, pointAt } from '../geometry/geometry.js';
import { noneOf } from '../geometry/sets.js';
import { emptyMask, inside, stamp } from '../geometry/region.js';
import { topologyOf } from '../geometry/topology.js';
import { distanceToSegment } from '../geometry/view.js';

// While the user paints on a mesh with more triangles than this, only what is visible in the id
// buffer is shown as painted; the rest is found when the stroke ends.
const MOST_AT_ONCE = 60000;

export class Stroke {
    kind;
    how;
    #geometry;
    #view;
    #mask;
    #radius;
    #set; // what was painted over, see sets.js
    #last = null;

    // `view` is {matrix, width, height, shown}: the camera's matrix and what Stage.shownTriangles
    // returns. `isThrough` says that hidden elements count, too. `radius` is in pixels of `view`. `how`
    // is what the stroke does to the selection, see combined() in changes.js.
    constructor(kind, geometry, view, { radius, how, isThrough }) {
        this.how = how;
        [this.kind, this.#geometry, this.#radius] = [kind, geometry, radius];
        this.#view = { ...view, isThrough };
        this.#mask = emptyMask(view.width, view.height);
        this.#set = noneOf(kind, geometry);
    }

    // Paints from the last place to another one, [x, y] in pixels of the view.
    moveTo(place) {
        const { shown } = this.#view;
        const under = new Set();
        stamp(this.#mask, this.#last ?? place, place, this.#radius, (pixel) => {
            under.add(shown[pixel]);
        });
        under.delete(-1);
        if (this.kind === 'face') {
            under.forEach((triangle) => {
                this.#set[faceOf(this.#geometry.triangles, triangle)] = 1;
            });
        } else if (this.kind === 'edge') {
            this.#paintEdges(under, this.#last ?? place, place);
        }
        this.#last = place;
    }

    // Adds the edges of triangles that are within the brush at its last place, at its new place, or
    // halfway between.
    #paintEdges(under, from, to) {
        const { matrix, width, height } = this.#view;
        const { edgeOfSide } = topologyOf(this.#geometry);
        const places = [from, to, from.map((value, i) => (value + to[i]) / 2)];
        for (const triangle of under) {
            for (let side = 0; side < 3; side++) {
                const edge = edgeOfSide[3 * triangle + side];
                const ends = [0, 1].map((i) =>
                    pointAt(this.#geometry, this.#geometry.triangles[4 * triangle + ((side + i) % 3)]),
                );
                const isNear = ([x, y]) =>
                    distanceToSegment(matrix, width, height, ...ends, x, y) <= this.#radius;
                if (edge >= 0 && places.some(isNear)) {
                    this.#set[edge] = 1;
                }
            }
        }
    }

    // Returns what was painted over so far, as a set. `isEnd` says that the stroke has ended.
    read(isEnd) {
        if (isEnd || this.#geometry.triangleCount <= MOST_AT_ONCE) {
            const { matrix, shown, isThrough } = this.#view;
            const found = inside(this.kind, this.#geometry, {
                matrix,
                mask: this.#mask,
                shown: isThrough ? null : shown,
            });
            for (let i = 0; i < found.length; i++) {
                this.#set[i] |= found[i];
            }
        }
        return this.#set;
    }
}

export class Brush {
    #canvas;
    #ring;
    #acts;
    #isArmed = false;
    #stroke = null; // {stroke, pointer}
    #isAsked = false;

    // `ring` is a circle of SVG over the canvas. `acts` are begin(event), which returns a Stroke or
    // null, show(stroke), which is called while the user paints, and end(stroke); radius() returns the brush's radius in CSS pixels.
    constructor(canvas, ring, acts) {
        [this.#canvas, this.#ring, this.#acts] = [canvas, ring, acts];
        // Listens in the capture phase, so that the drag does not turn the camera.
        const listen = (type, act) =>
            canvas.addEventListener(type, (event) => act(event), { capture: true });
        listen('pointerdown', (event) => this.#press(event));
        listen('pointermove', (event) => this.#move(event));
        listen('pointerup', (event) => this.#release(event));
        listen('pointercancel', () => this.#giveUp());
        listen('pointerleave', () => this.#ring.setAttribute('r', 0));
    }

    arm() {
        this.#isArmed = true;
        this.#canvas.focus();
    }

    cancel() {
        this.#isArmed = false;
        this.#giveUp();
    }

    #giveUp() {
        this.#ring.setAttribute('r', 0);
        if (this.#stroke !== null) {
            this.#stroke = null;
            this.#acts.show(null);
        }
    }

    #press(event) {
        if (!this.#isArmed || event.button !== 0) {
            return;
        }
        event.stopImmediatePropagation();
        const stroke = this.#stroke === null ? this.#acts.begin(event) : null;
        if (stroke !== null) {
            this.#stroke = { stroke, pointer: event.pointerId };
            this.#canvas.setPointerCapture(event.pointerId);
            this.#paint(event);
        }
    }

    #move(event) {
        if (!this.#isArmed) {
            return;
        }
        this.#showRing(event);
        if (this.#stroke?.pointer === event.pointerId) {
            event.stopImmediatePropagation();
            this.#paint(event);
        }
    }

    #showRing(event) {
        const [x, y] = this.#placeOf(event);
        this.#ring.setAttribute('cx', x);
        this.#ring.setAttribute('cy', y);
        this.#ring.setAttribute('r', this.#acts.radius());
    }

    #placeOf({ clientX, clientY }) {
        const { left, top } = this.#canvas.getBoundingClientRect();
        return [clientX - left, clientY - top];
    }

    #paint(event) {
        const ratio = this.#canvas.width / this.#canvas.clientWidth;
        this.#stroke.stroke.moveTo(this.#placeOf(event).map((value) => value * ratio));
        if (!this.#isAsked) {
            this.#isAsked = true;
            requestAnimationFrame(() => {
                this.#isAsked = false;
                if (this.#stroke !== null) {
                    this.#acts.show(this.#stroke.stroke);
                }
            });
        }
    }

    #release(event) {
        if (this.#stroke?.pointer !== event.pointerId) {
            return;
        }
        event.stopImmediatePropagation();
        const { stroke } = this.#stroke;
        this.#stroke = null;
        this.#acts.end(stroke);
    }
}
