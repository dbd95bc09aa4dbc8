// stage.js - the view: the renderer, or none where there is no WebGL, and what a click on it means.

import { NoWebGL, Renderer } from './gl/render.js';
import { REACH, choose } from './pick.js';

// A pointer that moved further than this between down and up was orbiting.
const CLICK_PIXELS = 4;

// The camera is at rest so many milliseconds after its last move: browsers refuse an address that
// changes often.
const REST = 250;

export class Stage {
    #canvas;
    #modes;
    #geometryNow;
    #renderer = null;
    #isLevel = false; // a level of detail is shown, which has no ids
    #acts;
    #timer = 0;

    // `noWebGL` and `contextLost` are shown when that is so, `modes` holds the radio buttons of
    // what a click picks. `geometry()` gives the arrays that are shown, or null. `onPick(chosen,
    // also)` gets what choose() made of a click, `also` with Shift; `onRest()` when the camera has
    // been moved and is at rest.
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

    // Is anything drawn at all?
    get isThere() {
        return this.#renderer !== null;
    }

    // --- what is shown ---

    // New arrays; `label` is what the next frame is marked with: {mesh, revision, selection, materials}, of a
    // level {mesh, revision, faces}.
    show(geometry, label) {
        this.#isLevel = false;
        this.#draw(label, () => this.#renderer?.show(geometry, label));
    }

    // The arrays that are shown were changed, see applyDelta().
    update(change, label) {
        this.#draw(label, () => this.#renderer?.update(change, label));
    }

    // A level of detail in place of the mesh, until that is shown again. Nothing is picked in it or
    // marked. Throws a RangeError where it is too large, and shows what it did before.
    showLevel(geometry, label) {
        this.#renderer.show(geometry, label);
        this.#isLevel = true;
    }

    // Another level, see Levels.
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

    // What the frame on the screen shows, for whoever waits for it.
    #markFrame(label) {
        for (const name of ['mesh', 'revision', 'selection', 'materials', 'faces']) {
            if (label?.[name] === undefined) {
                delete this.#canvas.dataset[name];
            } else {
                this.#canvas.dataset[name] = label[name];
            }
        }
    }

    // What marks are on: null where there is nothing to mark. See Renderer for the marks.
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

    // What faces look like, see materials.js.
    showMaterials(materials, label) {
        this.#renderer?.showMaterials(materials, label);
    }

    updateMaterials(materials, change, label) {
        this.#renderer?.updateMaterials(materials, change, label);
    }

    // Whether faces have the colours of their materials.
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

    // What framing() says, or the whole mesh (null).
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

    // `data-moving` is there until whoever wants to know of it has been told.
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

    // See Renderer.view.
    get view() {
        return this.#renderer.view;
    }

    // Six numbers, undefined where nothing is drawn.
    get camera() {
        return this.#renderer?.camera;
    }

    set camera(numbers) {
        if (this.#renderer !== null) {
            this.#renderer.camera = numbers;
        }
    }

    // --- clicks ---

    // Where the page is longer than the window.
    bringIntoSight() {
        this.#canvas.scrollIntoView({ block: 'nearest' });
    }

    get #pickMode() {
        return this.#modes.querySelector('input:checked').value;
    }

    // The kind of elements that are picked.
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

    // What is at a place in the window.
    #choose(clientX, clientY) {
        const box = this.#canvas.getBoundingClientRect();
        const [x, y] = [clientX - box.left, clientY - box.top];
        const { matrix } = this.#renderer;
        const seen = this.#renderer.look(x, y, REACH);
        const screen = { matrix, width: box.width, height: box.height, x, y };
        return choose(this.#pickMode, this.#geometryNow(), seen, screen);
    }
}
