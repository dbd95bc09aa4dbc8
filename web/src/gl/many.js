// many.js - draws a selection of many elements, a Crowd. marks.js draws the selection of few.

import {
    BufferAttribute,
    BufferGeometry,
    Color,
    LineBasicMaterial,
    LineSegments,
    Mesh,
    NoColorSpace,
    Vector3,
} from 'three';

import { COLORS } from './colors.js';
import { RAISED, dots } from './marks.js';
import { eachTriangle, membersOf } from '../geometry/sets.js';

const POINT_SIZE = 9; // in CSS pixels

export class Many {
    // The objects of three.js by which the selection is drawn.
    faces;
    lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    points;

    // `material` is the material with which three.js draws selected triangles, `uniforms` are those of
    // the look.
    constructor(material, { cut, ink, paper }) {
        this.points = dots(new Vector3(), { cut, ink, paper });
        this.setColors(COLORS.dark);
        this.faces = new Mesh(new BufferGeometry(), material);
        this.show(null, null);
    }

    // Sets the colours, see colors.js.
    setColors({ chosen }) {
        this.lines.material.color.set(chosen);
        this.points.material.uniforms.tint.value.setFromColor(new Color().setHex(chosen, NoColorSpace));
    }

    // Hides what is above a plane, a Plane of three.js, or nothing (null).
    setCut(plane) {
        this.lines.material.clippingPlanes = plane === null ? null : [plane];
    }

    // Shows a Crowd of elements of the mesh with the arrays `geometry`, or nothing (null).
    show(crowd, geometry) {
        for (const object of [this.faces, this.lines, this.points]) {
            object.visible = false;
            object.geometry.dispose();
            object.geometry = new BufferGeometry();
        }
        if (crowd?.kind === 'face') {
            const corners = cornersOf(crowd.flags, geometry);
            this.#put(this.faces, (made) => made.setIndex(new BufferAttribute(corners, 1)));
        } else if (crowd !== null) {
            const ids = crowd.pairs ?? membersOf(crowd.flags);
            const places = new Float32Array(3 * ids.length);
            for (let i = 0; i < ids.length; i++) {
                for (let axis = 0; axis < 3; axis++) {
                    places[3 * i + axis] = geometry.vertices[4 * ids[i] + axis];
                }
            }
            const object = crowd.kind === 'edge' ? this.lines : this.points;
            this.#put(object, (made) => made.setAttribute('position', new BufferAttribute(places, 3)));
        }
    }

    #put(object, fill) {
        fill(object.geometry);
        object.visible = true;
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.points.material.uniforms.size.value = POINT_SIZE * ratio;
    }

    // Scales lines towards the camera at `position`, so that the surface does not hide them.
    raise(position) {
        this.lines.scale.setScalar(RAISED);
        this.lines.position.copy(position).multiplyScalar(1 - RAISED);
    }
}

// Returns the indices of the corners of all triangles of some faces, as surface.js counts corners.
function cornersOf(flags, geometry) {
    let count = 0;
    eachTriangle(geometry, (_, face) => {
        count += flags[face] ?? 0;
    });
    const corners = new Uint32Array(3 * count);
    let at = 0;
    eachTriangle(geometry, (i, face) => {
        if (flags[face] === 1) {
            corners[at++] = 3 * i;
            corners[at++] = 3 * i + 1;
            corners[at++] = 3 * i + 2;
        }
    });
    return corners;
}
