// results.js - says in words what an edit has done. Pure.

import { formatCount, formatMeasure, formatNumberOf } from '../kit/dom.js';
import { formatAngle } from '../kit/lengths.js';

const KINDS = [
    ['faces', 'face', 'faces'],
    ['vertices', 'vertex', 'vertices'],
    ['edges', 'edge', 'edges'],
];

// The number of digits with which results are shown.
const DIGITS = 3;

// Why the operation `fill_holes` leaves holes open, by the member of its result that counts them.
const LEFT = {
    large: 'too large',
    touching: 'touching itself',
    single: 'around a single face',
    doubled: 'between edges that exist already',
};

// Returns how many holes an operation leaves open, in a sentence; '' if none. `result` is its member
// of the answer.
export function openOf({ left = [], ...counts }) {
    if (left.length === 0) {
        return '';
    }
    const reasons = Object.entries(LEFT)
        .filter(([name]) => counts[name] > 0)
        .map(([name, words]) => `${words}: ${formatCount(counts[name])}`);
    const stays = left.length === 1 ? 'stays' : 'stay';
    return `${formatNumberOf(left.length, 'hole')} ${stays} open (${reasons.join(', ')}).`;
}

// Returns what an edit has done: how many elements there were and are, and the numbers that the
// operation reports; null if there is nothing to say. `row` describes the operation, `result` is its
// member of the answer, `before` and `after` are the counts of the mesh; `before` is null if they are
// not known.
export function doneOf(row, { result = {}, before, after }) {
    const changes = before === null ? [] : changesOf(before, after);
    const isSaid = ({ name }) =>
        isRepeated(result[name], name, { before, after }) || ('left' in result && name in LEFT);
    const others = row?.results.filter((one) => !isSaid(one)) ?? [];
    const text = [...changes, ...numbersOf(others, result)].join(', ');
    const open = openOf(result);
    const end = open === '' ? '' : ` ${open}`;
    return text === '' ? null : `${text[0].toUpperCase()}${text.slice(1)}.${end}`;
}

// Returns the numbers of elements before and after an edit, of those kinds whose number has changed;
// of the edges only if nothing else has changed, because their number follows from the others.
function changesOf(before, after) {
    const changed = KINDS.filter(([plural]) => before[plural] !== after[plural]);
    const shown = changed.length > 1 ? changed.filter(([plural]) => plural !== 'edges') : changed;
    return shown.map(
        ([plural, one, many]) =>
            `${formatCount(before[plural])} to ${formatNumberOf(after[plural], one, many)}`,
    );
}

// Returns whether a result, such as faces_after, is a number of elements of the whole mesh, which
// changesOf() has said.
function isRepeated(value, name, counts) {
    const [, kind, when] = /^(.*)_(before|after)$/.exec(name) ?? [];
    return when !== undefined && counts.before !== null && value === counts[when][kind];
}

// Returns those results of an operation that are numbers or words, with their names. `results` are the
// rows of the results in the server's table.
function numbersOf(results, result) {
    return results.flatMap(({ name, type, unit }) => {
        const value = result[name];
        const words = name.replaceAll('_', ' ');
        if (unit === 'radians' && typeof value === 'number') {
            return [`${words} ${formatAngle(value, DIGITS)}`];
        }
        if (type === 'number' && typeof value === 'number') {
            const isCount = Number.isInteger(value);
            return [`${words} ${isCount ? formatCount(value) : formatMeasure(value, DIGITS)}`];
        }
        const isChoice = type === 'choice' && typeof value === 'string';
        return isChoice ? [`${words}: ${value.replaceAll('_', ' ')}`] : [];
    });
}
