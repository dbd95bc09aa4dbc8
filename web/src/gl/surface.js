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
    NormalBlending,
    Points,
    RGBAFormat,
    RGBAIntegerFormat,
    RawShaderMaterial,
    UnsignedIntType,
    Vector3,
} from 'three';

import { ROW } from '../geometry/geometry.js';
import { Rows } from './rows.js';
import { SurfaceLook } from './surface_look.js';
import {
    DOT_FRAGMENT,
    DOT_PICK,
    DOT_VERTEX,
    SURFACE_FRAGMENT,
    SURFACE_PICK,
    SURFACE_VERTEX,
} from './shaders.js';
import { Values } from './values.js';

const DOT_SIZE = 7; // in CSS pixels, as all sizes here
const EDGE_WIDTH = 0.75; // on each side of an edge

// The size of a vertex if the mesh is drawn as points, which decreases with the number of vertices.
const pointSize = (count) => Math.min(Math.max(9 - 1.6 * Math.log10(count + 1), 1.75), 6);

export class Surface {
    fill; // faces with their edges; `dots` are the vertices
    dots;
    pickFill; // draws ids of triangles instead of colours; `pickDots` draws ids of vertices
    pickDots;
    isHurried = false; // the proxy is drawn
    proxy; // few triangles that are drawn instead of `fill` while the camera moves, see proxy.js
    look = new SurfaceLook();
    #ways; // the materials of `fill` and `proxy` by way of drawing, see #waysOf()
    #proxyWays;
    #proxyLook = {
        triangles: { value: null },
        normals: { value: null },
        isSmooth: { value: true },
        edgeStrength: { value: 0 },
    };
    #proxyCount = 0;
    #ratio = 1;
    values; // the values by which the faces are coloured
    #mostRows;
    #textures = { vertices: { value: null }, triangles: { value: null } };
    #looks = { labels: { value: null }, palette: { value: null } };
    #isColored = { value: true };
    #edgeWidth = { value: EDGE_WIDTH };
    #geometry = null;
    #still = null; // the texture of vertices where they are, while bend() shows others
    #allVertices = false;

    // `mostRows` is the maximum height of a texture in texels.
    constructor(mostRows) {
        this.#mostRows = mostRows;
        this.values = new Values(mostRows);
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
            isAlone: { value: false },
            ink: this.look.uniforms.ink,
            paper: this.look.uniforms.paper,
            cut: this.look.uniforms.cut,
        };
        this.showMaterials(null);
        this.#ways = this.#waysOf({});
        this.#proxyWays = this.#waysOf({ ...this.#proxyLook, ...this.values.proxyUniforms });
        this.fill = new Mesh(new BufferGeometry(), this.#ways.plain);
        this.proxy = new Mesh(new BufferGeometry(), this.#proxyWays.solid);
        this.proxy.visible = false;
        this.dots = new Points(new BufferGeometry(), dots(DOT_FRAGMENT, dotUniforms));
        this.pickFill = new Mesh(this.fill.geometry, this.#material(SURFACE_PICK, {}, true));
        this.pickDots = new Points(
            this.dots.geometry,
            dots(DOT_PICK, { ...dotUniforms, isolatedOnly: { value: true } }),
        );
    }

    // Returns the materials for drawing triangles in the colour of selected faces, {plain, looked}.
    chosenMaterials() {
        const uniforms = { chosen: { value: true } };
        return {
            plain: this.#material(SURFACE_FRAGMENT, uniforms, false),
            looked: this.#material(SURFACE_FRAGMENT, uniforms, true),
        };
    }

    // Returns the materials of faces: `plain`, and by way of drawing those that look in any other way.
    #waysOf(uniforms) {
        const values = { chosen: { value: false }, ...uniforms };
        const make = (isLooked) => this.#material(SURFACE_FRAGMENT, values, isLooked);
        const [xray, wire] = [make(true), make(true)];
        Object.assign(xray, { transparent: true, blending: NormalBlending, depthWrite: false });
        Object.assign(wire, { transparent: true, blending: NormalBlending, depthWrite: false });
        return { plain: make(false), solid: make(true), points: make(true), xray, wire };
    }

    #material(fragment, uniforms, isLooked) {
        return new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: SURFACE_VERTEX,
            fragmentShader: fragment,
            defines: isLooked ? { LOOKED: '' } : {},
            uniforms: {
                ...this.#textures,
                ...this.#looks,
                ...this.look.uniforms,
                ...this.values.uniforms,
                isColored: this.#isColored,
                edgeWidth: this.#edgeWidth,
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

    // --- the look ---

    // Sets how faces are drawn, see SurfaceLook.
    setLook(look) {
        this.look.set(look);
        this.#setWay();
    }

    // Draws the mesh plainly from now on, because the programs for other looks do not work. Returns
    // false if this was known before.
    giveUpLook() {
        const isNew = this.look.giveUp();
        this.pickFill.material = this.#material(SURFACE_PICK, {}, false);
        this.#setWay();
        return isNew;
    }

    // Cuts away a part of the mesh, see SurfaceLook.setCut().
    setCut(plane) {
        this.look.setCut(plane);
        this.#setWay();
    }

    // Sets the triangles to draw while the camera moves, {triangles, triangleCount, normals}, or none
    // (null). `normals` are those of normals.js.
    setProxy(proxy) {
        if (proxy === null && this.#proxyCount === 0) {
            return;
        }
        for (const name of ['triangles', 'normals']) {
            const texture = this.#proxyLook[name];
            texture.value?.dispose();
            texture.value =
                proxy === null ? null : new Rows(proxy[name], RGBAIntegerFormat, UnsignedIntType);
        }
        this.#proxyCount = proxy?.triangleCount ?? 0;
        this.proxy.geometry.setDrawRange(0, 3 * this.#proxyCount);
        this.hurry(false);
    }

    // Draws the proxy instead of the mesh, if there is one. Returns whether it does.
    hurry(isHurried) {
        const before = this.isHurried;
        this.isHurried = isHurried && this.#proxyCount > 0 && !this.look.isBroken;
        if (this.isHurried !== before) {
            this.#setWay();
        }
        return this.isHurried;
    }

    // Chooses what is drawn, and how.
    #setWay() {
        const { way, isPlain } = this.look;
        this.fill.material = isPlain ? this.#ways.plain : this.#ways[way];
        this.proxy.material = this.#proxyWays[way];
        this.fill.visible = way !== 'points' && !this.isHurried;
        this.proxy.visible = way !== 'points' && this.isHurried;
        this.#setDots();
    }

    // Shows a mesh, or nothing (null). Throws a RangeError if the mesh is too large for a texture;
    // then the mesh that was shown before stays visible.
    show(geometry) {
        this.bend(null);
        const arrays = this.#arraysOf(geometry);
        const { vertices, triangles } = this.#textures;
        this.#geometry = geometry;
        this.look.setNormals(null);
        this.setProxy(null);
        vertices.value?.dispose();
        triangles.value?.dispose();
        vertices.value = new Rows(arrays.vertices, RGBAFormat, FloatType);
        triangles.value = new Rows(arrays.triangles, RGBAIntegerFormat, UnsignedIntType);
        this.#setRanges();
    }

    // Called when the arrays of the mesh have changed at some places, see applyDelta(). Throws a
    // RangeError if the mesh is now too large for a texture.
    update(places) {
        this.bend(null);
        const arrays = this.#arraysOf(this.#geometry);
        for (const [name, texture] of Object.entries(this.#textures)) {
            texture.value = texture.value.update(arrays[name], places[name]);
        }
        this.look.update(places.triangles, arrays.triangles.length);
        this.setProxy(null);
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

    // Shows the vertices `ids` at other places (three view coordinates each), until the next call of
    // this function, show() or update(); null shows them where they are. Returns the arrays that are
    // shown.
    bend(ids, places) {
        const { vertices } = this.#textures;
        if (this.#still !== null) {
            vertices.value.dispose();
            vertices.value = this.#still;
            this.#still = null;
        }
        if (ids === null || this.#geometry === null) {
            return this.#geometry;
        }
        const bent = this.#geometry.vertices.slice();
        ids.forEach((id, i) => bent.set(places.subarray(3 * i, 3 * i + 3), 4 * id));
        this.#still = vertices.value;
        vertices.value = new Rows(bent, RGBAFormat, FloatType);
        return { ...this.#geometry, vertices: bent };
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

    // Frees the graphics memory; the surface must not be used any more.
    dispose() {
        [this.#textures, this.#looks]
            .flatMap((textures) => Object.values(textures))
            .forEach(({ value }) => value.dispose());
        for (const object of [this.fill, this.dots, this.pickFill, this.pickDots]) {
            object.geometry.dispose();
            object.material.dispose();
        }
        for (const ways of [this.#ways, this.#proxyWays]) {
            Object.values(ways).forEach((material) => material.dispose());
        }
        this.#proxyLook.triangles.value?.dispose();
        this.#proxyLook.normals.value?.dispose();
        this.values.dispose();
        this.look.dispose();
    }

    // Called when the contents of the graphics memory are lost: all textures are uploaded again.
    forget() {
        [this.#textures, this.#looks]
            .flatMap((textures) => Object.values(textures))
            .forEach(({ value }) => value.forget());
        this.look.forget();
        this.#proxyLook.triangles.value?.forget();
        this.#proxyLook.normals.value?.forget();
        this.#still?.forget();
        this.values.forget();
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
        const isAlone = this.look.way === 'points';
        const isPicked = this.#allVertices || (this.#geometry?.hasIsolated ?? false);
        const { uniforms } = this.dots.material;
        uniforms.isolatedOnly.value = !this.#allVertices && !isAlone;
        uniforms.isAlone.value = isAlone && !this.#allVertices;
        const size = uniforms.isAlone.value
            ? pointSize(this.#geometry?.vertexCount ?? 0)
            : DOT_SIZE;
        uniforms.size.value = size * this.#ratio;
        this.dots.visible = isAlone || (isPicked && !this.isHurried);
        this.pickDots.material.uniforms.isolatedOnly.value = !this.#allVertices;
        this.pickDots.visible = isPicked;
    }

    // Sets the number of screen pixels per CSS pixel.
    setPixelRatio(ratio) {
        this.#ratio = ratio;
        this.#edgeWidth.value = EDGE_WIDTH * ratio;
        this.#setDots();
    }
}
