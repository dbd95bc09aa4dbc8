// render.js - the only module that knows WebGL and three.
//
// The arrays of geometry.js become two textures; one draw call gives fill, polygon edges and flat
// shading. Nothing is drawn until something changed. After each frame `onFrame` gets what it shows,
// so that a test can wait for a frame instead of for a time.

import {
    BufferAttribute,
    BufferGeometry,
    Color,
    DataTexture,
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

import { arrowOf } from './arrows.js';
import { edgesOfTriangles, pointAt, trianglesOfFace } from './geometry.js';
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
import { DIRECTION, FIELD_OF_VIEW, UP, fitDistance } from './view.js';

const BACKGROUND = 0x0e1116;
const CHOSEN = 0xffb347;
const CHOSEN_START = 0x7a4a10; // where a selected half-edge begins
const BOUNDARY = 0x35d0e6;
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
const EDGE_WIDTH = 0.75; // on each side of an edge

// Rows of the textures; every WebGL2 has 2048.
const TEXTURE_WIDTH = 2048;

// What the id buffer holds: see the fragment shaders.
const ID_TRIANGLE = 1;
const ID_VERTEX = 2;

export class NoWebGL extends Error {}

export class Renderer {
    #canvas;
    #renderer;
    #camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
    #controls;
    #scene = new Scene();
    #pickScene = new Scene();
    #shared = { vertices: { value: null }, triangles: { value: null } };
    #surface;
    #dots;
    #lines;
    #hiddenLines;
    #boundary;
    #arrows;
    #marks;
    #allVertices = false;
    #pickDots;
    #geometry = null;
    #label = null;
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
        canvas.addEventListener('webglcontextlost', () => onLost(true));
        canvas.addEventListener('webglcontextrestored', () => {
            onLost(false);
            this.#draw();
        });
        new ResizeObserver(() => this.#resize()).observe(canvas);
    }

    // Show a mesh with the edges of its boundary loops, or nothing (null). `label` is what onFrame
    // will say is shown.
    show(geometry, boundary, label) {
        this.#shared.vertices.value?.dispose();
        this.#shared.triangles.value?.dispose();
        this.#geometry = geometry;
        this.#label = label;
        const vertices = geometry?.vertices ?? new Float32Array(0);
        const triangles = geometry?.triangles ?? new Uint32Array(0);
        this.#shared.vertices.value = this.#texture(vertices, RGBAFormat, FloatType);
        this.#shared.triangles.value = this.#texture(
            triangles,
            RGBAIntegerFormat,
            UnsignedIntType,
        );
        this.#surface.geometry.setDrawRange(0, (3 * triangles.length) / 4);
        this.#dots.geometry.setDrawRange(0, vertices.length / 4);
        this.#setDots();
        this.#setBoundary(boundary);
        this.select([], [], label);
    }

    // Mark elements: {kind: 'face', id}, {kind: 'edge' or 'halfedge', from, to} or
    // {kind: 'vertex', id}, and draw half-edges as arrows, see around.js. Replaces what was marked
    // before.
    select(marks, halfedges, label) {
        this.#label = label;
        const faces = idsOf(marks, 'face');
        const triangles = this.#geometry?.triangles;
        const edges = faces.flatMap((face) =>
            edgesOfTriangles(triangles, trianglesOfFace(triangles, face)),
        );
        let directed = false;
        for (const mark of marks) {
            if (mark.kind === 'edge' || mark.kind === 'halfedge') {
                edges.push([mark.from, mark.to]);
                directed ||= mark.kind === 'halfedge';
            }
        }
        this.#surface.material.uniforms.selected.value = faces.at(-1) ?? -1;
        this.#setLines(edges, directed);
        this.#setMarks(idsOf(marks, 'vertex'));
        this.#setArrows(halfedges);
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
        const { center, radius } = this.#geometry ?? { center: [0, 0, 0], radius: 1 };
        this.#look(center, DIRECTION, radius);
    }

    // Put the camera nearer or further on the side it is, so that some points are seen with what is
    // around them.
    frame(points) {
        const [low, high] = [Math.min, Math.max].map((pick) =>
            [0, 1, 2].map((axis) => pick(...points.map((point) => point[axis]))),
        );
        const center = low.map((value, axis) => (value + high[axis]) / 2);
        const radius = Math.max(
            ...points.map((point) => Math.hypot(...point.map((value, i) => value - center[i]))),
        );
        const away = this.#camera.position.clone().sub(this.#controls.target).normalize();
        this.#look(center, away.toArray(), radius > 0 ? 1.8 * radius : 0.1);
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

    // What is visible within `reach` of a place on the canvas, nearest first:
    // {under, away, triangles, vertices}, where `under` is the nearest triangle or -1, `away` how
    // far it is in pixels, and vertices are those shown as dots.
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
        return sortIds(ids, size);
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
                // Behind the lines and dots that lie on it.
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
            surface(SURFACE_FRAGMENT, {
                selected: { value: -1 },
                edgeWidth: { value: EDGE_WIDTH },
            }),
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
        this.#arrows = new Mesh(
            new BufferGeometry(),
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: ARROW_VERTEX,
                fragmentShader: ARROW_FRAGMENT,
                side: DoubleSide,
                blending: NoBlending,
            }),
        );
        this.#add(this.#scene, [
            this.#surface,
            this.#boundary,
            this.#dots,
            this.#arrows,
            this.#hiddenLines,
            this.#lines,
            this.#marks,
        ]);
        this.#pickDots = new Points(this.#dots.geometry, dots(DOT_PICK, dotUniforms));
        this.#add(this.#pickScene, [
            new Mesh(this.#surface.geometry, surface(SURFACE_PICK, {})),
            this.#pickDots,
        ]);
        this.show(null, [], null);
    }

    // Bounds are not known to three, which sees no positions.
    #add(scene, objects) {
        objects.forEach((object, order) => {
            object.frustumCulled = false;
            object.renderOrder = order;
            scene.add(object);
        });
    }

    #texture(array, format, type) {
        const rows = Math.max(Math.ceil(array.length / 4 / TEXTURE_WIDTH), 1);
        if (rows > this.#renderer.capabilities.maxTextureSize) {
            throw new RangeError('This mesh is larger than the graphics memory can hold.');
        }
        const whole = new array.constructor(4 * TEXTURE_WIDTH * rows);
        whole.set(array);
        const texture = new DataTexture(whole, TEXTURE_WIDTH, rows, format, type);
        texture.minFilter = NearestFilter;
        texture.magFilter = NearestFilter;
        texture.needsUpdate = true;
        return texture;
    }

    #setDots() {
        const visible = this.#allVertices || (this.#geometry?.hasIsolated ?? false);
        this.#dots.material.uniforms.isolatedOnly.value = !this.#allVertices;
        this.#dots.visible = visible;
        this.#pickDots.visible = visible;
    }

    #setLines(edges, directed) {
        this.#lines.visible = edges.length > 0;
        this.#hiddenLines.visible = edges.length > 0;
        const geometry = this.#segments(edges, (start) =>
            directed && start ? CHOSEN_START : CHOSEN,
        );
        this.#lines.geometry.dispose();
        this.#lines.geometry = geometry;
        this.#hiddenLines.geometry = geometry;
    }

    #setBoundary(edges) {
        this.#boundary.visible = edges.length > 0;
        this.#boundary.geometry.dispose();
        this.#boundary.geometry = this.#segments(edges, () => BOUNDARY);
    }

    // Lines between pairs of vertices; `colorOf(start)` of either end.
    #segments(edges, colorOf) {
        const geometry = new LineSegmentsGeometry();
        const points = new Float32Array(6 * edges.length);
        const colors = new Float32Array(6 * edges.length);
        edges.flat().forEach((vertex, i) => {
            points.set(pointAt(this.#geometry, vertex), 3 * i);
            new Color(colorOf(i % 2 === 0)).toArray(colors, 3 * i);
        });
        if (edges.length > 0) {
            geometry.setPositions(points);
            geometry.setColors(colors);
        }
        return geometry;
    }

    #setArrows(halfedges) {
        const points = [];
        const colors = [];
        for (const halfedge of halfedges) {
            const arrow = arrowOf(this.#geometry, halfedge);
            const color = new Color().setHex(ARROWS[halfedge.role], NoColorSpace).toArray();
            points.push(...arrow.flat());
            colors.push(...arrow.flatMap(() => color));
        }
        const geometry = new BufferGeometry();
        for (const [name, array] of Object.entries({ position: points, color: colors })) {
            geometry.setAttribute(name, new BufferAttribute(new Float32Array(array), 3));
        }
        this.#arrows.geometry.dispose();
        this.#arrows.geometry = geometry;
        this.#arrows.visible = points.length > 0;
    }

    #setMarks(vertices) {
        const points = vertices.flatMap((vertex) => pointAt(this.#geometry, vertex));
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
        this.#marks.geometry.dispose();
        this.#marks.geometry = geometry;
        this.#marks.visible = points.length > 0;
    }

    #resize() {
        const { clientWidth, clientHeight } = this.#canvas;
        const ratio = window.devicePixelRatio;
        this.#renderer.setPixelRatio(ratio);
        this.#renderer.setSize(Math.max(clientWidth, 1), Math.max(clientHeight, 1), false);
        this.#camera.aspect = Math.max(clientWidth, 1) / Math.max(clientHeight, 1);
        this.#camera.updateProjectionMatrix();
        this.#dots.material.uniforms.size.value = DOT_SIZE * ratio;
        this.#marks.material.uniforms.size.value = MARK_SIZE * ratio;
        this.#surface.material.uniforms.edgeWidth.value = EDGE_WIDTH * ratio;
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

    #render() {
        this.#setDepthRange();
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

// The ids of a square of pixels, from the middle outwards, each once.
function sortIds(ids, size) {
    const radius = (size - 1) / 2;
    const found = [];
    for (let i = 0; i < size * size; i++) {
        if (ids[4 * i] !== 0) {
            const dx = (i % size) - radius;
            const dy = Math.floor(i / size) - radius;
            found.push({ kind: ids[4 * i], id: ids[4 * i + 1], away: dx * dx + dy * dy });
        }
    }
    found.sort((a, b) => a.away - b.away);
    const unique = (kind) => [
        ...new Set(found.filter((one) => one.kind === kind).map(({ id }) => id)),
    ];
    const triangles = unique(ID_TRIANGLE);
    const nearest = found.find((one) => one.kind === ID_TRIANGLE);
    return {
        under: nearest?.id ?? -1,
        away: Math.sqrt(nearest?.away ?? Infinity),
        triangles,
        vertices: unique(ID_VERTEX),
    };
}
