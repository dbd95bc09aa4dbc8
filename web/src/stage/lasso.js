// lasso.js - a lasso or a box that the user draws in the view: a drag of the pointer makes a polygon.

// A corner is added when the pointer is this many CSS pixels from the last one.
const STEP = 3;

// If a lasso has more corners than this, every second one is left out.
const MOST_CORNERS = 1000;

export class Lasso {
    #canvas;
    #elements;
    #acts;
    #points = null; // corners in CSS pixels; null while no drag goes on
    #pointer = null;
    #isArmed = false;
    #isBox = false;
    #isKept = false;

    // `note` is an element that is shown until the lasso is drawn; it contains the button `giveUp`.
    // `line` is an element of SVG, a polygon over the canvas. `onDraw(corners, event)` is called when
    // the lasso is drawn: `corners` are points [x, y] from -1 to 1, with y upward, as in clip
    // coordinates, and `event` is the one that ended the drag.
    constructor(canvas, { note, giveUp, line }, { onDraw }) {
        this.#canvas = canvas;
        this.#elements = { note, line };
        this.#acts = { onDraw };
        giveUp.addEventListener('click', () => this.cancel());
        // Listens in the capture phase, so that the drag does not turn the camera.
        const listen = (type, act) =>
            canvas.addEventListener(type, (event) => act(event), { capture: true });
        listen('pointerdown', (event) => this.#press(event));
        listen('pointermove', (event) => this.#move(event));
        listen('pointerup', (event) => this.#release(event));
        listen('pointercancel', () => this.#points !== null && this.cancel());
    }

    get isArmed() {
        return this.#isArmed;
    }

    // Waits for the user to draw. If `isBox` is true, the drag makes a rectangle; if `isKept` is true,
    // the user may draw again afterwards.
    arm({ isBox = false, isKept = false } = {}) {
        [this.#isArmed, this.#isBox, this.#isKept] = [true, isBox, isKept];
        this.#elements.note.hidden = false;
        this.#canvas.focus();
    }

    cancel() {
        this.#isArmed = false;
        this.#elements.note.hidden = true;
        this.#forget();
    }

    // Forgets what was drawn.
    #forget() {
        [this.#points, this.#pointer] = [null, null];
        this.#elements.line.setAttribute('points', '');
    }

    #press(event) {
        if (!this.#isArmed || event.button !== 0) {
            return;
        }
        event.stopImmediatePropagation();
        if (this.#points === null) {
            this.#points = [];
            this.#pointer = event.pointerId;
            this.#canvas.setPointerCapture(event.pointerId);
            this.#add(event);
        }
    }

    #move(event) {
        if (this.#points !== null && event.pointerId === this.#pointer) {
            event.stopImmediatePropagation();
            this.#add(event);
        }
    }

    #release(event) {
        if (this.#points === null || event.pointerId !== this.#pointer) {
            return;
        }
        event.stopImmediatePropagation();
        const { width, height } = this.#canvas.getBoundingClientRect();
        const corners = this.#points.map(([x, y]) => [
            (2 * x) / width - 1,
            1 - (2 * y) / height,
        ]);
        if (this.#isKept) {
            this.#forget();
        } else {
            this.cancel();
        }
        // A click without a drag draws nothing.
        if (corners.length >= 3) {
            this.#acts.onDraw(corners, event);
        }
    }

    #add({ clientX, clientY }) {
        const { left, top } = this.#canvas.getBoundingClientRect();
        const point = [clientX - left, clientY - top];
        const last = this.#points.at(-1);
        if (this.#isBox && last !== undefined) {
            const [first] = this.#points;
            const isDrawn = Math.hypot(point[0] - first[0], point[1] - first[1]) >= STEP;
            this.#show(isDrawn ? [first, [point[0], first[1]], point, [first[0], point[1]]] : [first]);
            return;
        }
        if (last !== undefined && Math.hypot(point[0] - last[0], point[1] - last[1]) < STEP) {
            return;
        }
        this.#points.push(point);
        if (this.#points.length > MOST_CORNERS) {
            this.#points = this.#points.filter((_, i) => i % 2 === 0);
        }
        this.#show(this.#points);
    }

    #show(points) {
        this.#points = points;
        const text = points.map((corner) => corner.join()).join(' ');
        this.#elements.line.setAttribute('points', text);
    }
}
