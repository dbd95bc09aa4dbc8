// drawing.js - draws a step (see steps.js) as SVG: faces, vertices, half-edges as arrows, and the
// links that the step changes. What moves from one step to the next is seen to move.

import { HEIGHT, WIDTH, arrowsOf, loopsOf, projection } from './layout.js';

const SVG = 'http://www.w3.org/2000/svg';

// Milliseconds in which the drawing goes from one step to the next.
const DURATION = 450;

function draw(tag, attributes, text = '') {
    const element = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) {
        element.setAttribute(name, value);
    }
    element.textContent = text;
    return element;
}

export class Drawing {
    #svg;
    #place;
    #shown = null; // what the drawing shows now, see pictureOf()
    #frame = 0;
    #isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;

    // `states` are all states that are to be shown, so that the drawing has one scale.
    constructor(states) {
        this.#place = projection(states);
        this.#svg = draw('svg', {
            class: 'lesson-drawing',
            viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
            role: 'img',
        });
    }

    get node() {
        return this.#svg;
    }

    // Shows a step, moving from what is shown now.
    show(step) {
        const to = pictureOf(step, this.#place);
        this.#svg.setAttribute('aria-label', `${step.title}: ${to.vertices.size} vertices, ${to.arrows.size} half-edges`);
        const from = this.#shown;
        cancelAnimationFrame(this.#frame);
        if (from === null || this.#isStill) {
            this.#draw(to, step);
            return;
        }
        const start = performance.now();
        const go = (now) => {
            const part = Math.min(1, Math.max(0, (now - start) / DURATION));
            const eased = part * part * (3 - 2 * part);
            this.#draw(between(from, to, eased), step);
            if (part < 1) {
                this.#frame = requestAnimationFrame(go);
            }
        };
        this.#frame = requestAnimationFrame(go);
    }

    stop() {
        cancelAnimationFrame(this.#frame);
    }

    #draw(picture, { focus, links }) {
        this.#shown = picture;
        const isFocus = (kind, id) => focus.some((one) => one.kind === kind && one.id === id);
        const nodes = [];
        for (const [face, corners] of picture.faces) {
            const points = corners.map((at) => at.join(',')).join(' ');
            nodes.push(draw('polygon', { points, class: isFocus('face', face) ? 'face focus' : 'face' }));
        }
        for (const [id, [from, to]] of picture.arrows) {
            const isChosen = isFocus('halfedge', id) || isFocus('edge', id >> 1);
            const kind = [
                isChosen ? 'focus' : '',
                picture.boundary.has(id) ? 'boundary' : '',
                picture.loose.has(id) ? 'loose' : '',
            ].join(' ');
            nodes.push(draw('path', { d: arrowPath(from, to), class: `halfedge ${kind}` }));
            nodes.push(label(from, to, id, kind));
        }
        for (const { halfedge, from, to } of links) {
            nodes.push(...this.#link(picture, halfedge, from, 'was'));
            nodes.push(...this.#link(picture, halfedge, to, 'is'));
        }
        for (const [id, [x, y]] of picture.vertices) {
            const kind = isFocus('vertex', id) ? 'focus' : '';
            nodes.push(draw('circle', { cx: x, cy: y, r: 9, class: `vertex ${kind}` }));
            nodes.push(draw('text', { x, y: y + 3.5, class: `vertex-id ${kind}` }, `${id}`));
        }
        for (const [face, corners] of picture.faces) {
            const [x, y] = middleOf(corners);
            nodes.push(draw('text', { x, y, class: 'face-id' }, `face ${face}`));
        }
        this.#svg.replaceChildren(...nodes);
    }

    // Returns the curve of a link from the head of one half-edge to the tail of another.
    #link(picture, halfedge, other, kind) {
        const [a, b] = [picture.arrows.get(halfedge), picture.arrows.get(other)];
        if (a === undefined || b === undefined) {
            return [];
        }
        const [, head] = a;
        const [tail] = b;
        const bend = [0, 1].map((i) => (head[i] + tail[i]) / 2 + (a[1][i] - a[0][i]) * 0.25);
        return [
            draw('path', { d: `M${head.join(' ')} Q${bend.join(' ')} ${tail.join(' ')}`, class: `link ${kind}` }),
            draw('circle', { cx: tail[0], cy: tail[1], r: 3.5, class: `link-end ${kind}` }),
        ];
    }
}

// Returns what a drawing of a step shows: {vertices, arrows, faces, boundary, loose}, maps from ids to
// points, and the sets of half-edges at a boundary and of those that are not linked yet.
function pictureOf({ state }, place) {
    const vertices = new Map([...state.vertices].map(([id, position]) => [id, place(position)]));
    const faces = new Map(
        [...loopsOf(state)].map(([face, loop]) => [
            face,
            loop.map((id) => vertices.get(state.halfedges.get(id).origin)),
        ]),
    );
    const boundary = new Set(
        [...state.halfedges].filter(([, { face, next }]) => face === null && next !== null).map(([id]) => id),
    );
    const loose = new Set([...state.halfedges].filter(([, { next }]) => next === null).map(([id]) => id));
    return { vertices, arrows: arrowsOf(state, place), faces, boundary, loose };
}

// Returns a picture between two others; what only the second one has is where it will be.
function between(from, to, part) {
    const mix = (a, b) => b.map((value, i) => a[i] + (value - a[i]) * part);
    const vertices = new Map(
        [...to.vertices].map(([id, at]) => [id, mix(from.vertices.get(id) ?? at, at)]),
    );
    const arrows = new Map(
        [...to.arrows].map(([id, ends]) => {
            const was = from.arrows.get(id) ?? ends;
            return [id, ends.map((end, i) => mix(was[i], end))];
        }),
    );
    const faces = new Map(
        [...to.faces].map(([face, corners]) => {
            const was = from.faces.get(face);
            const isSame = was !== undefined && was.length === corners.length;
            return [face, isSame ? corners.map((corner, i) => mix(was[i], corner)) : corners];
        }),
    );
    return { ...to, vertices, arrows, faces };
}

// Returns the path of an arrow with half a head, as half-edges are usually drawn.
function arrowPath(from, to) {
    const along = [to[0] - from[0], to[1] - from[1]];
    const length = Math.hypot(...along) || 1;
    const size = Math.min(11, length / 2);
    const [x, y] = along.map((value) => (value / length) * size);
    const barb = [to[0] - x + y * 0.5, to[1] - y - x * 0.5];
    return `M${from.join(' ')} L${to.join(' ')} L${barb.join(' ')}`;
}

function label(from, to, id, kind) {
    const along = [to[0] - from[0], to[1] - from[1]];
    const length = Math.hypot(...along) || 1;
    const at = [0, 1].map((i) => from[i] + along[i] * 0.42);
    const x = at[0] + (along[1] / length) * 10;
    const y = at[1] - (along[0] / length) * 10 + 3.5;
    return draw('text', { x, y, class: `halfedge-id ${kind}` }, `${id}`);
}

function middleOf(points) {
    return [0, 1].map((i) => points.reduce((sum, at) => sum + at[i], 0) / points.length);
}
