// fields.js - chooses the control of each parameter of an operation, and writes what the form says
// about the parameter.

import { Choice, Color, Flag, Ids, Numeral, Text, Vector, vectors, Whether } from './controls.js';
import { matrix } from './matrix.js';

const PLURALS = { vertices: 'vertex', halfedges: 'halfedge', edges: 'edge', faces: 'face' };
export const KINDS = Object.values(PLURALS);

// The types of parameters that can be filled with the position of a clicked vertex.
const PLACES = ['point', 'points'];

// Returns the kind of element that the user can click to fill this parameter, or null.
export function kindOf({ type }) {
    const kind = PLURALS[type] ?? type;
    if (PLACES.includes(type)) {
        return 'vertex';
    }
    return KINDS.includes(kind) ? kind : null;
}

export function isPlace({ type }) {
    return PLACES.includes(type);
}

// Returns whether the parameter takes several elements.
export function isList({ plural, type }) {
    return plural !== undefined || type in PLURALS;
}

// Makes the control of a parameter. `meshes()` returns a promise of the list of meshes;
// `pickable(param, control)` returns an element with the control's node and a button; after a click
// on the button, a click on an element in the view fills the control.
export function controlFor(param, meshes, pickable) {
    const { name, type, choices, default: usual, nullable = false } = param;
    if (type === 'flag') {
        return usual === undefined ? new Whether() : new Flag(usual);
    }
    if (type === 'text') {
        return new Text();
    }
    if (type === 'color' || type === 'color_alpha') {
        return new Color(name, type === 'color' ? 3 : 4);
    }
    if (type === 'choice') {
        return new Choice(choices.map((choice) => [choice, choice]), usual ?? choices[0]);
    }
    if (type === 'mesh') {
        const control = new Choice([['', 'which mesh']], '');
        meshes().then((items) => control.add(items.map((item) => [item.id, item.name || item.id])));
        return control;
    }
    if (type === 'number' || type === 'integer') {
        return new Numeral(name, hintFor(param), type === 'integer' ? '1' : 'any');
    }
    if (type === 'matrix') {
        return matrix(name, (part, control) => pickable({ name: part, type: 'point' }, control));
    }
    if (isPlace(param)) {
        return type === 'point' ? new Vector(name) : vectors(name);
    }
    return new Ids(name, isList(param), nullable);
}

// Returns the placeholder of an empty number field: the default value, if it is known; else
// 'number' if the user must give one, or 'default' if the server chooses one.
function hintFor({ default: usual, required }) {
    return usual === undefined ? (required ? 'number' : 'default') : `${usual}`;
}

// Returns a note on a parameter: whether the value is a whole number, its range, and whether it may
// be left out.
export function marksOf({ type, required, min, max, exclusive }) {
    const marks = type === 'integer' ? ['whole'] : [];
    if (min !== undefined || max !== undefined) {
        const between = exclusive ? 'between' : 'from';
        marks.push(`${between} ${min} ${exclusive ? 'and' : 'to'} ${max}`);
    }
    if (!required && type !== 'flag') {
        marks.push('optional');
    }
    return marks.join(', ');
}

// Returns whether every parameter has a value or needs none. If parameters are alternatives, which
// have the same `group`, a value for one of them is enough.
export function isComplete(fields) {
    return fields.every(
        (field) =>
            !field.param.required ||
            field.control.isSaid ||
            fields.some(
                (other) =>
                    field.param.group !== undefined &&
                    other.param.group === field.param.group &&
                    other.control.isSaid,
            ),
    );
}

// Returns [name, value], the member that a field adds to the request; the value is undefined if the
// field is empty. Missing values and ranges are not checked here: the server does that and explains
// what is wrong.
export function readField({ param, control }) {
    const value = control.read();
    if (Array.isArray(value) && param.plural !== undefined) {
        return value.length === 1 ? [param.name, value[0]] : [param.plural, value];
    }
    return [param.name, value];
}

// Returns whether the pointer of a problem, such as /ops/0/faces/3, refers to this field.
export function isAbout({ param }, pointer) {
    const member = pointer.split('/')[3];
    return member !== undefined && (member === param.name || member === param.plural);
}
