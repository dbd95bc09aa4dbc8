// materials.js - the materials of a mesh and of its faces, as arrays for the renderer. They are
// read once and then updated by edit events. This module does not touch the page.
//
//   labels    one u32 per face, four in a texel: the label of the face's material, which is an
//             index into the list of names that the face attribute `material` has
//   palette   two texels per label: the first has red, green, blue and opacity; the second has red,
//             green and blue of the emitted light, and a number from SIDES. Colours are sRGB here
//             and linear in the API

import * as api from '../wire/api.js';
import { wholeRows } from '../geometry/geometry.js';

// The last of the eight numbers that the palette has for a material: how many sides of a face show
// its colour, or that the colour is unknown.
export const SIDES = { unknown: 0, one: 1, two: 2 };

const NAME = 'material'; // name of the attribute
const FEW = 1e4; // if more labels than this have changed, all labels are uploaded
const TRIES = 5; // attempts to read everything from one revision while other clients edit the mesh

export class Materials {
    revision = 0;
    labels = wholeRows(new Uint32Array());
    palette = wholeRows(new Float32Array());

    #mesh;
    #rows = []; // the materials of the mesh, as the server sent them
    #names = []; // names of the attribute's labels; empty if faces have no attribute `material`
    #fallback = 0; // the label of faces without a value
    #held = null; // edits that arrived while the materials are being read; null otherwise
    #reading = null; // identifies the latest call of read()

    constructor(mesh) {
        this.#mesh = mesh;
    }

    // Whether the mesh has no materials and its faces name none.
    get isEmpty() {
        return this.#rows.length === 0 && this.#names.every((name) => name === '');
    }

    // Returns {name, look} of each material, in the server's order; `look` are the material's
    // properties as the server sent them. Materials that faces name but the mesh does not have
    // follow, with null as `look`.
    get list() {
        const known = new Set(this.#rows.map(({ name }) => name));
        const others = this.#names.filter((name) => name !== '' && !known.has(name));
        return [
            ...this.#rows.map((row) => ({ name: row.name, look: row })),
            ...others.map((name) => ({ name, look: null })),
        ];
    }

    // Returns the name of a face's material, or '' if the face has none.
    nameOf(face) {
        return this.#names[this.labels[face] ?? this.#fallback] ?? '';
    }

    // Reads all materials from the server. Edits that are passed to note() during the reading are
    // applied afterwards. If read() is called again before it has ended, only the later call
    // counts.
    async read(signal) {
        const reading = {};
        this.#reading = reading;
        this.#held ??= [];
        const found = await readAll(this.#mesh, signal);
        if (this.#reading !== reading) {
            return;
        }
        this.revision = found.revision;
        this.#rows = found.materials;
        this.#setColumn(found.column);
        if (found.values !== null) {
            this.labels = wholeRows(found.values);
            this.labels.fill(this.#fallback, found.values.length);
        }
        this.#setPalette();
        const held = this.#held;
        this.#held = null;
        held.forEach((edit) => this.note(edit));
    }

    // Applies an edit event to the materials. Returns the argument for Surface.updateMaterials(),
    // or null if nothing changed.
    note(edit) {
        if (this.#held !== null) {
            this.#held.push(edit);
            return null;
        }
        if (edit.revision <= this.revision) {
            return null;
        }
        this.revision = edit.revision;
        const isOurs = ({ domain, name }) => domain === 'faces' && name === NAME;
        const added = edit.attributes_added?.find(isOurs);
        const isColumn = added !== undefined || edit.attributes_dropped?.some(isOurs) === true;
        if (isColumn) {
            this.#setColumn(added ?? null);
        }
        const values = edit.values?.attributes?.faces?.[NAME] ?? [];
        const places = this.#put(values);
        this.#rows = edit.materials ?? this.#rows;
        const isPalette = isColumn || edit.materials !== undefined;
        if (isPalette) {
            this.#setPalette();
        }
        return isPalette || values.length > 0
            ? { palette: isPalette, places: isColumn ? null : places }
            : null;
    }

    // Takes the description of the face attribute `material`, or null if faces have no such
    // attribute. All faces get the attribute's default value.
    #setColumn(column) {
        const isUsable = column?.labels !== undefined && column.components === 1;
        this.#names = isUsable ? column.labels : [];
        this.#fallback = isUsable ? [column.default].flat()[0] : 0;
        this.labels.fill(this.#fallback);
    }

    // Sets the labels (indices of material names) of some faces: [[face, label], ...]. Returns the
    // indices of the changed texels in ascending order, or null if there are more than FEW.
    #put(values) {
        const most = values.reduce((last, [face]) => Math.max(last, face), -1);
        if (most >= this.labels.length) {
            const longer = wholeRows(new Uint32Array(most + 1 + (most >>> 3)));
            longer.set(this.labels);
            longer.fill(this.#fallback, this.labels.length);
            this.labels = longer;
        }
        for (const [face, label] of values) {
            this.labels[face] = label;
        }
        return values.length > FEW
            ? null
            : [...new Set(values.map(([face]) => face >>> 2))].sort((a, b) => a - b);
    }

    #setPalette() {
        const rows = new Map(this.#rows.map((row) => [row.name, row]));
        const entries = new Float32Array(8 * this.#names.length);
        this.#names.forEach((name, i) => {
            const row = rows.get(name);
            if (row !== undefined) {
                entries.set(entryOf(row), 8 * i);
            }
        });
        this.palette = wholeRows(entries);
    }
}

function entryOf({ base_color: color, emission, two_sided: isTwoSided }) {
    return [
        ...color.slice(0, 3).map(toScreen),
        color[3],
        ...emission.map(toScreen),
        isTwoSided ? SIDES.two : SIDES.one,
    ];
}

// Converts a linear value to sRGB, IEC 61966-2-1; brighter values are clipped to white.
export function toScreen(linear) {
    return linear <= 0.0031308
        ? 12.92 * linear
        : Math.min(1.055 * linear ** (1 / 2.4) - 0.055, 1);
}

// Reads the materials of one revision: {revision, materials, column, values}, where `column`
// describes the attribute `material` and `values` are its values by face; both are null if faces
// have no such attribute.
async function readAll(mesh, signal) {
    for (let tries = 1; ; tries++) {
        const { revision, attributes } = await api.getAttributes(mesh, signal);
        const column = attributes.find((it) => it.domain === 'faces' && it.name === NAME) ?? null;
        try {
            const [{ materials }, values] = await Promise.all([
                api.getMaterials(mesh, revision, signal),
                column === null ? null : api.getFaceLabels(mesh, NAME, revision, signal),
            ]);
            return { revision, materials, column, values };
        } catch (error) {
            // With 410 the server says that it no longer has this revision, because the mesh was
            // edited meanwhile: then the materials of the newest revision are read.
            if (error.status !== 410 || tries === TRIES) {
                throw error;
            }
        }
    }
}
