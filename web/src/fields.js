// fields.js - what a parameter of an operation looks like in a form, and what its text means.

import { Problem } from './api.js';
import { make } from './dom.js';

export const PLURALS = { vertices: 'vertex', halfedges: 'halfedge', edges: 'edge', faces: 'face' };
export const KINDS = Object.values(PLURALS);

const HINTS = {
    point: 'x y z',
    points: 'x y z, one or more',
    matrix: '16 numbers',
};

// Those filled with the place of a vertex that is clicked.
const PLACES = ['point', 'points'];

// The kind of element that a click gives a parameter, null where clicks give nothing.
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

// Does it take several elements?
export function isList({ plural, type }) {
    return plural !== undefined || type in PLURALS;
}

// `meshes()` gives the list of meshes, as a promise.
export function inputFor(param, meshes) {
    if (param.type === 'flag') {
        return make('input', { type: 'checkbox', checked: param.default === true });
    }
    if (param.type === 'choice') {
        const options = param.choices.map((choice) => make('option', { value: choice }, choice));
        const select = make('select', {}, ...options);
        select.value = param.default ?? param.choices[0];
        return select;
    }
    if (param.type === 'mesh') {
        const select = make('select', {}, make('option', { value: '' }, 'which mesh'));
        meshes().then((items) => {
            select.append(
                ...items.map(({ id, name }) => make('option', { value: id }, name || id)),
            );
        });
        return select;
    }
    const input = make('input', { type: 'text', autocomplete: 'off', spellcheck: false });
    input.placeholder = hintFor(param);
    return input;
}

// What stands in an empty field. A number that is left out is the server's to choose.
function hintFor({ type, default: usual, required, nullable }) {
    if (type === 'number') {
        return usual === undefined ? (required ? 'number' : 'left out') : `${usual}`;
    }
    return HINTS[type] ?? (nullable ? 'id or none' : 'id');
}

// Is something said, or does the parameter need nothing said? Of a group one is enough.
export function isComplete(fields) {
    const isSaid = ({ param, input }) =>
        param.type === 'flag' || param.nullable || input.value.trim() !== '';
    return fields.every(
        (field) =>
            !field.param.required ||
            isSaid(field) ||
            fields.some(
                (other) =>
                    field.param.group !== undefined &&
                    other.param.group === field.param.group &&
                    isSaid(other),
            ),
    );
}

// [member, value] of a field; undefined where it is left out. The server judges what is missing or
// out of range: it knows better and says why.
export function readField({ param, input }) {
    const { name, type } = param;
    if (type === 'flag') {
        return [name, input.checked];
    }
    const text = input.value.trim();
    if (type === 'choice') {
        return [name, text];
    }
    if (text === '') {
        return [name, param.nullable ? null : undefined];
    }
    if (type === 'mesh') {
        return [name, text];
    }
    if (param.nullable && text === 'none') {
        return [name, null];
    }
    const numbers = text
        .split(/[\s,;]+/)
        .filter((word) => word !== '')
        .map((word) => toNumber(word, name));
    if (type === 'points') {
        const points = [];
        for (let i = 0; i < numbers.length; i += 3) {
            points.push(numbers.slice(i, i + 3));
        }
        return [name, points.length === 1 ? points[0] : points];
    }
    if (type === 'point' || type === 'matrix' || type in PLURALS) {
        return [name, numbers];
    }
    if (numbers.length === 1) {
        return [name, numbers[0]];
    }
    if (param.plural === undefined) {
        throw new Problem({
            title: 'One number',
            detail: `${name} is one number, not \u201c${text}\u201d.`,
        });
    }
    return [param.plural, numbers];
}

// Digits as people write them: what else JavaScript reads, such as 0x10, is a slip.
function toNumber(word, name) {
    const value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(word) ? Number(word) : NaN;
    if (!Number.isFinite(value)) {
        throw new Problem({
            title: 'Not a number',
            detail: `${name}: \u201c${word}\u201d is not a number.`,
        });
    }
    return value;
}

// The text of a list of ids with one more, or without it where it was in there.
export function toggleWord(text, word) {
    const words = text.split(/[\s,;]+/).filter((one) => one !== '');
    const others = words.filter((one) => one !== `${word}`);
    return (others.length < words.length ? others : [...words, word]).join(' ');
}
