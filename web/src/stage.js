// stage.js - the view: the renderer, or none without WebGL, and what a click on it does.

import { NoWebGL, Renderer } from './gl/render.js';
import { REACH, choose } from './pick.js';

// A pointer that moved further than this between down and up was orbiting.
const CLICK_PIXELS = 4;

// Milliseconds after the last move until the camera is at rest: browsers limit how often the
// address may change.
const REST = 250;

export class Stage {
    #canvas;
    #modes;
    #geometryNow;
    #renderer = null;
    #isLevel = false; // a level of detail is shown, which has no ids
    #acts;
    #timer = 0;

    // `noWebGL` and `contextLost` are messages, `modes` contains the radio buttons for the kind of
    // element to pick. `geometry()` returns the arrays that are shown, or null. `onPick(chosen,
    // also)` is called with the result of choose() for a click, `also` with Shift; `onRest()` when
    // the camera has come to rest.
    constructor(canvas, { noWebGL, contextLost, modes }, { geometry, onPick, onRest, onError }) {
        this.#canvas = canvas;
        this.#modes = modes;
        this.#geometryNow = geometry;
        this.#acts = { onPick, onRest, onError };
        try {
            this.#renderer = new Renderer(canvas, {
                onFrame: (label) => this.#markFrame(label),
                onLost: (lost) => {
                    contextLost.hidden = !lost;
                },
                onMove: (isHeld) => this.#moved(isHeld),
            });
        } catch (error) {
            noWebGL.hidden = false;
            if (!(error instanceof NoWebGL)) {
                onError(error);
            }
        }
        modes.addEventListener('change', () => this.setPickMode(this.#pickMode));
        this.#listenToClicks();
    }

    // Whether there is a renderer.
    get isThere() {
        return this.#renderer !== null;
    }

    // --- what is shown ---

    // Shows new arrays. `label` marks the next frame: {mesh, revision, selection, materials}, for a
    // level {mesh, revision, faces}.
    show(geometry, label) {
        this.#isLevel = false;
        this.#draw(label, () => this.#renderer?.show(geometry, label));
    }

    // Called when the arrays were changed, see applyDelta(): draws the change.
    update(change, label) {
        this.#draw(label, () => this.#renderer?.update(change, label));
    }

    // Shows a level of detail until the mesh is shown again. Nothing can be picked or marked in it.
    // Throws a RangeError, and goes on showing what it did, if it is too large.
    showLevel(geometry, label) {
        this.#renderer.show(geometry, label);
        this.#isLevel = true;
    }

    // Shows another level, see Levels.
    refine(ranges, label) {
        this.#renderer.refine(ranges, label);
    }

    #draw(label, act) {
        try {
            act();
        } catch (error) {
            this.#renderer.show(null, label);
            this.#acts.onError(error);
        }
    }

    // Marks the canvas with what the frame shows, so that tests can wait for it.
    #markFrame(label) {
        for (const name of ['mesh', 'revision', 'selection', 'materials', 'faces']) {
            if (label?.[name] === undefined) {
                delete this.#canvas.dataset[name];
            } else {
                this.#canvas.dataset[name] = label[name];
            }
        }
    }

    // The target of marks: null if there is nothing to mark. See Renderer for the marks.
    get #marked() {
        return this.#isLevel ? null : this.#renderer;
    }

    select(marks, arrows, label) {
        this.#marked?.select(marks, arrows, label);
    }

    markField(marks) {
        this.#marked?.markField(marks);
    }

    setBoundary(ends) {
        this.#marked?.setBoundary(ends);
    }

    preview(lines) {
        this.#marked?.preview(lines);
    }

    // Sets the materials of faces, see materials.js.
    showMaterials(materials, label) {
        this.#renderer?.showMaterials(materials, label);
    }

    updateMaterials(materials, change, label) {
        this.#renderer?.updateMaterials(materials, change, label);
    }

    // Shows or hides the colours of materials.
    colorFaces(isColored) {
        this.#renderer?.colorFaces(isColored);
    }

    capture() {
        return this.#renderer.capture();
    }

    // --- the camera ---

    fit() {
        this.#renderer?.fit();
    }

    // Shows the result of framing(), or the whole mesh (null).
    frame(found) {
        if (found === null) {
            this.#renderer?.fit();
        } else {
            this.#renderer?.frame(found);
        }
    }

    zoom(nearer) {
        this.#renderer?.zoom(nearer);
    }

    // Called when the camera moves. The canvas has `data-moving` until the listener was called.
    #moved(isHeld) {
        this.#canvas.dataset.moving = '';
        clearTimeout(this.#timer);
        if (!isHeld) {
            this.#timer = setTimeout(() => {
                this.#acts.onRest();
                delete this.#canvas.dataset.moving;
            }, REST);
        }
    }

    // Returns position and axes of the camera, see Renderer.view.
    get view() {
        return this.#renderer.view;
    }

    // Position and target of the camera, six numbers; undefined without a renderer.
    get camera() {
        return this.#renderer?.camera;
    }

    set camera(numbers) {
        if (this.#renderer !== null) {
            this.#renderer.camera = numbers;
        }
    }

    // --- clicks ---

    // Scrolls to the view if the page is longer than the window.
    bringIntoSight() {
        this.#canvas.scrollIntoView({ block: 'nearest' });
    }

    get #pickMode() {
        return this.#modes.querySelector('input:checked').value;
    }

    // Sets the kind of elements to pick.
    setPickMode(mode) {
        this.#modes.querySelector(`input[value="${mode}"]`).checked = true;
        this.#renderer?.showVertices(mode === 'vertex');
    }

    #listenToClicks() {
        let down = null;
        this.#canvas.addEventListener('pointerdown', (event) => {
            down = event.isPrimary && event.button === 0 ? event : null;
        });
        this.#canvas.addEventListener('pointerup', (event) => {
            const { clientX: x, clientY: y } = event;
            const isClick =
                down !== null && Math.hypot(x - down.clientX, y - down.clientY) <= CLICK_PIXELS;
            if (isClick && this.#marked !== null && this.#geometryNow() !== null) {
                this.#acts.onPick(this.#choose(x, y), event.shiftKey);
            }
        });
    }

    // Returns the element at a place in the window.
    #choose(clientX, clientY) {
        const box = this.#canvas.getBoundingClientRect();
        const [x, y] = [clientX - box.left, clientY - box.top];
        const { matrix } = this.#renderer;
        const seen = this.#renderer.look(x, y, REACH);
        const screen = { matrix, width: box.width, height: box.height, x, y };
        return choose(this.#pickMode, this.#geometryNow(), seen, screen);
    }
}
