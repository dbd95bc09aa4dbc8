// fields.js - chooses the control of each parameter of an operation, and writes what the form says
// about the parameter.

import { KIND_OF } from '../geometry/kinds.js';
import { Angle, degreesOf } from '../kit/angle.js';
import {
    Choice,
    Color,
    Flag,
    Ids,
    Numbers,
    Numeral,
    Text,
    Vector,
    Whether,
    polygon,
    vectors,
} from '../kit/controls.js';
import { formatCount, formatMeasure } from '../kit/dom.js';
import { matrix } from '../kit/matrix.js';
import { MeshChoice } from '../kit/mesh_choice.js';

export const KINDS = Object.values(KIND_OF);

// The types of parameters that can be filled with the position of a clicked vertex.
const PLACES = ['point', 'points'];

// Returns the kind of element that the user can click to fill this parameter, or null.
export function kindOf({ type }) {
    const kind = KIND_OF[type] ?? type;
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
    return plural !== undefined || type in KIND_OF;
}

// Returns how many elements of these kinds an operation takes; of parameters that are alternatives,
// one counts.
export function roomFor({ params }, kinds) {
    const rooms = new Map();
    for (const param of params) {
        if (kinds.includes(kindOf(param)) && !isPlace(param)) {
            const key = param.group ?? param.name;
            rooms.set(key, Math.max(rooms.get(key) ?? 0, isList(param) ? Infinity : 1));
        }
    }
    return [...rooms.values()].reduce((sum, room) => sum + room, 0);
}

// Makes the control of a parameter. `meshes()` returns a promise of the list of meshes;
// `pickable(param, control)` returns an element with the control's node and a button; after a click
// on the button, a click on an element in the view fills the control.
export function controlFor(param, meshes, pickable) {
    const { name, type, choices, default: usual, nullable = false, set = false } = param;
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
        const options = choices.map((choice) => [choice, choice]);
        return isChosenByServer(param)
            ? new Choice([['', 'default'], ...options], '')
            : new Choice(options, usual ?? choices[0]);
    }
    if (type === 'mesh') {
        return new MeshChoice(name, meshes());
    }
    if (isAngle(param)) {
        return new Angle(name, hintFor(param), param);
    }
    if (type === 'number' || type === 'integer') {
        return new Numeral(name, hintFor(param), type === 'integer' ? '1' : 'any');
    }
    if (type === 'matrix') {
        return matrix(name, (part, control) => pickable({ name: part, type: 'point' }, control));
    }
    if (type === 'matrix_projective') {
        return new Numbers(name, '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1', (numbers) => numbers);
    }
    if (type === 'polygon') {
        return polygon(name);
    }
    if (isPlace(param)) {
        return type === 'point' ? new Vector(name) : vectors(name);
    }
    const isMany = isList(param);
    return new Ids(name, {
        isList: isMany,
        isNullable: nullable,
        isSet: set,
        plural: isMany ? (param.plural ?? type) : undefined,
    });
}

// Returns whether the server chooses the value of a parameter that is not given.
function isChosenByServer({ default: usual, required, required_with: needed }) {
    return usual === undefined && !required && needed === undefined;
}

// Returns whether a parameter is an angle. The server takes it in radians, and the form in degrees.
function isAngle({ unit }) {
    return unit === 'radians';
}

// Returns how a value of a parameter is written in the form.
function written(value, param) {
    return isAngle(param) ? formatMeasure(degreesOf(value)) : `${value}`;
}

// Returns the placeholder of an empty number field: the default value, if it is known; else
// 'number' if the user must give one, or 'default' if the server chooses one.
function hintFor(param) {
    const { default: usual, required } = param;
    return usual === undefined ? (required ? 'number' : 'default') : written(usual, param);
}

// Returns whether a parameter may be given, where `selected` is the value of the operation's
// selector, a choice on which that depends.
export function isOpen({ with: values }, selected) {
    return values === undefined || values.includes(selected);
}

// Returns whether a parameter, or one of its alternatives, must be given.
function isNeeded({ required, required_with: values = [] }, selected) {
    return required || values.includes(selected);
}

// The largest whole number that the server takes. A limit that is as large is none to a user.
const LIMITLESS = 2147483646;

// Returns a note on a parameter: whether the value is a whole number or an angle, its range, and
// whether it may be left out.
export function marksOf(param, selected) {
    const { type, min, max, exclusive } = param;
    const marks = type === 'integer' ? ['whole'] : isAngle(param) ? ['degrees'] : [];
    if (max >= LIMITLESS) {
        marks.push(exclusive ? `more than ${min}` : `${min} or more`);
    } else if (min !== undefined || max !== undefined) {
        const between = exclusive ? 'between' : 'from';
        const write = type === 'integer' ? formatCount : (value) => written(value, param);
        const [least, most] = [min, max].map(write);
        marks.push(`${between} ${least} ${exclusive ? 'and' : 'to'} ${most}`);
    }
    if (!isNeeded(param, selected) && type !== 'flag') {
        marks.push('optional');
    }
    return marks.join(', ');
}

// Returns the first field that needs a value and has none, or undefined; `fields` are those of the
// parameters that may be given. If parameters are alternatives, which have the same `group`, a value
// for one of them is enough.
export function missingOf(fields, selected) {
    return fields.find(
        (field) =>
            isNeeded(field.param, selected) &&
            ![field, ...othersOf(field, fields)].some(({ control }) => control.isSaid),
    );
}

// Returns the fields of the alternatives to a field.
function othersOf({ param }, fields) {
    return fields.filter((other) => param.group !== undefined && other.param.group === param.group);
}

// Returns what to say beside a field that needs a value and has none.
export function wantOf(field, fields) {
    const { name, type } = field.param;
    const names = [...new Set([name, ...othersOf(field, fields).map(({ param }) => param.name)])];
    const choice = names.length > 1 ? `${names.slice(0, -1).join(', ')} or ${names.at(-1)}` : name;
    const kind = kindOf(field.param);
    const how = kind !== null ? ': type ids, or press Pick and click in the view' : '';
    return `Fill in ${choice}${type === 'mesh' ? ': choose a mesh' : how}.`;
}

// Returns [name, value], the member that a field adds to the request; the value is undefined if the
// field is empty. Missing values and ranges are not checked here: the server does that and explains
// what is wrong.
export function readField({ param, control }) {
    const value = control.read();
    if (value !== null && typeof value === 'object' && param.plural !== undefined) {
        return value.length === 1 ? [param.name, value[0]] : [param.plural, value];
    }
    return [param.name, value];
}

// Returns whether the pointer of a problem, such as /ops/0/faces/3, refers to this field.
export function isAbout({ param }, pointer) {
    const member = pointer.split('/')[3];
    return member !== undefined && (member === param.name || member === param.plural);
}
