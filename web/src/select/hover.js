// hover.js - outlines the element under the pointer, so that the user sees what a click would pick.
// The outline is drawn over the canvas, so that no frame of the mesh is drawn for it.

import { edgesOfTriangles, hasVertex, pointAt, trianglesOfFace } from '../geometry/geometry.js';
import { placeOnScreen } from '../geometry/view.js';

const DOT = 6; // radius of the ring around a vertex, in CSS pixels

// The outline of a face with more edges than this is not drawn.
const MOST_EDGES = 500;

export class Hover {
    #canvas;
    #line;
    #stage;
    #contentNow;
    #isFree;
    #chosen = null; // the element under the pointer, as choose() returns it
    #pointer = null; // place of the pointer in the window; null if it is not over the canvas
    #isAsked = false;

    // `line` is a path of SVG over the canvas. `content()` returns the Content that is shown, or
    // null. `isFree()` returns whether clicks pick elements now.
    constructor(canvas, line, stage, { content, isFree }) {
        [this.#canvas, this.#line, this.#stage] = [canvas, line, stage];
        [this.#contentNow, this.#isFree] = [content, isFree];
        canvas.addEventListener('pointermove', (event) => this.#move(event));
        for (const type of ['pointerdown', 'pointerleave', 'pointercancel']) {
            canvas.addEventListener(type, () => this.#leave());
        }
        stage.eachFrame(() => this.#draw());
    }

    #move({ clientX, clientY, buttons, pointerType }) {
        if (pointerType === 'touch' || buttons !== 0 || !this.#isFree()) {
            this.#leave();
            return;
        }
        this.#pointer = [clientX, clientY];
        if (!this.#isAsked) {
            this.#isAsked = true;
            requestAnimationFrame(() => {
                this.#isAsked = false;
                this.#look();
            });
        }
    }

    #leave() {
        [this.#pointer, this.#chosen] = [null, null];
        this.#draw();
    }

    #look() {
        if (this.#pointer !== null) {
            this.#chosen = this.#stage.hover(...this.#pointer);
            this.#draw();
        }
    }

    // Draws the outline where it is now; an element that the mesh has lost is not drawn.
    #draw() {
        const chosen = this.#chosen;
        const geometry = this.#contentNow()?.geometry;
        const isShown = chosen !== null && geometry !== undefined;
        this.#line.setAttribute('d', isShown ? this.#pathOf(chosen, geometry) : '');
        if (isShown) {
            this.#line.dataset.kind = chosen.kind;
        } else {
            delete this.#line.dataset.kind;
        }
    }

    #pathOf({ kind, id, from, to }, geometry) {
        const { clientWidth: width, clientHeight: height } = this.#canvas;
        const screen = { matrix: this.#stage.matrix, width, height };
        const placeOf = (vertex) => placeOnScreen(screen, pointAt(geometry, vertex));
        if (kind === 'vertex') {
            const place = hasVertex(geometry, id) ? placeOf(id) : null;
            return place === null ? '' : ringAt(place);
        }
        const edges =
            kind === 'face'
                ? edgesOfTriangles(geometry.triangles, trianglesOfFace(geometry, id))
                : [[from, to]];
        return edges
            .slice(0, MOST_EDGES)
            .filter((ends) => ends.every((vertex) => hasVertex(geometry, vertex)))
            .map((ends) => ends.map(placeOf))
            .filter((places) => !places.includes(null))
            .map(([a, b]) => `M${a.join()}L${b.join()}`)
            .join('');
    }
}

function ringAt([x, y]) {
    return `M${x - DOT},${y}a${DOT},${DOT} 0 1 0 ${2 * DOT},0a${DOT},${DOT} 0 1 0 ${-2 * DOT},0`;
}
