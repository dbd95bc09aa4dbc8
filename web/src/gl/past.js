// past.js - draws an earlier revision of the mesh over a part of the picture: from the left edge up
// to a divider, as if a curtain were drawn over the present mesh.

import { Scene } from 'three';

import { Surface } from './surface.js';
import { Tints } from './tints.js';

export class Past {
    tints = new Tints();
    // Which part of the picture's width shows the earlier revision, 0 to 1.
    part = 1;
    #mostRows;
    #surface = null; // made when it is first needed, because it takes graphics memory
    #scene = new Scene();
    #ratio = 1;

    // `mostRows` is the maximum height of a texture in texels.
    constructor(mostRows) {
        this.#mostRows = mostRows;
        this.#scene.add(this.tints.group);
    }

    get isShown() {
        return this.#surface !== null;
    }

    // Shows the arrays `geometry` of an earlier revision, or nothing (null). `placement` says where
    // its points are in the view coordinates of the present mesh, see placementOf() in changed.js.
    show(geometry, placement) {
        this.#drop();
        if (geometry === null) {
            return;
        }
        const surface = new Surface(this.#mostRows);
        surface.show(geometry);
        surface.setPixelRatio(this.#ratio);
        for (const object of [surface.fill, surface.dots]) {
            object.frustumCulled = false;
            this.#scene.add(object);
        }
        this.#surface = surface;
        this.#scene.scale.setScalar(placement.scale);
        this.#scene.position.set(...placement.offset);
    }

    #drop() {
        this.tints.clear();
        if (this.#surface !== null) {
            this.#scene.remove(this.#surface.fill, this.#surface.dots);
            this.#surface.dispose();
            this.#surface = null;
        }
    }

    // Called when the contents of the graphics memory are lost.
    forget() {
        this.#surface?.forget();
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.#ratio = ratio;
        this.#surface?.setPixelRatio(ratio);
        this.tints.setPixelRatio(ratio);
    }

    // Draws both scenes beside each other: the earlier revision in its part of the picture, and the
    // scene `present` in the rest. `size` is [width, height] of the picture in CSS pixels.
    render(renderer, present, camera, [width, height]) {
        const at = Math.round(width * this.part);
        renderer.setScissorTest(true);
        renderer.setScissor(0, 0, at, height);
        renderer.render(this.#scene, camera);
        renderer.setScissor(at, 0, width - at, height);
        renderer.render(present, camera);
        renderer.setScissorTest(false);
    }
}
