// values.js - the values by which the mesh is coloured, as textures and uniforms of the shaders of
// faces. Moving the range of the legend changes two numbers; the values stay in graphics memory.

import { DataTexture, FloatType, NearestFilter, RGBAFormat, UnsignedByteType, Vector2 } from 'three';

import { ROW } from '../geometry/geometry.js';
import { Rows } from './rows.js';
import { AS, OF } from './value_shader.js';

export class Values {
    uniforms = {
        values: { value: null },
        colours: { value: null },
        valuesOf: { value: OF.nothing },
        valuesAs: { value: AS.number },
        valueRange: { value: new Vector2(0, 1) },
        valueShade: { value: 1 },
    };
    // For the proxy, which has vertices and faces of the mesh, but other triangles: values of corners
    // and sides of triangles are not shown on it.
    proxyUniforms = { valuesOf: { value: OF.nothing } };
    #mostRows;

    // `mostRows` is the maximum height of a texture in texels.
    constructor(mostRows) {
        this.#mostRows = mostRows;
        this.hide();
        this.setColours(new Uint8Array([0, 0, 0, 255]));
    }

    // Colours the mesh by values: {of, as, texels}; `of` is a kind of OF, `as` a meaning of AS, and
    // `texels` an array of whole rows. Throws a RangeError if it is too large for a texture; then
    // the values that were shown before stay.
    show({ of, as, texels }) {
        if (texels.length / (4 * ROW) > this.#mostRows) {
            throw new RangeError('These values are more than the graphics memory can hold.');
        }
        const { values, valuesAs } = this.uniforms;
        values.value?.dispose();
        values.value = new Rows(texels, RGBAFormat, FloatType);
        this.#setOf(OF[of]);
        valuesAs.value = AS[as];
    }

    hide() {
        const { values } = this.uniforms;
        values.value?.dispose();
        values.value = new Rows(new Float32Array(4 * ROW), RGBAFormat, FloatType);
        this.#setOf(OF.nothing);
    }

    #setOf(kind) {
        const isInProxy = kind === OF.vertices || kind === OF.faces;
        this.uniforms.valuesOf.value = kind;
        this.proxyUniforms.valuesOf.value = isInProxy ? kind : OF.nothing;
    }

    // Sets the colours of a map, four bytes each.
    setColours(bytes) {
        const { colours } = this.uniforms;
        colours.value?.dispose();
        colours.value = new DataTexture(bytes, bytes.length / 4, 1, RGBAFormat, UnsignedByteType);
        colours.value.minFilter = NearestFilter;
        colours.value.magFilter = NearestFilter;
        colours.value.needsUpdate = true;
    }

    // Sets which numbers have the first and the last colour of the map.
    setRange(from, to) {
        this.uniforms.valueRange.value.set(from, to);
    }

    // Sets whether light falls on the coloured surface; without it, the colours are exactly those of
    // the map.
    set isShaded(isShaded) {
        this.uniforms.valueShade.value = isShaded ? 1 : 0;
    }

    // Frees the graphics memory.
    dispose() {
        this.uniforms.values.value.dispose();
        this.uniforms.colours.value.dispose();
    }

    // Called when the contents of the graphics memory are lost.
    forget() {
        this.uniforms.values.value.forget();
        this.uniforms.colours.value.needsUpdate = true;
    }
}
