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

import { edgesOfTriangles, trianglesOfFace } from './geometry.js';
import {
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
const DOT_SIZE = 7; // CSS pixels, as all sizes here
const MARK_SIZE = 13;
const LINE_WIDTH = 4;
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
    #marks;
    #allVertices = false;
    #pickDots;
    #geometry = null;
    #label = null;
    #scheduled = false;
    #onFrame;

    // Throws NoWebGL. `onFrame(label)` is called after each frame with what show() was given, and
    // `onLost(lost)` when the graphics context goes and comes back.
    constructor(canvas, { onFrame, onLost }) {
        const context = canvas.getContext('webgl2', { antialias: true, alpha: false });
        if (context === null) {
            throw new NoWebGL();
        }
        this.#canvas = canvas;
        this.#onFrame = onFrame;
        this.#renderer = new WebGLRenderer({ canvas, context });
        this.#renderer.setClearColor(BACKGROUND);
        this.#camera.up.set(...UP);
        this.#controls = new OrbitControls(this.#camera, canvas);
        this.#controls.zoomToCursor = true;
        this.#controls.minDistance = 0.005;
        this.#controls.maxDistance = 60;
        this.#controls.listenToKeyEvents(canvas);
        this.#controls.addEventListener('change', () => this.#draw());
        this.#build();
        this.fit();
        canvas.addEventListener('webglcontextlost', () => onLost(true));
        canvas.addEventListener('webglcontextrestored', () => {
            onLost(false);
            this.#draw();
        });
        new ResizeObserver(() => this.#resize()).observe(canvas);
    }

    // Show a packed mesh, or nothing (null). `label` is what onFrame will say is shown.
    show(geometry, label) {
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
        this.select([], label);
    }

    // Mark elements: {kind: 'face', face}, {kind: 'edge' or 'halfedge', from, to} or
    // {kind: 'vertex', vertex}, in slots. Replaces what was marked before.
    select(marks, label) {
        this.#label = label;
        const faces = marks.filter((mark) => mark.kind === 'face').map((mark) => mark.face);
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
        this.#setMarks(marks.filter((mark) => mark.kind === 'vertex').map((mark) => mark.vertex));
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
        // Panels that came or went with the mesh have changed the canvas already.
        this.#resize();
        const distance = fitDistance(this.#camera.aspect) * (this.#geometry?.radius ?? 1);
        this.#controls.target.set(0, 0, 0);
        this.#camera.position.set(...DIRECTION).multiplyScalar(distance);
        this.#controls.update();
        this.#draw();
    }

    // What is visible within `reach` of a place on the canvas, nearest first:
    // {under, triangles, vertices}, where `under` is the nearest triangle or -1 and vertices are
    // those shown as dots.
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
        this.#add(this.#scene, [
            this.#surface,
            this.#dots,
            this.#hiddenLines,
            this.#lines,
            this.#marks,
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
        if (edges.length === 0) {
            return;
        }
        const geometry = new LineSegmentsGeometry();
        const points = edges.flatMap((ends) => ends.flatMap((slot) => this.#pointAt(slot)));
        geometry.setPositions(new Float32Array(points));
        const colors = new Float32Array(points.length);
        for (let i = 0; i < points.length; i += 3) {
            const start = directed && i % 6 === 0;
            new Color(start ? CHOSEN_START : CHOSEN).toArray(colors, i);
        }
        geometry.setColors(colors);
        this.#lines.geometry.dispose();
        this.#lines.geometry = geometry;
        this.#hiddenLines.geometry = geometry;
    }

    #setMarks(vertices) {
        const points = vertices.flatMap((slot) => this.#pointAt(slot));
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
        this.#marks.geometry.dispose();
        this.#marks.geometry = geometry;
        this.#marks.visible = points.length > 0;
    }

    #pointAt(slot) {
        return Array.from(this.#geometry.vertices.subarray(4 * slot, 4 * slot + 3));
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
        this.#camera.near = Math.max(distance - 1.1, 0.002);
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
            this.#setDepthRange();
            this.#renderer.render(this.#scene, this.#camera);
            this.#onFrame(this.#label);
        });
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

// The ids of a square of pixels, from the middle outwards, each once.
function sortIds(ids, size) {
    const radius = (size - 1) / 2;
    const found = [];
    for (let i = 0; i < size * size; i++) {
        if (ids[4 * i] !== 0) {
            const dx = (i % size) - radius;
            const dy = Math.floor(i / size) - radius;
            found.push({ kind: ids[4 * i], slot: ids[4 * i + 1], away: dx * dx + dy * dy });
        }
    }
    found.sort((a, b) => a.away - b.away);
    const unique = (kind) => [
        ...new Set(found.filter((id) => id.kind === kind).map((id) => id.slot)),
    ];
    const triangles = unique(ID_TRIANGLE);
    return { under: triangles[0] ?? -1, triangles, vertices: unique(ID_VERTEX) };
}
