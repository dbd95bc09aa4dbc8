// guides.js - lines beside the mesh that help to judge its place and its size: grid, axes and bounding
// box.

import { BufferAttribute, BufferGeometry, Color, LineBasicMaterial, LineSegments } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

const AXIS_WIDTH = 2; // in CSS pixels
const BOX_WIDTH = 1.25;

export class Guides {
    // The objects of three.js, to be drawn before the surface.
    grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    axes = wide(AXIS_WIDTH, true);
    box = wide(BOX_WIDTH, false);
    // The distance from the origin of view coordinates to the farthest point of a line.
    reach = 0;
    #lines = { grid: [], axes: [], box: [] };
    #colors = null;

    // Shows lines, each [from, to] in view coordinates; `axes` are three lines or none.
    show(lines) {
        this.#lines = lines;
        const points = Object.values(lines).flat(2);
        this.reach = Math.max(0, ...points.map((point) => Math.hypot(...point)));
        this.#fill();
    }

    setColors(colors) {
        this.#colors = colors;
        this.grid.material.color.setHex(colors.grid);
        this.box.material.color.setHex(colors.box);
        this.#fill();
    }

    #fill() {
        const { grid, axes, box } = this.#lines;
        this.grid.geometry.dispose();
        this.grid.geometry = new BufferGeometry();
        const positions = new BufferAttribute(new Float32Array(grid.flat(2)), 3);
        this.grid.geometry.setAttribute('position', positions);
        this.grid.visible = grid.length > 0;
        replace(this.box, box);
        replace(this.axes, axes);
        if (axes.length > 0) {
            const colors = this.#colors.axes.map((hex) => new Color(hex).toArray());
            this.axes.geometry.setColors(colors.flatMap((color) => [...color, ...color]));
        }
    }
}

function wide(linewidth, vertexColors) {
    return new LineSegments2(
        new LineSegmentsGeometry(),
        new LineMaterial({ linewidth, vertexColors }),
    );
}

function replace(object, lines) {
    object.geometry.dispose();
    object.geometry = new LineSegmentsGeometry();
    object.visible = lines.length > 0;
    if (object.visible) {
        object.geometry.setPositions(lines.flat(2));
    }
}
