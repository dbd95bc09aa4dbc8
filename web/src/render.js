// render.js - the only module, with rows.js, that knows WebGL and three.
//
// The arrays of geometry.js are two textures; one draw call gives fill, polygon edges and flat
// shading. Nothing is drawn until something changed. After each frame `onFrame` gets what it shows,
// so that a test can wait for a frame instead of for a time.

import {
    AlwaysDepth,
    BufferAttribute,
    BufferGeometry,
    Color,
    DoubleSide,
    FloatType,
    GLSL3,
    GreaterDepth,
    LessEqualDepth,
    Mesh,
    NoBlending,
    NoColorSpace,
    PerspectiveCamera,
    Points,
    RGBAFormat,
    RGBAIntegerFormat,
    RawShaderMaterial,
    Matrix4,
    NearestFilter,
    Scene,
    UnsignedIntType,
    Vector3,
    WebGLRenderTarget,
    WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import { MOST_PIXELS, arrowOf } from './arrows.js';
import {
    ROW,
    ballOf,
    edgesOfTriangles,
    hasVertex,
    pointAt,
    trianglesOfFace,
} from './geometry.js';
import { readSquare } from './pick.js';
import { Rows } from './rows.js';
import {
    ARROW_FRAGMENT,
    ARROW_VERTEX,
    DOT_FRAGMENT,
    DOT_PICK,
    DOT_VERTEX,
    MARK_VERTEX,
    SURFACE_FRAGMENT,
    SURFACE_PICK,
    SURFACE_VERTEX,
} from './shaders.js';
import {
    DIRECTION,
    FIELD_OF_VIEW,
    UP,
    fitDistance,
    pixelAtOne,
    turnTo,
} from './view.js';

const BACKGROUND = 0x0e1116;
const CHOSEN = 0xffb347;
const CHOSEN_START = 0x7a4a10; // where a selected half-edge begins
const BOUNDARY = 0x35d0e6;
const PREVIEW = 0xf4f6fa;
// Of half-edges by their role, see around.js; also in style.css.
const ARROWS = {
    self: 0xffb347,
    next: 0x6be675,
    prev: 0xe27bff,
    twin: 0x5fa8ff,
    near: 0xf4f6fa,
};
const DOT_SIZE = 7; // CSS pixels, as all sizes here
const MARK_SIZE = 13;
const LINE_WIDTH = 4;
const BOUNDARY_WIDTH = 3;
const PREVIEW_WIDTH = 2;
const EDGE_WIDTH = 0.75; // on each side of an edge
const RAISED = 0.996; // of the distance, as dots in shaders.js

const ZOOM = 0.8; // of the distance, a step of the keyboard

export class NoWebGL extends Error {}

export class Renderer {
    #canvas;
    #renderer;
    #camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
    #controls;
    #scene = new Scene();
    #pickScene = new Scene();
    #shared = { vertices: { value: null }, triangles: { value: null } };
    #pixel = { value: 1 };
    #edgeWidth = { value: EDGE_WIDTH };
    #surface;
    #chosen;
    #dots;
    #lines;
    #hiddenLines;
    #boundary;
    #preview;
    #arrows;
    #marks;
    #allVertices = false;
    #pickDots;
    #geometry = null;
    #label = null;
    #size = '';
    #scheduled = false;
    #onFrame;
    #onMove;

    // Throws NoWebGL. `onFrame(label)` is called after each frame with what show() was given, and
    // `onLost(lost)` when the graphics context goes and comes back, `onMove()` after the camera was
    // moved.
    constructor(canvas, { onFrame, onLost, onMove }) {
        const context = canvas.getContext('webgl2', { antialias: true, alpha: false });
        if (context === null) {
            throw new NoWebGL();
        }
        this.#canvas = canvas;
        this.#onFrame = onFrame;
        this.#onMove = onMove;
        this.#renderer = new WebGLRenderer({ canvas, context });
        this.#renderer.setClearColor(BACKGROUND);
        this.#camera.up.set(...UP);
        this.#controls = new OrbitControls(this.#camera, canvas);
        this.#controls.zoomToCursor = true;
        this.#controls.minDistance = 1e-4;
        this.#controls.maxDistance = 60;
        this.#controls.listenToKeyEvents(canvas);
        this.#controls.addEventListener('change', () => this.#draw());
        this.#controls.addEventListener('end', onMove);
        this.#build();
        this.fit();
        canvas.addEventListener('webglcontextlost', () => {
            this.#shared.vertices.value.forget();
            this.#shared.triangles.value.forget();
            onLost(true);
        });
        canvas.addEventListener('webglcontextrestored', () => {
            onLost(false);
            this.#draw();
        });
        new ResizeObserver(() => this.#resize()).observe(canvas);
    }

    // Show a mesh, or nothing (null). `label` is what onFrame will say is shown. Throws a RangeError,
    // and shows what it did before, when the mesh is larger than a texture can be.
    show(geometry, label) {
        const arrays = this.#arraysOf(geometry);
        this.#geometry = geometry;
        this.#shared.vertices.value?.dispose();
        this.#shared.triangles.value?.dispose();
        this.#shared.vertices.value = new Rows(arrays.vertices, RGBAFormat, FloatType);
        this.#shared.triangles.value = new Rows(
            arrays.triangles,
            RGBAIntegerFormat,
            UnsignedIntType,
        );
        this.#setRanges();
        this.setBoundary([]);
        this.select([], [], label);
    }

    // The arrays of the mesh that is shown were changed, see applyDelta(): only what changed goes to
    // the graphics memory. Boundary and selection stay as they were. Throws as show() does.
    update({ vertices, triangles }, label) {
        if (this.#geometry !== null) {
            const arrays = this.#arraysOf(this.#geometry);
            this.#shared.vertices.value = this.#shared.vertices.value.update(
                arrays.vertices,
                vertices,
            );
            this.#shared.triangles.value = this.#shared.triangles.value.update(
                arrays.triangles,
                triangles,
            );
            this.#setRanges();
        }
        this.#label = label;
        this.#draw();
    }

    // The arrays of a mesh or, of none, zeros.
    #arraysOf(geometry) {
        const vertices = geometry?.vertices ?? new Float32Array(4 * ROW);
        const triangles = geometry?.triangles ?? new Uint32Array(4 * ROW);
        const rows = Math.max(vertices.length, triangles.length) / (4 * ROW);
        if (rows > this.#renderer.capabilities.maxTextureSize) {
            throw new RangeError('This mesh is larger than the graphics memory can hold.');
        }
        return { vertices, triangles };
    }

    #setRanges() {
        this.#surface.geometry.setDrawRange(0, 3 * (this.#geometry?.triangleCount ?? 0));
        this.#dots.geometry.setDrawRange(0, this.#geometry?.vertexCount ?? 0);
        this.#setDots();
    }

    // Mark elements: {kind: 'face', id}, {kind: 'edge' or 'halfedge', from, to} or
    // {kind: 'vertex', id}, and draw half-edges as arrows, see around.js. Replaces what was marked
    // before.
    select(marks, halfedges, label) {
        this.#label = label;
        if (this.#geometry === null) {
            [marks, halfedges] = [[], []];
        }
        const geometry = this.#geometry;
        const triangles = idsOf(marks, 'face').flatMap((face) => trianglesOfFace(geometry, face));
        const edges = edgesOfTriangles(geometry?.triangles, triangles);
        let directed = false;
        for (const mark of marks) {
            if (mark.kind === 'edge' || mark.kind === 'halfedge') {
                edges.push([mark.from, mark.to]);
                directed ||= mark.kind === 'halfedge';
            }
        }
        this.#setChosen(triangles);
        this.#setLines(edges.flat(), directed);
        this.#setMarks(idsOf(marks, 'vertex'));
        this.#setArrows(halfedges);
        this.#draw();
    }

    // Lines over everything, of what is about to be done: coordinates of ends in pairs, or null.
    preview(coordinates) {
        const geometry = new LineSegmentsGeometry();
        if (coordinates !== null && coordinates.length > 0) {
            geometry.setPositions(coordinates);
        }
        this.#replace(this.#preview, geometry, (coordinates?.length ?? 0) > 0);
        this.#draw();
    }

    // All vertices as dots, or only the isolated ones, which nothing else shows.
    showVertices(all) {
        this.#allVertices = all;
        this.#setDots();
        this.#draw();
    }

    // Put the camera where the whole mesh is seen from the usual side.
    fit() {
        const { center, radius } = ballOf(this.#geometry ?? { vertices: [] });
        this.#look(center, DIRECTION, radius);
    }

    // Put the camera where a ball is seen with what is around it; `normal` is where what is in it
    // looks to, null where that is nowhere. A camera behind it goes around the mesh, another stays
    // on its side.
    frame({ center, radius, normal }) {
        const away = this.#camera.position.clone().sub(this.#controls.target).normalize();
        const direction = turnTo(away.toArray(), normal);
        this.#look(center, direction, radius > 0 ? 1.8 * radius : 0.1);
    }

    // Nearer (true) or further by a step.
    zoom(nearer) {
        const { target, minDistance, maxDistance } = this.#controls;
        const away = this.#camera.position.clone().sub(target);
        const distance = away.length() * (nearer ? ZOOM : 1 / ZOOM);
        away.setLength(Math.min(Math.max(distance, minDistance), maxDistance));
        this.#camera.position.copy(target).add(away);
        this.#controls.update();
        this.#draw();
        this.#onMove();
    }

    #look(center, direction, radius) {
        // Panels that came or went with the mesh have changed the canvas already.
        this.#resize();
        const distance = fitDistance(this.#camera.aspect) * radius;
        this.#controls.target.set(...center);
        this.#camera.position.set(...direction).multiplyScalar(distance);
        this.#camera.position.add(this.#controls.target);
        this.#controls.update();
        this.#draw();
        this.#onMove();
    }

    // Where the camera is and how it is turned: its own axes, and the canvas in CSS pixels.
    get view() {
        this.#camera.updateMatrixWorld();
        const { elements } = this.#camera.matrixWorld;
        const [right, up, back, position] = [0, 4, 8, 12].map((at) => elements.slice(at, at + 3));
        return { right, up, back, position, height: this.#canvas.clientHeight };
    }

    // Where the camera stands and what it looks at: six numbers.
    get camera() {
        return [...this.#camera.position.toArray(), ...this.#controls.target.toArray()];
    }

    set camera(numbers) {
        this.#resize();
        this.#camera.position.fromArray(numbers);
        this.#controls.target.fromArray(numbers, 3);
        this.#controls.update();
        this.#draw();
    }

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
        this.#setDepthRange();
        this.#camera.setViewOffset(width, height, left, top, size, size);
        this.#renderer.setRenderTarget(target);
        this.#renderer.setClearColor(0x000000, 0);
        this.#renderer.render(this.#pickScene, this.#camera);
        const ids = new Uint32Array(4 * size * size);
        this.#renderer.readRenderTargetPixels(target, 0, 0, size, size, ids);
        this.#renderer.setRenderTarget(null);
        this.#renderer.setClearColor(BACKGROUND, 1);
        this.#camera.clearViewOffset();
        target.dispose();
        return readSquare(ids, size);
    }

    // View and projection, column-major, as view.js wants it.
    get matrix() {
        this.#camera.updateMatrixWorld();
        return new Matrix4().multiplyMatrices(
            this.#camera.projectionMatrix,
            this.#camera.matrixWorldInverse,
        ).elements;
    }

    #build() {
        const surface = (fragment, uniforms) =>
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: SURFACE_VERTEX,
                fragmentShader: fragment,
                uniforms: { ...this.#shared, ...uniforms },
                side: DoubleSide,
                blending: NoBlending,
                // Behind what lies on it.
                polygonOffset: true,
                polygonOffsetFactor: 1,
                polygonOffsetUnits: 1,
            });
        const dots = (fragment, uniforms) =>
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: DOT_VERTEX,
                fragmentShader: fragment,
                uniforms: { ...this.#shared, ...uniforms },
                blending: NoBlending,
            });
        const dotUniforms = {
            size: { value: DOT_SIZE },
            isolatedOnly: { value: true },
            tint: { value: new Vector3(0.93, 0.95, 0.98) },
        };
        this.#surface = new Mesh(
            new BufferGeometry(),
            surface(SURFACE_FRAGMENT, { chosen: { value: false }, edgeWidth: this.#edgeWidth }),
        );
        // The same triangles again, a little nearer.
        this.#chosen = new Mesh(
            new BufferGeometry(),
            surface(SURFACE_FRAGMENT, { chosen: { value: true }, edgeWidth: this.#edgeWidth }),
        );
        this.#dots = new Points(new BufferGeometry(), dots(DOT_FRAGMENT, dotUniforms));
        this.#marks = new Points(
            new BufferGeometry(),
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: MARK_VERTEX,
                fragmentShader: DOT_FRAGMENT,
                uniforms: {
                    size: { value: MARK_SIZE },
                    tint: { value: new Vector3(1, 0.7, 0.28) },
                },
                blending: NoBlending,
            }),
        );
        // What is behind the surface is marked too, faintly.
        this.#lines = new LineSegments2(new LineSegmentsGeometry(), line(LessEqualDepth, 1));
        this.#hiddenLines = new LineSegments2(this.#lines.geometry, line(GreaterDepth, 0.3));
        this.#boundary = new LineSegments2(new LineSegmentsGeometry(), line(LessEqualDepth, 1));
        this.#boundary.material.linewidth = BOUNDARY_WIDTH;
        this.#boundary.material.vertexColors = false;
        this.#boundary.material.color.set(BOUNDARY);
        this.#preview = new LineSegments2(new LineSegmentsGeometry(), line(AlwaysDepth, 1));
        this.#preview.material.linewidth = PREVIEW_WIDTH;
        this.#preview.material.vertexColors = false;
        this.#preview.material.color.set(PREVIEW);
        this.#preview.visible = false;
        this.#arrows = new Mesh(
            new BufferGeometry(),
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: ARROW_VERTEX,
                fragmentShader: ARROW_FRAGMENT,
                uniforms: { pixel: this.#pixel, mostPixels: { value: MOST_PIXELS } },
                side: DoubleSide,
                blending: NoBlending,
            }),
        );
        this.#chosen.material.polygonOffsetFactor = 0.5;
        this.#chosen.material.polygonOffsetUnits = 0.5;
        this.#add(this.#scene, [
            this.#surface,
            this.#chosen,
            this.#boundary,
            this.#dots,
            this.#arrows,
            this.#hiddenLines,
            this.#lines,
            this.#marks,
            this.#preview,
        ]);
        this.#pickDots = new Points(this.#dots.geometry, dots(DOT_PICK, dotUniforms));
        this.#add(this.#pickScene, [
            new Mesh(this.#surface.geometry, surface(SURFACE_PICK, {})),
            this.#pickDots,
        ]);
        this.show(null, null);
    }

    // Bounds are not known to three, which sees no positions.
    #add(scene, objects) {
        objects.forEach((object, order) => {
            object.frustumCulled = false;
            object.renderOrder = order;
            scene.add(object);
        });
    }

    #setDots() {
        const visible = this.#allVertices || (this.#geometry?.hasIsolated ?? false);
        this.#dots.material.uniforms.isolatedOnly.value = !this.#allVertices;
        this.#dots.visible = visible;
        this.#pickDots.visible = visible;
    }

    #setChosen(triangles) {
        const corners = triangles.flatMap((one) => [3 * one, 3 * one + 1, 3 * one + 2]);
        const geometry = new BufferGeometry();
        geometry.setIndex(new BufferAttribute(new Uint32Array(corners), 1));
        this.#replace(this.#chosen, geometry, corners.length > 0);
    }

    #setLines(ends, directed) {
        const geometry = this.#segments(ends);
        if (ends.length > 0) {
            const [chosen, start] = [CHOSEN, CHOSEN_START].map((hex) => new Color(hex).toArray());
            const colors = ends.flatMap((_, i) => (directed && i % 2 === 0 ? start : chosen));
            geometry.setColors(colors);
        }
        this.#replace(this.#lines, geometry, ends.length > 0);
        this.#hiddenLines.geometry = geometry;
        this.#hiddenLines.visible = ends.length > 0;
    }

    // Draw the edges of boundary loops: pairs of vertices one after another. They may be of a
    // revision before what is shown: an edge whose ends are gone is left out.
    setBoundary(ends) {
        const live = [];
        for (let i = 0; this.#geometry !== null && i < ends.length; i += 2) {
            if (hasVertex(this.#geometry, ends[i]) && hasVertex(this.#geometry, ends[i + 1])) {
                live.push(ends[i], ends[i + 1]);
            }
        }
        this.#replace(this.#boundary, this.#segments(live), live.length > 0);
        this.#draw();
    }

    // Lines between pairs of vertices.
    #segments(ends) {
        const geometry = new LineSegmentsGeometry();
        if (ends.length > 0) {
            const { vertices } = this.#geometry;
            const points = new Float32Array(3 * ends.length);
            for (let i = 0; i < ends.length; i++) {
                for (let axis = 0; axis < 3; axis++) {
                    points[3 * i + axis] = vertices[4 * ends[i] + axis];
                }
            }
            geometry.setPositions(points);
        }
        return geometry;
    }

    #setArrows(halfedges) {
        const [position, spread, size, color] = [[], [], [], []];
        for (const halfedge of halfedges) {
            const arrow = arrowOf(this.#geometry, halfedge);
            const tint = new Color().setHex(ARROWS[halfedge.role], NoColorSpace).toArray();
            for (let i = 0; i < (arrow?.places.length ?? 0); i++) {
                position.push(...arrow.places[i]);
                spread.push(...arrow.spreads[i]);
                size.push(arrow.size);
                color.push(...tint);
            }
        }
        const geometry = new BufferGeometry();
        for (const [name, array] of Object.entries({ position, spread, size, color })) {
            const values = new BufferAttribute(new Float32Array(array), array === size ? 1 : 3);
            geometry.setAttribute(name, values);
        }
        this.#replace(this.#arrows, geometry, size.length > 0);
    }

    #setMarks(vertices) {
        const points = vertices.flatMap((vertex) => pointAt(this.#geometry, vertex));
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
        this.#replace(this.#marks, geometry, points.length > 0);
    }

    #replace(object, geometry, visible) {
        object.geometry.dispose();
        object.geometry = geometry;
        object.visible = visible;
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
        this.#camera.aspect = width / height;
        this.#camera.updateProjectionMatrix();
        this.#dots.material.uniforms.size.value = DOT_SIZE * ratio;
        this.#marks.material.uniforms.size.value = MARK_SIZE * ratio;
        this.#edgeWidth.value = EDGE_WIDTH * ratio;
        this.#pixel.value = pixelAtOne(height);
        this.#draw();
    }

    // The mesh is within 1 of the origin; a tight range keeps the depth buffer exact.
    #setDepthRange() {
        const distance = this.#camera.position.length();
        const near = 0.02 * this.#controls.getDistance();
        this.#camera.near = Math.max(distance - 1.1, near);
        this.#camera.far = distance + 1.1;
        this.#camera.updateProjectionMatrix();
        this.#camera.updateMatrixWorld();
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

    // A line is flat, and a surface that slopes would cut it: shrink it towards the camera, where
    // it is seen at the same place.
    #raiseLines() {
        for (const lines of [this.#lines, this.#hiddenLines, this.#boundary]) {
            lines.scale.setScalar(RAISED);
            lines.position.copy(this.#camera.position).multiplyScalar(1 - RAISED);
        }
    }

    #render() {
        this.#setDepthRange();
        this.#raiseLines();
        this.#renderer.render(this.#scene, this.#camera);
    }
}

function line(depthFunc, opacity) {
    return new LineMaterial({
        linewidth: LINE_WIDTH,
        vertexColors: true,
        depthFunc,
        depthWrite: false,
        transparent: true,
        opacity,
    });
}

function idsOf(marks, kind) {
    return marks.filter((mark) => mark.kind === kind).map(({ id }) => id);
}

