// render.js - draws: the surface of the mesh and what lies on it, as the camera sees them. Only
// this folder knows WebGL and three.
//
//   surface.js   the mesh, from the arrays of geometry.js
//   marks.js     what lies on it: what is selected, arrows, boundary loops, previews
//   camera.js    where it is seen from
//
// Nothing is drawn until something changed. After each frame `onFrame` gets what it shows, so that
// a test can wait for a frame instead of for a time.

import {
    NearestFilter,
    RGBAIntegerFormat,
    Scene,
    UnsignedIntType,
    WebGLRenderTarget,
    WebGLRenderer,
} from 'three';

import { ballOf } from '../geometry.js';
import { readSquare } from '../pick.js';
import { DIRECTION } from '../view.js';
import { Camera } from './camera.js';
import { Marks } from './marks.js';
import { Surface } from './surface.js';

const BACKGROUND = 0x0e1116;

export class NoWebGL extends Error {}

export class Renderer {
    #canvas;
    #renderer;
    #camera;
    #surface;
    #marks;
    #scene = new Scene();
    #pickScene = new Scene();
    #geometry = null;
    #label = null;
    #size = '';
    #scheduled = false;
    #onFrame;

    // Throws NoWebGL. `onFrame(label)` is called after each frame with what show() was given, and
    // `onLost(lost)` when the graphics context goes and comes back, `onMove(isHeld)` as Camera
    // says.
    constructor(canvas, { onFrame, onLost, onMove }) {
        const context = canvas.getContext('webgl2', { antialias: true, alpha: false });
        if (context === null) {
            throw new NoWebGL();
        }
        this.#canvas = canvas;
        this.#onFrame = onFrame;
        this.#renderer = new WebGLRenderer({ canvas, context });
        this.#renderer.setClearColor(BACKGROUND);
        this.#camera = new Camera(canvas, (isHeld) => {
            this.#draw();
            onMove(isHeld);
        });
        this.#surface = new Surface(this.#renderer.capabilities.maxTextureSize);
        this.#marks = new Marks(this.#surface.material(true));
        const { fill, dots, pickFill, pickDots } = this.#surface;
        const { chosen, boundary, arrows, hiddenLines, lines, vertices } = this.#marks;
        const { fieldLines, fieldVertices, preview } = this.#marks;
        add(this.#pickScene, [pickFill, pickDots]);
        add(this.#scene, [
            fill,
            chosen,
            boundary,
            dots,
            arrows,
            hiddenLines,
            lines,
            vertices,
            fieldLines,
            fieldVertices,
            preview,
        ]);
        this.show(null, null);
        this.fit();
        canvas.addEventListener('webglcontextlost', () => {
            this.#surface.forget();
            onLost(true);
        });
        canvas.addEventListener('webglcontextrestored', () => {
            onLost(false);
            this.#draw();
        });
        new ResizeObserver(() => this.#resize()).observe(canvas);
    }

    // Show a mesh, or nothing (null). `label` is what onFrame will say is shown. Throws a
    // RangeError, and shows what it did before, when the mesh is larger than a texture can be.
    show(geometry, label) {
        this.#surface.show(geometry);
        this.#geometry = geometry;
        this.#marks.reset(geometry);
        this.#label = label;
        this.#draw();
    }

    // The arrays of the mesh that is shown were changed, see applyDelta(): only what changed goes
    // to the graphics memory. Boundary and selection stay as they were. Throws as show() does.
    update(places, label) {
        if (this.#geometry !== null) {
            this.#surface.update(places);
        }
        this.#label = label;
        this.#draw();
    }

    // The arrays were changed within ranges, and how much of them is shown, see Levels.
    refine(ranges, label) {
        this.#surface.refine(ranges);
        this.#label = label;
        this.#draw();
    }

    // What faces look like, see Surface.showMaterials().
    showMaterials(materials, label) {
        this.#surface.showMaterials(materials);
        this.#label = label;
        this.#draw();
    }

    // See Surface.updateMaterials().
    updateMaterials(materials, change, label) {
        this.#surface.updateMaterials(materials, change);
        this.#label = label;
        this.#draw();
    }

    // Whether faces have the colours of their materials.
    colorFaces(isColored) {
        this.#surface.isColored = isColored;
        this.#draw();
    }

    // Mark elements: {kind: 'face', id}, {kind: 'edge' or 'halfedge', from, to} or
    // {kind: 'vertex', id}, and draw half-edges as arrows, see around.js. Replaces what was marked
    // before.
    select(marks, halfedges, label) {
        this.#label = label;
        this.#marks.select(marks, halfedges);
        this.#draw();
    }

    // Mark the elements in the fields of a form, as select() has them.
    markField(marks) {
        this.#marks.setField(this.#geometry === null ? [] : marks);
        this.#draw();
    }

    // Lines over everything, of what is about to be done: coordinates of ends in pairs, or null.
    preview(coordinates) {
        this.#marks.setPreview(coordinates);
        this.#draw();
    }

    // Draw the edges of boundary loops, see Marks.setBoundary().
    setBoundary(ends) {
        this.#marks.setBoundary(ends);
        this.#draw();
    }

    // All vertices as dots, or only the isolated ones, which nothing else shows.
    showVertices(all) {
        this.#surface.showVertices(all);
        this.#draw();
    }

    // --- the camera ---

    // Put the camera where the whole mesh is seen from the usual side.
    fit() {
        const { center, radius } = ballOf(this.#geometry ?? { vertices: [] });
        this.#move(() => this.#camera.look(center, DIRECTION, radius));
    }

    // Put the camera where some elements are seen, see Camera.frame().
    frame(found) {
        this.#move(() => this.#camera.frame(found));
    }

    // Nearer (true) or further by a step.
    zoom(nearer) {
        this.#move(() => this.#camera.zoom(nearer));
    }

    #move(act) {
        // Panels that came or went with the mesh have changed the canvas already.
        this.#resize();
        act();
    }

    // See Camera.view.
    get view() {
        return this.#camera.view;
    }

    // Where the camera stands and what it looks at: six numbers.
    get camera() {
        return this.#camera.numbers;
    }

    set camera(numbers) {
        this.#move(() => {
            this.#camera.numbers = numbers;
        });
    }

    // See Camera.matrix.
    get matrix() {
        return this.#camera.matrix;
    }

    // --- frames ---

    // What is on the screen, as a Blob of image/png.
    capture() {
        this.#render();
        return new Promise((resolve) => this.#canvas.toBlob(resolve, 'image/png'));
    }

    // What is visible within `reach` of a place on the canvas, as readSquare() of pick.js says;
    // vertices are those shown as dots.
    look(x, y, reach) {
        const ratio = this.#renderer.getPixelRatio();
        const radius = Math.ceil(reach * ratio);
        const size = 2 * radius + 1;
        const [width, height] = [this.#canvas.width, this.#canvas.height];
        const target = new WebGLRenderTarget(size, size, {
            format: RGBAIntegerFormat,
            type: UnsignedIntType,
            minFilter: NearestFilter,
            magFilter: NearestFilter,
        });
        const left = Math.floor(x * ratio) - radius;
        const top = Math.floor(y * ratio) - radius;
        const camera = this.#camera.three;
        this.#camera.setDepthRange();
        camera.setViewOffset(width, height, left, top, size, size);
        this.#renderer.setRenderTarget(target);
        this.#renderer.setClearColor(0x000000, 0);
        this.#renderer.render(this.#pickScene, camera);
        const ids = new Uint32Array(4 * size * size);
        this.#renderer.readRenderTargetPixels(target, 0, 0, size, size, ids);
        this.#renderer.setRenderTarget(null);
        this.#renderer.setClearColor(BACKGROUND, 1);
        camera.clearViewOffset();
        target.dispose();
        return readSquare(ids, size);
    }

    #resize() {
        const width = Math.max(this.#canvas.clientWidth, 1);
        const height = Math.max(this.#canvas.clientHeight, 1);
        const ratio = window.devicePixelRatio;
        const size = `${width} ${height} ${ratio}`;
        if (size === this.#size) {
            return; // a frame of a large mesh is dear
        }
        this.#size = size;
        this.#renderer.setPixelRatio(ratio);
        this.#renderer.setSize(width, height, false);
        this.#camera.setAspect(width / height);
        this.#surface.setPixelRatio(ratio);
        this.#marks.setScreen(ratio, height);
        this.#draw();
    }

    #draw() {
        if (this.#scheduled) {
            return;
        }
        this.#scheduled = true;
        requestAnimationFrame(() => {
            this.#scheduled = false;
            this.#render();
            this.#onFrame(this.#label);
        });
    }

    #render() {
        this.#camera.setDepthRange();
        this.#marks.raise(this.#camera.three.position);
        this.#renderer.render(this.#scene, this.#camera.three);
    }
}

// Bounds are not known to three, which sees no positions.
function add(scene, objects) {
    objects.forEach((object, order) => {
        object.frustumCulled = false;
        object.renderOrder = order;
        scene.add(object);
    });
}
