// tints.js - draws elements of the mesh once more in other colours, over the surface: what changed,
// and what other clients have selected.

import {
    BufferAttribute,
    BufferGeometry,
    DoubleSide,
    Group,
    Mesh,
    MeshBasicMaterial,
    Points,
    PointsMaterial,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

const FILL_OPACITY = 0.5;
const LINE_WIDTH = 3; // in CSS pixels, as all sizes here
const DOT_SIZE = 12;

export class Tints {
    // The object of three.js by which all tints are drawn.
    group = new Group();
    #named = new Map(); // by name: the group of its objects
    #ratio = 1;
    #planes = null; // what hides tints: a list of one Plane of three.js, or null

    // Draws the shapes in the list `shapes` under a name, in place of those drawn under it before.
    // Each is {color, triangles, lines, dots}: three numbers for each point, see changed.js.
    set(name, shapes) {
        this.#remove(name);
        const objects = shapes.flatMap((shape) => this.#objectsOf(shape));
        if (objects.length > 0) {
            const group = new Group();
            group.add(...objects);
            this.#named.set(name, group);
            this.group.add(group);
        }
    }

    // Hides what is above a plane, a Plane of three.js, or nothing (null).
    setCut(plane) {
        this.#planes = plane === null ? null : [plane];
        this.group.traverse(({ material }) => {
            if (material !== undefined) {
                material.clippingPlanes = this.#planes;
            }
        });
    }

    clear() {
        [...this.#named.keys()].forEach((name) => this.#remove(name));
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.#ratio = ratio;
        this.group.traverse(({ material }) => {
            if (material?.isPointsMaterial) {
                material.size = DOT_SIZE * ratio;
            }
        });
    }

    #remove(name) {
        const group = this.#named.get(name);
        if (group !== undefined) {
            group.traverse((object) => {
                object.geometry?.dispose();
                object.material?.dispose();
            });
            this.group.remove(group);
            this.#named.delete(name);
        }
    }

    #objectsOf({ color, triangles = [], lines = [], dots = [] }) {
        const objects = [];
        if (triangles.length > 0) {
            objects.push(new Mesh(pointsOf(triangles), fillOf(color)));
        }
        if (lines.length > 0) {
            const geometry = new LineSegmentsGeometry().setPositions(lines);
            const look = { color, linewidth: LINE_WIDTH, depthWrite: false };
            objects.push(new LineSegments2(geometry, new LineMaterial(look)));
        }
        if (dots.length > 0) {
            const look = { color, size: DOT_SIZE * this.#ratio, sizeAttenuation: false };
            objects.push(new Points(pointsOf(dots), new PointsMaterial(look)));
        }
        objects.forEach((object) => {
            object.frustumCulled = false;
            object.material.clippingPlanes = this.#planes;
            object.renderOrder = 1000; // after the surface and its marks
        });
        return objects;
    }
}

function pointsOf(coordinates) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(coordinates), 3));
    return geometry;
}

// The material of tinted faces. Surfaces are drawn a little farther away than they are (surface.js),
// so these are in front of them.
function fillOf(color) {
    return new MeshBasicMaterial({
        color,
        side: DoubleSide,
        transparent: true,
        opacity: FILL_OPACITY,
        depthWrite: false,
    });
}
