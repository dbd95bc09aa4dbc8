// sources.js - by what a mesh can be coloured: the measures that the server has, the attributes of the
// mesh, and the components. Nothing is listed here that the server does not list; only its units are
// known here.
//
// A source is {key, kind, name, title, unit, components, labels, isIndex, read}. `kind` is the kind of
// the elements that have values, `components` how many numbers a value has, and `isIndex` says that
// the values are numbers of things, so that they are not ordered. read(place, signal) returns a
// promise of an array with `components` numbers for each id; `place` is {mesh, revision, ids, corners}.

import * as api from '../wire/api.js';
import { unitText } from '../kit/units.js';

export const KINDS = { vertices: 'vertex', faces: 'face', edges: 'edge', halfedges: 'corner' };

// Units of measures by their names. All angles of the API are in radians.
const UNITS = {
    angle: 'rad',
    smallest_angle: 'rad',
    angle_defect: 'rad',
    dihedral: 'rad',
};

// Measures of lengths and areas, and of what lies in one of them, are in the unit that the user has chosen.
const SIZES = {
    length: () => sizeUnit('units', 1),
    area: () => sizeUnit('units', 2),
    mean_curvature: () => `1/${sizeUnit('unit', 1)}`,
    gaussian_curvature: () => `1/${sizeUnit('unit', 2)}`,
};

// Returns the unit of lengths (`power` 1) or areas (2): the chosen one, or else the word `unknown`.
function sizeUnit(unknown, power) {
    return unitText(power).trim() || `${unknown}${power === 2 ? '\u00b2' : ''}`;
}

// Types of attributes, by the array of their values.
const ARRAYS = {
    bool: Uint8Array,
    int32: Int32Array,
    uint32: Uint32Array,
    float: Float32Array,
    double: Float64Array,
};

// Returns the sources of a mesh.
export async function readSources(mesh) {
    const [measures, { attributes }] = await Promise.all([
        measuresOf(mesh),
        api.getAttributes(mesh),
    ]);
    return [
        ...attributes.filter(({ domain }) => domain in KINDS).map(attributeSource),
        ...measures.map(measureSource),
        componentSource(),
        positionSource(),
    ];
}

let measures = null; // of the server, read once

function measuresOf(mesh) {
    measures ??= api.getMeasures(mesh).catch((error) => {
        measures = null;
        throw error;
    });
    return measures;
}

export const keyOf = (of, kind, name) => `${of}/${kind}/${name}`;

function measureSource({ name, kind, components }) {
    return {
        key: keyOf('measure', kind, name),
        kind,
        name,
        title: wordsOf(name),
        get unit() {
            return SIZES[name]?.() ?? UNITS[name] ?? '';
        },
        components,
        labels: null,
        isIndex: false,
        read: async ({ mesh, revision, ids }, signal) => {
            const numbers = await api.measureAll(mesh, name, kind, revision, signal);
            return byId(numbers, ids, components);
        },
    };
}

function attributeSource({ domain: kind, name, type, components, labels = null }) {
    return {
        key: keyOf('attribute', kind, name),
        kind,
        name,
        title: name,
        unit: '',
        components,
        labels: type === 'bool' ? ['no', 'yes'] : labels,
        isIndex: components === 1 && (type === 'bool' || type.endsWith('int32')),
        isWhole: type.endsWith('int32'),
        read: async ({ mesh, revision }, signal) =>
            new ARRAYS[type](await api.getValues(mesh, kind, name, revision, signal)),
    };
}

function componentSource() {
    return {
        key: keyOf('measure', 'faces', 'component'),
        kind: 'faces',
        name: 'component',
        title: 'Component',
        unit: '',
        components: 1,
        labels: null,
        isIndex: true,
        needsCorners: true,
        read: ({ corners }) => corners.components(),
    };
}

// The API reads positions as if they were an attribute, but does not list them.
function positionSource() {
    return {
        ...attributeSource({ domain: 'vertices', name: 'position', type: 'double', components: 3 }),
        key: keyOf('measure', 'vertices', 'position'),
        title: 'Position',
        get unit() {
            return SIZES.length();
        },
    };
}

// Puts values that are in the order of the ids of all elements into an array by id.
function byId(numbers, ids, components) {
    if (numbers.length !== ids.length * components) {
        throw new RangeError('The values are of another revision.');
    }
    const all = new Float64Array(ids.length === 0 ? 0 : components * (ids.at(-1) + 1)).fill(NaN);
    ids.forEach((id, i) => {
        for (let part = 0; part < components; part++) {
            all[components * id + part] = numbers[components * i + part];
        }
    });
    return all;
}

// Writes a name of the API as words: "mean_curvature" as "Mean curvature".
function wordsOf(name) {
    const words = name.replaceAll('_', ' ');
    return words[0].toUpperCase() + words.slice(1);
}

// --- what of a vector is shown ---

const COLOUR_NAMES = ['Red', 'Green', 'Blue', 'Opacity'];

// The ways of showing a value of several numbers: [part, text]. A part is an index of a number, or
// 'length', 'direction', 'colour' or 'checker'.
export function partsOf({ kind, components, name }) {
    if (components === 1) {
        return [];
    }
    const names = components <= 4 ? ['x', 'y', 'z', 'w'] : null;
    const isColor = /colou?r/i.test(name);
    return [
        ...(kind === 'edges' ? [] : picturesOf(components)),
        ['length', 'Length'],
        ...Array.from({ length: components }, (_, i) => [
            `${i}`,
            (isColor ? COLOUR_NAMES : names)?.[i] ?? `Number ${i + 1}`,
        ]),
    ];
}

// The ways of showing a vector at once. A line has only one colour, so that edges have none of them.
function picturesOf(components) {
    return [
        ...(components === 3 ? [['direction', 'Direction, as a colour']] : []),
        ...(components === 3 || components === 4 ? [['colour', 'As a colour']] : []),
        ...(components === 2 ? [['checker', 'Checkerboard']] : []),
    ];
}

// Returns the part that is shown until the user chooses another one.
export function usualPart(source) {
    const { components, name } = source;
    const wanted = WANTED.find(([pattern]) => pattern.test(name))?.[1];
    const part = wanted === 'last' ? `${components - 1}` : wanted;
    return partsOf(source).some(([value]) => value === part) ? part : 'length';
}

// The part that an attribute with such a name shows.
const WANTED = [
    [/uv|tex/i, 'checker'],
    [/normal/i, 'direction'],
    [/colou?r/i, 'colour'],
    [/position|centroid/i, 'last'],
];

// Returns one number for each id: a part of a vector, or its length.
export function numbersOf(numbers, components, part) {
    if (components === 1) {
        return numbers;
    }
    const found = new Float64Array(Math.floor(numbers.length / components));
    for (let id = 0; id < found.length; id++) {
        if (part === 'length') {
            let square = 0;
            for (let i = 0; i < components; i++) {
                square += numbers[components * id + i] ** 2;
            }
            found[id] = Math.sqrt(square);
        } else {
            found[id] = numbers[components * id + Number(part)];
        }
    }
    return found;
}
