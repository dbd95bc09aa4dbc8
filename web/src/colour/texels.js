// texels.js - arranges values for the renderer, see gl/values.js. Pure.
//
// Numbers are scaled so that the least one is 0 and the largest one 1, before they are rounded to
// floats: values such as dates or distances far from zero keep their differences.

import { NONE } from '../geometry/corners.js';
import { wholeRows } from '../geometry/geometry.js';

// Stands for an element without a value, see NO_VALUE in value_shader.js.
const ABSENT = -2e30;

// Returns the scaling of a column: scaled = (number - origin) * factor.
export function scalingOf({ least, most, count }) {
    const width = most - least;
    return {
        origin: count > 0 ? least : 0,
        factor: count > 0 && width > 0 && Number.isFinite(width) ? 1 / width : 1,
    };
}

// Returns the texels for a column of numbers. `kind` is the kind of its elements; for half-edges and
// edges, `corners` are the half-edges at the corners of the triangles, see Corners.ofTriangles().
export function texelsOfNumbers(kind, column, corners) {
    const { origin, factor } = scalingOf(column);
    return arrange(kind, column, corners, 1, (texels, slot, id) => {
        const number = column.at(id);
        texels[slot] = Number.isNaN(number) ? ABSENT : (number - origin) * factor;
    });
}

// Returns the texels for categories: each element has the index of its number in `categories`.
export function texelsOfCategories(kind, column, corners, categories) {
    const places = new Map(categories.map(({ value }, i) => [value, i]));
    return arrange(kind, column, corners, 1, (texels, slot, id) => {
        texels[slot] = places.get(column.at(id)) ?? ABSENT;
    });
}

// Returns the texels for vectors; `numbers` has `components` numbers for each id, of which the first
// three count, and `scale` multiplies them.
export function texelsOfVectors(kind, { ids, numbers, components }, corners, scale) {
    const used = Math.min(components, 3);
    return arrange(kind, { ids }, corners, 4, (texels, slot, id) => {
        const at = components * id;
        let isKnown = at + components <= numbers.length;
        for (let i = 0; i < used; i++) {
            const number = numbers[at + i];
            isKnown &&= Number.isFinite(number);
            texels[4 * slot + i] = Number.isFinite(number) ? number * scale : 0;
        }
        texels[4 * slot + 3] = isKnown ? 1 : 0;
    });
}

// Returns an array in which `put(texels, slot, id)` has written the value of each element to the slots
// that show it; `size` is the number of floats of a slot.
function arrange(kind, { ids }, corners, size, put) {
    if (kind === 'vertices' || kind === 'faces') {
        const slots = ids.length === 0 ? 0 : ids[ids.length - 1] + 1;
        const texels = wholeRows(new Float32Array(size * slots));
        for (const id of ids) {
            put(texels, id, id);
        }
        return texels;
    }
    const texels = wholeRows(new Float32Array(size * corners.length));
    if (size === 1) {
        texels.fill(ABSENT);
    }
    for (let corner = 0; corner < corners.length; corner++) {
        const halfedge = corners[corner];
        if (halfedge !== NONE) {
            put(texels, corner, kind === 'edges' ? halfedge >>> 1 : halfedge);
        }
    }
    return texels;
}
