// rulers.js - draws lines and points that measure the mesh, over everything else.

import {
    AlwaysDepth,
    BufferAttribute,
    BufferGeometry,
    Color,
    GLSL3,
    NoBlending,
    NoColorSpace,
    Points,
    RawShaderMaterial,
    Vector3,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import { COLORS } from './colors.js';
import { DOT_FRAGMENT, MARK_VERTEX } from './shaders.js';

const WIDTH = 2.5; // in CSS pixels, as all sizes here
const POINT = 9;

export class Rulers {
    objects; // of three.js
    #lines;
    #points;

    constructor() {
        const material = new LineMaterial({
            linewidth: WIDTH,
            depthFunc: AlwaysDepth,
            depthWrite: false,
            transparent: true,
        });
        this.#lines = new LineSegments2(new LineSegmentsGeometry(), material);
        this.#points = new Points(
            new BufferGeometry(),
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: MARK_VERTEX,
                fragmentShader: DOT_FRAGMENT,
                uniforms: { size: { value: POINT }, tint: { value: new Vector3() } },
                blending: NoBlending,
                depthFunc: AlwaysDepth,
                depthWrite: false,
            }),
        );
        this.objects = [this.#lines, this.#points];
        this.setColors(COLORS.dark);
        this.show([], []);
    }

    // Sets the colours, see colors.js.
    setColors({ ruler }) {
        this.#lines.material.color.set(ruler);
        this.#points.material.uniforms.tint.value.setFromColor(
            new Color().setHex(ruler, NoColorSpace),
        );
    }

    // Draws lines, whose end points come in pairs, and points; all are [x, y, z] in view coordinates.
    show(lines, points) {
        this.#lines.geometry.dispose();
        this.#lines.geometry = new LineSegmentsGeometry();
        if (lines.length > 0) {
            this.#lines.geometry.setPositions(lines.flat());
        }
        this.#lines.visible = lines.length > 0;
        this.#points.geometry.dispose();
        this.#points.geometry = new BufferGeometry();
        const places = new BufferAttribute(new Float32Array(points.flat()), 3);
        this.#points.geometry.setAttribute('position', places);
        this.#points.visible = points.length > 0;
    }

    // Sets the number of screen pixels per CSS pixel.
    setScreen(ratio) {
        this.#points.material.uniforms.size.value = POINT * ratio;
    }
}
