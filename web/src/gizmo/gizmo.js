// gizmo.js - moves, rotates and scales the selection, or the whole mesh if nothing is selected, by
// handles in the view or by numbers. A drag shows a preview; releasing the pointer runs one edit.

import { SELECTION } from '../kit/controls.js';
import { compose } from '../kit/affine.js';
import { byId, enable, formatNumberOf } from '../kit/dom.js';
import { edgesAt } from '../edit/gesture.js';
import { pointAt } from '../geometry/geometry.js';
import { allOf, membersOf } from '../geometry/sets.js';
import { drawHandles, makeHandles } from './handles.js';
import { NOTHING, pull } from './pull.js';
import { handlesAt } from './shape.js';

// The number of digits with which a drag moves, rotates and scales.
const DIGITS = 6;

// Coordinates of the fixed point are rounded to this fraction of the size of the mesh, which is about
// the precision of the arrays that are drawn.
const ROUNDED = 1e-6;

// In a narrow window the numbers would cover the handles, so they are shown when the user wants them.
const NARROW = '(max-width: 860px)';

const KINDS = ['move', 'rotate', 'scale'];

export class Gizmo {
    #canvas;
    #session;
    #stage;
    #acts;
    #svg = byId('gizmo');
    #handles;
    #fields; // 'move' -> its three inputs, and so on
    #isOn = false;
    #isEnabled = false;
    #held = null; // what the gizmo moves: {vertices, pairs, place, operand}; null if nothing
    #drag = null; // {handle, from, pointer}

    // `onArm()` is called when the gizmo is shown, `onRun(operation)` runs an edit and returns a
    // promise.
    constructor(canvas, session, stage, { onArm, onRun, onError }) {
        [this.#canvas, this.#session, this.#stage] = [canvas, session, stage];
        this.#acts = { onArm, onRun, onError };
        this.#handles = makeHandles(this.#svg);
        this.#fields = Object.fromEntries(
            KINDS.map((kind) => [kind, [...byId(`gizmo-${kind}`).querySelectorAll('input')]]),
        );
        for (const { handle, node } of this.#handles.all) {
            node.addEventListener('pointerdown', (event) => this.#press(event, handle));
        }
        this.#svg.addEventListener('pointermove', (event) => this.#move(event));
        this.#svg.addEventListener('pointerup', (event) => this.#release(event));
        this.#svg.addEventListener('pointercancel', () => this.cancelDrag());
        const form = byId('gizmo-form');
        form.addEventListener('input', () => this.#preview(this.#typed));
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            this.#apply(this.#typed);
        });
        form.addEventListener('keydown', (event) => {
            if (event.key === 'Escape') {
                this.hide();
                canvas.focus();
            }
        });
        window.addEventListener('keydown', (event) => {
            if (event.key === 'Escape' && this.#drag !== null) {
                event.stopImmediatePropagation();
                this.cancelDrag();
            }
        }, { capture: true });
        byId('gizmo-close').addEventListener('click', () => this.hide());
        byId('direct-gizmo').addEventListener('click', () => this.toggle());
        stage.eachFrame(() => this.#draw());
    }

    get isOn() {
        return this.#isOn;
    }

    toggle() {
        if (this.#isOn) {
            this.hide();
        } else if (this.#isEnabled && this.#stage.isThere) {
            this.#acts.onArm();
            this.#isOn = true;
            byId('gizmo-numbers').open = !window.matchMedia(NARROW).matches;
            this.#show();
            this.#canvas.focus();
        }
    }

    hide() {
        if (this.#isOn) {
            this.cancelDrag();
            this.#isOn = false;
            this.#show();
        }
    }

    setEnabled(isEnabled) {
        this.#isEnabled = isEnabled;
        enable(byId('direct-gizmo'), isEnabled && this.#stage.isThere);
        enable(byId('gizmo-apply'), isEnabled);
    }

    // Called when the session has changed; `what` is as in the constructor of Session.
    follow(what) {
        if (this.#isOn && ['mesh', 'content', 'change', 'selection'].includes(what)) {
            this.cancelDrag();
            this.#show();
        }
    }

    #show() {
        byId('gizmo-note').hidden = !this.#isOn;
        byId('direct-gizmo').setAttribute('aria-pressed', `${this.#isOn}`);
        this.#held = this.#isOn ? this.#whatIsHeld() : null;
        const count = this.#held?.vertices.length ?? 0;
        byId('gizmo-what').textContent =
            this.#session.selection.count === 0
                ? 'The whole mesh'
                : formatNumberOf(count, 'vertex', 'vertices');
        this.#fill(NOTHING);
        this.#draw();
    }

    // Returns what the gizmo moves, or null if there is nothing.
    #whatIsHeld() {
        const { selection, shown } = this.#session;
        const geometry = shown?.geometry;
        if (geometry === undefined) {
            return null;
        }
        const { chosen, asCrowd: crowd } = selection;
        let vertices;
        let operand = SELECTION;
        if (selection.count === 0) {
            vertices = [...membersOf(allOf('vertex', geometry))];
            operand = undefined;
        } else if (crowd === null) {
            vertices = [...new Set(chosen.flatMap(({ element }) => [element.origin, element.target]))];
            operand = vertices;
        } else {
            vertices = crowd.verticesIn(geometry);
        }
        const place = middleOf(vertices, geometry);
        return place === null ? null : { vertices, operand, place, pairs: edgesAt(geometry, vertices) };
    }

