// surface_look.js - how the mesh is drawn beside its colours: the values that look_shaders.js reads.

import { Color, NoColorSpace, RGBAIntegerFormat, UnsignedIntType, Vector4 } from 'three';

import { ROW } from '../geometry/geometry.js';
import { Rows } from './rows.js';

// The ways of drawing faces and the matcaps, as look_shaders.js numbers them. As points, a mesh has no
// faces.
const WAYS = { solid: 0, xray: 1, wire: 2, points: 0 };
const MATCAPS = { none: 0, clay: 1, metal: 2, pearl: 3 };

const EDGE_STRENGTH = 0.88;

// The look of a mesh that is drawn plainly: {way, isSmooth, matcap, hasEdges, marksBacks}. `way` is
// 'solid', 'xray', 'wire' or 'points', `matcap` one of MATCAPS.
export const PLAIN = {
    way: 'solid',
    isSmooth: false,
    matcap: 'none',
    hasEdges: true,
    marksBacks: false,
};

export class SurfaceLook {
    uniforms = {
        way: { value: 0 },
        matcap: { value: 0 },
        isSmooth: { value: false },
        marksBacks: { value: false },
        edgeStrength: { value: EDGE_STRENGTH },
        normals: { value: emptyRows() },
        cut: { value: new Vector4(0, 0, 0, 0) }, // without numbers, its last part would be 1
        ink: { value: new Color() },
        paper: { value: new Color() },
    };
    isBroken = false; // the programs for other looks do not work
    #look = PLAIN;
    #normals = null; // the array that the texture shows

    get way() {
        return this.isBroken ? 'solid' : this.#look.way;
    }

    // Whether the mesh is drawn by the program without LOOKED.
    get isPlain() {
        const { way, isSmooth, matcap, marksBacks } = this.#look;
        const isLooked = way !== 'solid' || isSmooth || matcap !== 'none' || marksBacks;
        return this.isBroken || !(isLooked || this.isCut);
    }

    get isCut() {
        return this.uniforms.cut.value.lengthSq() > 0;
    }

    set(look) {
        this.#look = look;
        this.uniforms.way.value = WAYS[look.way];
        this.uniforms.matcap.value = MATCAPS[look.matcap];
        this.uniforms.marksBacks.value = look.marksBacks;
        this.uniforms.edgeStrength.value = look.hasEdges ? EDGE_STRENGTH : 0;
        this.#setSmooth();
    }

    // Draws the mesh plainly from now on. Returns false if it was drawn so before.
    giveUp() {
        const wasBroken = this.isBroken;
        this.isBroken = true;
        return !wasBroken;
    }

    // Sets the packed normals of all triangles, see normals.js, or none (null): then the mesh is drawn
    // flat.
    setNormals(normals) {
        const texture = this.uniforms.normals;
        if (normals === null && this.#normals === null) {
            return;
        }
        if (normals !== null && normals.length === this.#normals?.length) {
            // Only what differs is uploaded.
            const places = differences(this.#normals, normals);
            places.forEach((place) => {
                const at = 4 * place;
                this.#normals.set(normals.subarray(at, at + 4), at);
            });
            texture.value = texture.value.update(this.#normals, places);
        } else {
            texture.value.dispose();
            this.#normals = normals;
            texture.value = emptyRows(normals ?? undefined);
        }
        this.#setSmooth();
    }

    // Called when triangles have changed; `places` are their indices, `length` is the length of their
    // array: until there are new normals, the changed triangles are drawn flat.
    update(places, length) {
        if (this.#normals === null) {
            return;
        }
        if (this.#normals.length !== length) {
            const longer = new Uint32Array(length);
            longer.set(this.#normals.subarray(0, length));
            this.#normals = longer;
        }
        places.forEach((place) => this.#normals.fill(0, 4 * place, 4 * place + 4));
        this.uniforms.normals.value = this.uniforms.normals.value.update(this.#normals, places);
    }

    #setSmooth() {
        this.uniforms.isSmooth.value = this.#look.isSmooth && this.#normals !== null;
    }

    // Cuts away what is above a plane {normal, at}, see outline.js, or nothing (null).
    setCut(plane) {
        const [x, y, z] = plane?.normal ?? [0, 0, 0];
        this.uniforms.cut.value.set(x, y, z, plane?.at ?? 0);
    }

    // Sets the colours of lines without a surface and of the background.
    setColors({ ink, paper }) {
        this.uniforms.ink.value.setHex(ink, NoColorSpace);
        this.uniforms.paper.value.setHex(paper, NoColorSpace);
    }

    // Frees the graphics memory.
    dispose() {
        this.uniforms.normals.value.dispose();
    }

    forget() {
        this.uniforms.normals.value.forget();
    }
}

function emptyRows(array = new Uint32Array(4 * ROW)) {
    return new Rows(array, RGBAIntegerFormat, UnsignedIntType);
}

// Returns the indices of the texels in which two arrays differ.
function differences(before, after) {
    const places = [];
    for (let at = 0; at < after.length; at += 4) {
        if (
            before[at] !== after[at] ||
            before[at + 1] !== after[at + 1] ||
            before[at + 2] !== after[at + 2]
        ) {
            places.push(at / 4);
        }
    }
    return places;
}
