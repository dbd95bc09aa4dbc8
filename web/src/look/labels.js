// labels.js - what is written into the view: the sizes of the bounding box, the step of the grid, and a
// cross of axes in the corner. The panel says the same for screen readers.

import { make } from '../kit/dom.js';
import { placeOnScreen } from '../geometry/view.js';

const NAMES = ['x', 'y', 'z'];
const LENGTH = 26; // of the axes in the corner, in units of its viewBox

// Elements of SVG have another namespace.
function draw(tag, attributes) {
    const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
    Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    return element;
}

export class Labels {
    #elements;
    #sizes = []; // the labels of the box: {span, edges}, see edgesAlong()
    #cross;

    // `box` is an element over the canvas, `grid` one for the step of the grid, `cross` an element of
    // SVG.
    constructor({ box, grid, cross }) {
        this.#elements = { box, grid, cross };
        this.#cross = NAMES.map((name) => {
            const line = draw('line', { class: name, x1: 0, y1: 0 });
            const text = draw('text', { class: name });
            text.textContent = name.toUpperCase();
            cross.append(line, text);
            return { line, text };
        });
    }

    // Shows labels: `sizes` are {axis, text, edges} of the box, none if it is not shown; `grid` is a
    // text or ''.
    show({ sizes, grid, hasCross }) {
        this.#sizes.forEach(({ span }) => span.remove());
        this.#sizes = sizes.map(({ axis, text, edges }) => ({
            span: make('span', { className: `size ${NAMES[axis]}` }, text),
            edges,
        }));
        this.#elements.box.append(...this.#sizes.map(({ span }) => span));
        this.#elements.grid.textContent = grid;
        this.#elements.grid.hidden = grid === '';
        this.#elements.cross.toggleAttribute('hidden', !hasCross);
    }

    // Moves the labels to their places in the frame that was drawn. `screen` is {matrix, width,
    // height}, `view` is Camera.view.
    place(screen, view) {
        if (this.#sizes.length > 0) {
            this.#placeSizes(screen);
        }
        if (!this.#elements.cross.hasAttribute('hidden')) {
            this.#placeCross(view);
        }
    }

    // A size stands at that of the four edges in its direction which is lowest on the screen, or, for
    // upright edges, at the one farthest to the left.
    #placeSizes(screen) {
        for (const { span, edges } of this.#sizes) {
            const places = edges
                .map((ends) => ends.map((end) => placeOnScreen(screen, end)))
                .filter((ends) => !ends.includes(null))
                .map(([from, to]) => ({
                    x: (from[0] + to[0]) / 2,
                    y: (from[1] + to[1]) / 2,
                    isUpright: Math.abs(to[1] - from[1]) > 2 * Math.abs(to[0] - from[0]),
                }));
            const score = ({ x, y, isUpright }) => (isUpright ? -x : y);
            const best = places.sort((a, b) => score(b) - score(a))[0];
            span.hidden = best === undefined;
            if (best !== undefined) {
                const { x, y, isUpright } = best;
                span.classList.toggle('left', isUpright);
                const least = isUpright ? span.offsetWidth + 10 : span.offsetWidth / 2;
                span.style.left = `${Math.min(Math.max(x, least), screen.width - 30)}px`;
                span.style.top = `${Math.min(Math.max(y, 12), screen.height - 12)}px`;
            }
        }
    }

    #placeCross({ right, up, back }) {
        const order = [0, 1, 2].sort((a, b) => back[a] - back[b]); // farthest first
        for (const axis of order) {
            const [x, y] = [LENGTH * right[axis], -LENGTH * up[axis]];
            const { line, text } = this.#cross[axis];
            line.setAttribute('x2', x);
            line.setAttribute('y2', y);
            text.setAttribute('x', 1.32 * x);
            text.setAttribute('y', 1.32 * y);
        }
        this.#elements.cross.append(
            ...order.flatMap((axis) => [this.#cross[axis].line, this.#cross[axis].text]),
        );
    }
}
