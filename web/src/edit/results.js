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

// Returns what an edit has done: how many elements there were and are, and the numbers that the
// operation reports; null if there is nothing to say. `row` describes the operation, `result` is its
// member of the answer, `before` and `after` are the counts of the mesh; `before` is null if they are
// not known.
export function doneOf(row, { result, before, after }) {
    const changes = before === null ? [] : changesOf(before, after);
    const words = [...changes, ...numbersOf(row, result)];
    const text = words.join(', ');
    return text === '' ? null : `${text[0].toUpperCase()}${text.slice(1)}.`;
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

// Returns the results of an operation that are numbers or words, with their names.
function numbersOf({ results = [] } = {}, result = {}) {
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
