// lasso.js - a lasso that the user draws in the view: a drag of the pointer makes a polygon.

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

    // `note` is an element that is shown until the lasso is drawn; it contains the button `giveUp`.
    // `line` is an element of SVG, a polygon over the canvas. `onDraw(corners)` is called when the
    // lasso is drawn: `corners` are points [x, y] from -1 to 1, with y upward, as in clip
    // coordinates.
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

    // Waits for the user to draw.
    arm() {
        this.#isArmed = true;
        this.#elements.note.hidden = false;
        this.#canvas.focus();
    }

    cancel() {
        [this.#isArmed, this.#points, this.#pointer] = [false, null, null];
        this.#elements.note.hidden = true;
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
        this.cancel();
        // A click without a drag draws nothing.
        if (corners.length >= 3) {
            this.#acts.onDraw(corners);
        }
    }

    #add({ clientX, clientY }) {
        const { left, top } = this.#canvas.getBoundingClientRect();
        const point = [clientX - left, clientY - top];
        const last = this.#points.at(-1);
        if (last !== undefined && Math.hypot(point[0] - last[0], point[1] - last[1]) < STEP) {
            return;
        }
        this.#points.push(point);
        if (this.#points.length > MOST_CORNERS) {
            this.#points = this.#points.filter((_, i) => i % 2 === 0);
        }
        const text = this.#points.map((corner) => corner.join()).join(' ');
        this.#elements.line.setAttribute('points', text);
    }
}
