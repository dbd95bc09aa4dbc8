// ids.js - the id buffer: an image in which each pixel has the kind and the id of the element that is
// visible there, see pick.js. The image of the whole canvas is kept until the camera or the mesh
// changes, so that the element under a moving pointer is found without drawing the mesh again.

import { NearestFilter, RGBAIntegerFormat, UnsignedIntType, WebGLRenderTarget } from 'three';

import { readSquare } from '../geometry/pick.js';

const TRIANGLE = 1; // kind of triangles in the image, see shaders.js

export class Ids {
    #renderer;
    #scene;
    #camera;
    #background;
    #whole = null; // render target of the whole canvas
    #isFresh = false;

    // `scene` draws ids instead of colours. `camera` is a Camera, `background()` returns the
    // colour to which the renderer's background is set back.
    constructor(renderer, scene, camera, background) {
        [this.#renderer, this.#scene, this.#camera] = [renderer, scene, camera];
        this.#background = background;
    }

    // Called when the camera, the mesh or the size of the canvas has changed.
    forget() {
        this.#isFresh = false;
    }

    get #size() {
        const { width, height } = this.#renderer.domElement;
        return [width, height];
    }

    // Returns which triangles and vertices are visible within `reach` CSS pixels of a place on the
    // canvas, in the form of readSquare() in pick.js. If `isKept` is true, the image of the whole
    // canvas is drawn if it is outdated; otherwise only the part around the place.
    look(x, y, reach, isKept) {
        const ratio = this.#renderer.getPixelRatio();
        const radius = Math.ceil(reach * ratio);
        const size = 2 * radius + 1;
        const left = Math.floor(x * ratio) - radius;
        const top = Math.floor(y * ratio) - radius;
        if (isKept && !this.#isFresh) {
            this.#drawWhole();
        }
        const ids = this.#isFresh ? this.#read(left, top, size) : this.#drawPart(left, top, size);
        return readSquare(ids, size);
    }

    // Reads a square of the kept image. Pixels outside of the canvas are zero.
    #read(left, top, size) {
        const [width, height] = this.#size;
        const [x0, y0] = [Math.max(left, 0), Math.max(top, 0)];
        const [x1, y1] = [Math.min(left + size, width), Math.min(top + size, height)];
        const ids = new Uint32Array(4 * size * size);
        if (x0 >= x1 || y0 >= y1) {
            return ids;
        }
        const [w, h] = [x1 - x0, y1 - y0];
        const part = new Uint32Array(4 * w * h);
        this.#renderer.readRenderTargetPixels(this.#whole, x0, height - y1, w, h, part);
        for (let row = 0; row < h; row++) {
            // Rows are read from the bottom to the top.
            const y = y0 + h - 1 - row - top;
            ids.set(part.subarray(4 * w * row, 4 * w * (row + 1)), 4 * (y * size + x0 - left));
        }
        return ids;
    }

    #drawWhole() {
        const [width, height] = this.#size;
        if (this.#whole === null || this.#whole.width !== width || this.#whole.height !== height) {
            this.#whole?.dispose();
            this.#whole = targetOf(width, height);
        }
        this.#draw(this.#whole);
        this.#isFresh = true;
    }

    #drawPart(left, top, size) {
        const target = targetOf(size, size);
        const camera = this.#camera.three;
        camera.setViewOffset(...this.#size, left, top, size, size);
        this.#draw(target);
        camera.clearViewOffset();
        const ids = new Uint32Array(4 * size * size);
        this.#renderer.readRenderTargetPixels(target, 0, 0, size, size, ids);
        target.dispose();
        return ids;
    }

    #draw(target) {
        this.#camera.setDepthRange(0);
        this.#renderer.setRenderTarget(target);
        this.#renderer.setClearColor(0x000000, 0);
        this.#renderer.render(this.#scene, this.#camera.three);
        this.#renderer.setRenderTarget(null);
        this.#renderer.setClearColor(this.#background(), 1);
    }

    // Returns which triangle is visible in each pixel of the canvas, or -1: {width, height, shown},
    // row by row from the top. The object of three.js `dots` is left out.
    triangles(dots) {
        const [width, height] = this.#size;
        const target = targetOf(width, height);
        const { visible } = dots;
        dots.visible = false;
        this.#draw(target);
        dots.visible = visible;
        const ids = new Uint32Array(4 * width * height);
        this.#renderer.readRenderTargetPixels(target, 0, 0, width, height, ids);
        target.dispose();
        const shown = new Int32Array(width * height).fill(-1);
        for (let y = 0; y < height; y++) {
            const row = (height - 1 - y) * width;
            for (let x = 0; x < width; x++) {
                const at = 4 * (row + x);
                if (ids[at] === TRIANGLE) {
                    shown[y * width + x] = ids[at + 1];
                }
            }
        }
        return { width, height, shown };
    }
}

function targetOf(width, height) {
    return new WebGLRenderTarget(width, height, {
        format: RGBAIntegerFormat,
        type: UnsignedIntType,
        minFilter: NearestFilter,
        magFilter: NearestFilter,
    });
}