    get #view() {
        return { ...this.#stage.view, width: this.#canvas.clientWidth };
    }

    #draw() {
        const handles = this.#held && handlesAt(this.#held.place, this.#view, {
            matrix: this.#stage.matrix,
            width: this.#canvas.clientWidth,
            height: this.#canvas.clientHeight,
        });
        drawHandles(this.#svg, this.#handles, handles);
    }

    // --- drags ---

    #press(event, handle) {
        if (event.button !== 0 || this.#drag !== null || !this.#isEnabled) {
            return;
        }
        event.preventDefault();
        this.#svg.setPointerCapture(event.pointerId);
        this.#drag = { handle, from: this.#placeOf(event), pointer: event.pointerId };
        this.#svg.dataset.held = `${handle.kind}${handle.axis ?? ''}`;
    }

    #placeOf({ clientX, clientY }) {
        const { left, top } = this.#canvas.getBoundingClientRect();
        return [clientX - left, clientY - top];
    }

    // Returns the change that the drag makes up to a place of the pointer, in units of the mesh.
    #changeAt(event) {
        const { handle, from } = this.#drag;
        const { scale } = this.#session.shown.geometry.frame;
        const change = pull(handle, {
            place: this.#held.place,
            from,
            to: this.#placeOf(event),
            view: this.#view,
            isSnapped: event.ctrlKey || event.metaKey,
        });
        const rounded = (value) => Number(value.toPrecision(DIGITS));
        return {
            move: change.move.map((value) => rounded(value / scale)),
            rotate: change.rotate.map(rounded),
            scale: change.scale.map(rounded),
        };
    }

    #move(event) {
        if (this.#drag?.pointer === event.pointerId) {
            const change = this.#changeAt(event);
            this.#fill(change);
            this.#preview(change);
        }
    }

    #release(event) {
        if (this.#drag?.pointer === event.pointerId) {
            const change = this.#changeAt(event);
            this.cancelDrag();
            this.#apply(change);
        }
    }

    // Ends a drag without an edit.
    cancelDrag() {
        if (this.#drag !== null) {
            this.#drag = null;
            delete this.#svg.dataset.held;
        }
        this.#fill(NOTHING);
        this.#stage.preview(null);
    }

    // --- numbers ---

    #fill(change) {
        for (const [kind, inputs] of Object.entries(this.#fields)) {
            inputs.forEach((input, axis) => {
                const value = change[kind][axis];
                input.value = value === NOTHING[kind][axis] ? '' : `${value}`;
            });
        }
    }

    // The change that the fields say; an empty field changes nothing.
    get #typed() {
        return Object.fromEntries(
            KINDS.map((kind) => [
                kind,
                this.#fields[kind].map((input, axis) =>
                    input.value === '' ? NOTHING[kind][axis] : Number(input.value),
                ),
            ]),
        );
    }

    // --- what a change does ---

    // Returns the matrix of a change, in coordinates of the mesh.
    #matrixOf({ move, rotate, scale }) {
        const { frame } = this.#session.shown.geometry;
        const step = 10 ** Math.floor(Math.log10(ROUNDED / frame.scale));
        const about = this.#held.place.map((value, axis) => {
            const exact = frame.origin[axis] + value / frame.scale;
            return Number((Math.round(exact / step) * step).toPrecision(15));
        });
        return compose({ scale, rotate, translate: move, about });
    }

    // Draws the edges of the selection where a change puts them.
    #preview(change) {
        if (this.#held === null || isNothing(change)) {
            this.#stage.preview(null);
            return;
        }
        const { geometry } = this.#session.shown;
        const { frame } = geometry;
        const matrix = this.#matrixOf(change);
        const moved = new Uint8Array(geometry.vertexCount);
        this.#held.vertices.forEach((id) => {
            moved[id] = 1;
        });
        const placeOf = (id) => {
            const place = pointAt(geometry, id);
            if (moved[id] === 0) {
                return place;
            }
            const [x, y, z] = place.map((value, axis) => frame.origin[axis] + value / frame.scale);
            return [0, 4, 8].map((row, axis) => {
                const [a, b, c, d] = matrix.slice(row, row + 4);
                return (a * x + b * y + c * z + d - frame.origin[axis]) * frame.scale;
            });
        };
        this.#stage.preview(this.#held.pairs.flat().flatMap(placeOf));
    }

    #apply(change) {
        if (this.#held === null || isNothing(change)) {
            return;
        }
        const operation = { op: 'transform', matrix: this.#matrixOf(change) };
        if (this.#held.operand !== undefined) {
            operation.vertices = this.#held.operand;
        }
        this.#stage.preview(null);
        this.#acts.onRun(operation).catch(this.#acts.onError);
    }
}

function isNothing(change) {
    return KINDS.every((kind) => change[kind].every((value, axis) => value === NOTHING[kind][axis]));
}

// Returns the middle of the bounding box of some vertices, or null if there are none.
function middleOf(ids, { vertices }) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const id of ids) {
        for (let axis = 0; axis < 3; axis++) {
            low[axis] = Math.min(low[axis], vertices[4 * id + axis]);
            high[axis] = Math.max(high[axis], vertices[4 * id + axis]);
        }
    }
    return ids.length === 0 ? null : low.map((value, axis) => (value + high[axis]) / 2);
}
