// cut.js - the face that a section plane cuts, and its outline.
//
// outline.js returns triangles of which an odd number cover each place of the cut. They are drawn
// twice: first each one inverts the stencil of its pixels, then those pixels whose stencil is odd are
// painted. So polygons with holes need not be divided into triangles, and the cost depends only on
// the length of the outline.

import {
    AlwaysStencilFunc,
    BufferAttribute,
    BufferGeometry,
    DoubleSide,
    GLSL3,
    InvertStencilOp,
    LessEqualDepth,
    Mesh,
    NoBlending,
    NotEqualStencilFunc,
    RawShaderMaterial,
    Vector3,
    ZeroStencilOp,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import { CAP, CAP_LINE } from './colors.js';

const WIDTH = 2; // of the outline, in CSS pixels
const RAISED = 0.999; // as in marks.js

const VERTEX = `
precision highp float;
in vec3 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

// Stripes, as on the cut parts of a technical drawing.
const FRAGMENT = `
precision highp float;
uniform vec3 tint;
uniform float pixels;
out vec4 color;
void main() {
    float along = fract((gl_FragCoord.x - gl_FragCoord.y) / (9.0 * pixels)) - 0.5;
    float line = 1.0 - smoothstep(0.08, 0.18, abs(along));
    color = vec4(tint * (1.0 - 0.22 * line), 1.0);
}
`;

export class Cut {
    // The objects of three.js, to be drawn in this order after the surface.
    mask;
    face;
    outline;
    #pixels = { value: 1 };

    constructor() {
        const geometry = new BufferGeometry();
        this.mask = new Mesh(geometry, this.#material({
            colorWrite: false,
            depthTest: false,
            stencilFunc: AlwaysStencilFunc,
            stencilFail: InvertStencilOp,
            stencilZFail: InvertStencilOp,
            stencilZPass: InvertStencilOp,
        }));
        this.face = new Mesh(geometry, this.#material({
            stencilFunc: NotEqualStencilFunc,
            stencilZPass: ZeroStencilOp,
        }));
        this.face.material.depthWrite = true;
        this.outline = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({
            linewidth: WIDTH,
            color: CAP_LINE,
            depthFunc: LessEqualDepth,
            depthWrite: false,
            transparent: true,
        }));
        this.show(null);
    }

    #material(options) {
        return new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: VERTEX,
            fragmentShader: FRAGMENT,
            uniforms: { tint: { value: new Vector3(...CAP) }, pixels: this.#pixels },
            side: DoubleSide,
            blending: NoBlending,
            depthWrite: false,
            stencilWrite: true,
            stencilRef: 0,
            ...options,
        });
    }

    // Shows a cut, {lines, fans} of outline.js, or none (null).
    show(cut) {
        const geometry = new BufferGeometry();
        const fans = new BufferAttribute(cut?.fans ?? new Float32Array(), 3);
        geometry.setAttribute('position', fans);
        this.face.geometry.dispose();
        [this.mask.geometry, this.face.geometry] = [geometry, geometry];
        const hasFace = fans.count > 0;
        [this.mask.visible, this.face.visible] = [hasFace, hasFace];
        this.outline.geometry.dispose();
        this.outline.geometry = new LineSegmentsGeometry();
        this.outline.visible = (cut?.lines.length ?? 0) > 0;
        if (this.outline.visible) {
            this.outline.geometry.setPositions(cut.lines);
        }
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.#pixels.value = ratio;
    }

    // Moves the outline towards the camera, as Marks.raise() does with lines.
    raise(position) {
        this.outline.scale.setScalar(RAISED);
        this.outline.position.copy(position).multiplyScalar(1 - RAISED);
    }
}
