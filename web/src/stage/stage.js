// stage.js - the 3D view: the renderer, which is missing if the browser has no WebGL, and clicks.

import { NoWebGL, Renderer } from '../gl/render.js';
import { HOLE_REACH, REACH, choose } from '../geometry/pick.js';
import { distanceToPoint, placeOnScreen } from '../geometry/view.js';

// If the pointer moved further than this many CSS pixels between press and release, it turned the
// camera; otherwise it clicked.
const CLICK_PIXELS = 4;

// The camera is at rest if it has not moved for this many milliseconds. Only then the page's
// address is updated, because browsers limit how often it may change.
const REST = 250;

export class Stage {
    #canvas;
    #modes;
    #contentNow;
    #renderer = null;
    #isLevel = false; // a level of detail is shown, which has no ids
    #isPast = false; // an earlier revision is shown, in which nothing can be picked
    #acts;
    #timer = 0;
    #followers = [];

    // `noWebGL` and `contextLost` are elements with messages, `modes` contains the radio buttons
    // for the kind of element to pick. `content()` returns the Content that is shown, or null.
    // `onPick(chosen, also, place)` is called after a click with the result of choose(); `also` says
    // that the Shift key was held, `place` is [x, y] in the window; `onLine(event)` after a click with
    // the Alt key. `onMode(kind)` is called when clicks begin to pick elements of another kind.
    // `onRest()` is called when the camera has come to rest, `onFrame()` after each frame; `onSlow()`
    // and `onBroken()` are explained in Renderer.
    constructor(canvas, { noWebGL, contextLost, modes }, { content, ...acts }) {
        this.#canvas = canvas;
        this.#modes = modes;
        this.#contentNow = content;
        this.#acts = acts;
        try {
            this.#renderer = new Renderer(canvas, {
                onFrame: (label) => this.#markFrame(label),
                onLost: (lost) => {
                    contextLost.hidden = !lost;
                },
                onMove: (isHeld) => this.#moved(isHeld),
                onSlow: acts.onSlow,
                onBroken: acts.onBroken,
            });
        } catch (error) {
            noWebGL.hidden = false;
            if (!(error instanceof NoWebGL)) {
                acts.onError(error);
            }
        }
        modes.addEventListener('change', () => this.setPickMode(this.pickMode));
        this.#listenToClicks();
    }

    // Whether there is a renderer, so that the mesh is drawn.
    get isThere() {
        return this.#renderer !== null;
    }

    // --- what is shown ---

    // Shows the mesh in the arrays `geometry`. `label` says what the next frame shows: {mesh,
    // revision, selection, materials}, or {mesh, revision, faces} for a level of detail.
    show(geometry, label) {
        this.#isLevel = false;
        this.#draw(label, () => this.#renderer?.show(geometry, label));
    }

    // Called when the arrays were changed; the arguments are as in applyDelta(). Draws the changed
    // mesh.
    update(change, label) {
        this.#draw(label, () => this.#renderer?.update(change, label));
    }

    // Shows a level of detail until the mesh is shown again. Nothing can be picked or marked in the
    // level. Throws a RangeError if it is too large; then the mesh that was shown before stays
    // visible.
    showLevel(geometry, label) {
        this.#renderer.show(geometry, label);
        this.#isLevel = true;
    }

    // Shows another level of detail, whose arrays have changed within `ranges`, see Levels.
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

    // Writes what the frame shows into data attributes of the canvas, so that tests can wait for a
    // certain frame.
    #markFrame(label) {
        this.#followers.forEach((follow) => follow());
        for (const name of ['mesh', 'revision', 'selection', 'materials', 'faces', 'colour', 'past']) {
            if (label?.[name] === undefined) {
                delete this.#canvas.dataset[name];
            } else {
                this.#canvas.dataset[name] = label[name];
            }
        }
        this.#acts.onFrame();
    }

    // The renderer, whose functions set the look; null if the browser has no WebGL.
    get renderer() {
        return this.#renderer;
    }

    // The renderer if the mesh is drawn and marks can be drawn on it, or null. Renderer has the
    // functions that draw the marks.
    get #marked() {
        return this.#isLevel ? null : this.#renderer;
    }

    select(marks, arrows, label) {
        this.#marked?.select(marks, arrows, label);
    }

    // Shows a selection of many elements, a Crowd, or none (null).
    selectMany(crowd) {
        this.#marked?.selectMany(crowd);
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

    // Shows the vertices `ids` at other places (three view coordinates each) until the mesh changes or
    // the next call; null shows them where they are.
    bend(ids, places) {
        this.#marked?.bend(ids, places);
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

    // Colours the faces by values, see Renderer.color(). Levels of detail have no values.
    color(act, label) {
        this.#marked?.color(act, label);
    }

    // Draws lines and points over everything, see Rulers.show().
    rule(lines, points) {
        this.#renderer?.rule(lines, points);
    }

    // Draws some shapes in other colours over the mesh, see Renderer.tint().
    tint(name, shapes) {
        this.#renderer?.tint(name, shapes);
    }

    // Shows an earlier revision over the present one, or none (null), see Renderer.showPast().
    // Meanwhile nothing can be picked. Throws a RangeError if it is too large.
    showPast(geometry, placement, tints, label) {
        this.#renderer?.showPast(geometry, placement, tints, label);
        this.#isPast = geometry !== null;
    }

    // Shows the earlier revision in this part of the picture's width, 0 to 1.
    wipe(part) {
        this.#renderer?.wipe(part);
    }

    capture() {
        return this.#renderer.capture();
    }

    // --- the camera ---

    fit() {
        this.#renderer?.fit();
    }

    // Moves the camera so that it sees the ball that framing() returned or, if it is null, the
    // whole mesh.
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

    // Called when the camera has moved. The canvas has the attribute `data-moving` from the first
    // move until onRest() was called.
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

    // The matrix that maps view coordinates to clip coordinates, column-major; undefined without a
    // renderer.
    get matrix() {
        return this.#renderer?.matrix;
    }

    // The size of the canvas in CSS pixels, {width, height}.
    get size() {
        return { width: this.#canvas.clientWidth, height: this.#canvas.clientHeight };
    }

    // Position of the camera and of the point that it looks at, six numbers; undefined without a
    // renderer.
    get camera() {
        return this.#renderer?.camera;
    }

    set camera(numbers) {
        if (this.#renderer !== null) {
            this.#renderer.camera = numbers;
        }
    }

    // --- clicks ---

    // Calls `follow()` after each frame, when the camera may have moved.
    eachFrame(follow) {
        this.#followers.push(follow);
    }

    // Scrolls the page so that the view is visible or, with 'start', so that it is at the top of the
    // window.
    bringIntoSight(block = 'nearest') {
        this.#canvas.scrollIntoView({ block });
    }

    // The kind of elements that clicks pick.
    get pickMode() {
        return this.#modes.querySelector('input:checked').value;
    }

    // Sets the kind of elements that clicks pick.
    setPickMode(mode) {
        this.#modes.querySelector(`input[value="${mode}"]`).checked = true;
        this.#renderer?.showVertices(mode === 'vertex');
        this.#acts.onMode(mode);
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
            if (isClick && !this.#isPast && this.#marked !== null && this.#contentNow() !== null) {
                if (event.altKey) {
                    this.#acts.onLine(event);
                } else {
                    this.#acts.onPick(this.elementAt(x, y), event.shiftKey, [x, y]);
                }
            }
        });
    }

    // Returns the element under the pointer at a place in the window, see choose(), or null. It is
    // found in a kept image, so it is for pointers that move.
    hover(clientX, clientY) {
        return this.elementAt(clientX, clientY, this.pickMode, true);
    }

    // Returns the edge that is nearest to a place in the window, {from, to}, or null.
    edgeAt(clientX, clientY) {
        return this.elementAt(clientX, clientY, 'edge');
    }

    // Returns which triangle is visible in each pixel of the canvas: {width, height, shown}, see
    // region.js; null if the mesh is not drawn.
    get shownTriangles() {
        return this.#isPast ? null : (this.#marked?.shownTriangles ?? null);
    }

    // Returns the element of a kind at a place in the window, see choose(), or null. If `isKept` is
    // true, it is found in a kept image, which is for pointers that move.
    elementAt(clientX, clientY, kind = this.pickMode, isKept = false) {
        const content = this.#contentNow();
        if (this.#isPast || this.#marked === null || content === null) {
            return null;
        }
        const screen = this.#screenAt(clientX, clientY);
        const { geometry, boundary } = content;
        const reach = kind === 'halfedge' ? HOLE_REACH : REACH;
        const seen = this.#renderer.look(screen.x, screen.y, reach, isKept);
        const look = (...place) => this.#renderer.look(...place, REACH, isKept);
        return choose(kind, geometry, seen, { ...screen, boundary, look });
    }

    // Returns the camera's matrix, the size of the canvas, and a place in the window as a place on the
    // canvas: {matrix, width, height, x, y}.
    #screenAt(clientX, clientY) {
        const box = this.#canvas.getBoundingClientRect();
        const [x, y] = [clientX - box.left, clientY - box.top];
        return { matrix: this.#renderer.matrix, width: box.width, height: box.height, x, y };
    }

    // Returns the ray that leads through a place in the window, {origin, direction} in view
    // coordinates.
    rayAt(clientX, clientY) {
        const { width, height, x, y } = this.#screenAt(clientX, clientY);
        return this.#renderer.rayAt((2 * x) / width - 1, 1 - (2 * y) / height);
    }

    // Returns how many CSS pixels a point in view coordinates is from a place in the window.
    pixelsFrom(point, clientX, clientY) {
        const { matrix, width, height, x, y } = this.#screenAt(clientX, clientY);
        return distanceToPoint(matrix, width, height, point, x, y);
    }

    // Returns the place on the canvas, in CSS pixels, at which a point in view coordinates appears;
    // null if it is behind the camera, or if nothing is drawn.
    placeOf(point) {
        return this.#renderer === null ? null : placeOnScreen(this.#screenAt(0, 0), point);
    }
}
