// surface.js - the mesh itself: its faces with their edges, and vertices as dots.
//
// The arrays of geometry.js are two textures. One draw call draws fill, polygon edges and flat
// shading; another one draws ids for picking.

import {
    BufferGeometry,
    DoubleSide,
    FloatType,
    GLSL3,
    Mesh,
    NoBlending,
    Points,
    RGBAFormat,
    RGBAIntegerFormat,
    RawShaderMaterial,
    UnsignedIntType,
    Vector3,
} from 'three';

import { ROW } from '../geometry/geometry.js';
import { Rows } from './rows.js';
import {
    DOT_FRAGMENT,
    DOT_PICK,
    DOT_VERTEX,
    SURFACE_FRAGMENT,
    SURFACE_PICK,
    SURFACE_VERTEX,
} from './shaders.js';

const DOT_SIZE = 7; // in CSS pixels, as all sizes here
const EDGE_WIDTH = 0.75; // on each side of an edge

export class Surface {
    fill; // faces with their edges; `dots` are the vertices
    dots;
    pickFill; // draws ids of triangles instead of colours; `pickDots` draws ids of vertices
    pickDots;
    #mostRows;
    #textures = { vertices: { value: null }, triangles: { value: null } };
    #looks = { labels: { value: null }, palette: { value: null } };
    #isColored = { value: true };
    #edgeWidth = { value: EDGE_WIDTH };
    #geometry = null;
    #allVertices = false;

    // `mostRows` is the maximum height of a texture in texels.
    constructor(mostRows) {
        this.#mostRows = mostRows;
        const dots = (fragment, uniforms) =>
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: DOT_VERTEX,
                fragmentShader: fragment,
                uniforms: { ...this.#textures, ...uniforms },
                blending: NoBlending,
            });
        const dotUniforms = {
            size: { value: DOT_SIZE },
            isolatedOnly: { value: true },
            tint: { value: new Vector3(0.93, 0.95, 0.98) },
        };
        this.showMaterials(null);
        this.fill = new Mesh(new BufferGeometry(), this.material(false));
        this.dots = new Points(new BufferGeometry(), dots(DOT_FRAGMENT, dotUniforms));
        this.pickFill = new Mesh(this.fill.geometry, this.#material(SURFACE_PICK, {}));
        this.pickDots = new Points(this.dots.geometry, dots(DOT_PICK, dotUniforms));
    }

    // Returns a material for drawing triangles; if `isChosen` is true, it has the colour of
    // selected faces.
    material(isChosen) {
        const uniforms = { chosen: { value: isChosen }, edgeWidth: this.#edgeWidth };
        return this.#material(SURFACE_FRAGMENT, uniforms);
    }

    #material(fragment, uniforms) {
        return new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: SURFACE_VERTEX,
            fragmentShader: fragment,
            uniforms: {
                ...this.#textures,
                ...this.#looks,
                isColored: this.#isColored,
                ...uniforms,
            },
            side: DoubleSide,
            blending: NoBlending,
            // Faces are drawn a little farther from the camera than they are, so that they do not
            // hide the marks on them.
            polygonOffset: true,
            polygonOffsetFactor: 1,
            polygonOffsetUnits: 1,
        });
    }

    // Shows a mesh, or nothing (null). Throws a RangeError if the mesh is too large for a texture;
    // then the mesh that was shown before stays visible.
    show(geometry) {
        const arrays = this.#arraysOf(geometry);
        const { vertices, triangles } = this.#textures;
        this.#geometry = geometry;
        vertices.value?.dispose();
        triangles.value?.dispose();
        vertices.value = new Rows(arrays.vertices, RGBAFormat, FloatType);
        triangles.value = new Rows(arrays.triangles, RGBAIntegerFormat, UnsignedIntType);
        this.#setRanges();
    }

    // Called when the arrays of the mesh have changed at some places, see applyDelta(). Throws a
    // RangeError if the mesh is now too large for a texture.
    update(places) {
        const arrays = this.#arraysOf(this.#geometry);
        for (const [name, texture] of Object.entries(this.#textures)) {
            texture.value = texture.value.update(arrays[name], places[name]);
        }
        this.#setRanges();
    }

    // Called when the arrays have changed within some ranges, and the numbers of vertices and
    // triangles have changed: see Levels.takeChanges().
    refine(ranges) {
        for (const [name, texture] of Object.entries(this.#textures)) {
            texture.value.updateWithin(ranges[name]);
        }
        this.#setRanges();
    }

    // Sets the materials of faces: {labels, palette} of materials.js, or null.
    showMaterials(materials) {
        const { labels, palette } = this.#looks;
        labels.value?.dispose();
        palette.value?.dispose();
        labels.value = new Rows(
            materials?.labels ?? new Uint32Array(4 * ROW),
            RGBAIntegerFormat,
            UnsignedIntType,
        );
        palette.value = new Rows(
            materials?.palette ?? new Float32Array(4 * ROW),
            RGBAFormat,
            FloatType,
        );
    }

    // Called when the materials have changed; `change` is {palette, places}: `palette` says whether
    // the palette was replaced, and `places` lists the changed texels of `labels` (null: all may
    // have changed).
    updateMaterials(materials, change) {
        const { labels, palette } = this.#looks;
        labels.value = labels.value.update(materials.labels, change.places);
        if (change.palette) {
            palette.value = palette.value.update(materials.palette, null);
        }
    }

    // Shows or hides the colours of materials.
    set isColored(isColored) {
        this.#isColored.value = isColored;
    }

    // Called when the contents of the graphics memory are lost: all textures are uploaded again.
    forget() {
        [this.#textures, this.#looks]
            .flatMap((textures) => Object.values(textures))
            .forEach(({ value }) => value.forget());
    }

    // Returns the arrays of a mesh, or arrays of zeros if there is no mesh. Throws a RangeError if
    // an array is too large for a texture.
    #arraysOf(geometry) {
        const vertices = geometry?.vertices ?? new Float32Array(4 * ROW);
        const triangles = geometry?.triangles ?? new Uint32Array(4 * ROW);
        const rows = Math.max(vertices.length, triangles.length) / (4 * ROW);
        if (rows > this.#mostRows) {
            throw new RangeError('This mesh is larger than the graphics memory can hold.');
        }
        return { vertices, triangles };
    }

    #setRanges() {
        this.fill.geometry.setDrawRange(0, 3 * (this.#geometry?.triangleCount ?? 0));
        this.dots.geometry.setDrawRange(0, this.#geometry?.vertexCount ?? 0);
        this.#setDots();
    }

    // Shows all vertices as dots, or only isolated vertices, which would otherwise be invisible.
    showVertices(all) {
        this.#allVertices = all;
        this.#setDots();
    }

    #setDots() {
        const visible = this.#allVertices || (this.#geometry?.hasIsolated ?? false);
        this.dots.material.uniforms.isolatedOnly.value = !this.#allVertices;
        this.dots.visible = visible;
        this.pickDots.visible = visible;
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.dots.material.uniforms.size.value = DOT_SIZE * ratio;
        this.#edgeWidth.value = EDGE_WIDTH * ratio;
    }
}
