// imported.js - says in sentences what an import has repaired and what it warns of. Pure.
//
// Each sentence is {text, elements}; `elements` has groups {kind, ids, more} of the elements of the
// mesh that the sentence is about, where `more` is the number of elements that are not listed.

import { PLURALS } from '../geometry/kinds.js';
import { formatCount, formatNumberOf } from '../kit/dom.js';

// A sentence lists at most this many numbers of the file.
const MOST = 12;

const count = (number, kind) => formatNumberOf(number, kind, PLURALS[kind]);

const group = (kind, ids = [], total = ids.length) => ({ kind, ids, more: total - ids.length });

const unique = (ids = []) => [...new Set(ids)];

// By name of the repair, the sentences for what it did. Numbers of deleted elements are those of
// the file, so they are given as text.
const REPAIRS = {
    weld: ({ count: number, tolerance, into, moved, ...placed }) => [
        number > 0 && {
            text:
                `Merged ${count(number, 'vertex')} into others ` +
                `${tolerance === 0 ? 'at the same place' : `at most ${tolerance} away`}` +
                `${placeOf(number, placed)}.`,
            elements: [group('vertex', unique(into))],
        },
        moved > 0 && {
            text:
                `${formatNumberOf(moved, 'value')} of merged vertices differed, ` +
                'and became values of corners.',
            elements: [],
        },
    ],
    drop_degenerate: ({ count: number, mended, faces, ...placed }) => [
        number > 0 && {
            text: `Dropped ${count(number, 'face')} without area${placeOf(number, placed)}.`,
            elements: [],
        },
        mended > 0 && {
            text:
                `Took corners out of ${count(mended, 'face')} that used a vertex twice, ` +
                `or cut them into triangles${numbersOf('face', faces, mended)}.`,
            elements: [],
        },
    ],
    drop_duplicates: ({ count: number, into, ...placed }) => [
        number > 0 && {
            text:
                `Dropped ${count(number, 'face')} with the same corners as others` +
                `${placeOf(number, placed)}.`,
            elements: [group('face', unique(into))],
        },
    ],
    orient: ({ count: number, components, faces, not_orientable: cut, clashes }) => [
        number > 0 && {
            text:
                `Turned over ${count(number, 'face')} in ${formatNumberOf(components, 'component')}, ` +
                'so that neighbours look the same way.',
            elements: [group('face', faces, number)],
        },
        cut > 0 && {
            text: `Cut ${formatNumberOf(cut, 'component')} that cannot be oriented.`,
            elements: [group('face', clashes, cut)],
        },
    ],
    split: ({ count: number, vertices, parents }) => [
        number > 0 && {
            text:
                `Split ${count(vertices, 'vertex')} where the surface did not fit together, ` +
                `which made ${formatNumberOf(number, 'new vertex', 'new vertices')}.`,
            elements: [group('vertex', unique(parents.vertices.flat()), number + vertices)],
        },
    ],
    fill: ({ count: number, hole_edges: most, faces, left }) => [
        number > 0 && {
            text: `Filled ${formatNumberOf(number, 'hole')} of at most ${formatNumberOf(most, 'edge')}.`,
            elements: [group('face', faces, number)],
        },
        left > 0 && {
            text: `Left ${formatNumberOf(left, 'boundary loop')} open.`,
            elements: [],
        },
    ],
};

// Returns where in the file something was, `number` times, as in " (lines 4 and 7 of the file)".
function placeOf(number, { lines, bytes }) {
    return lines === undefined ? numbersOf('byte', bytes, number) : numbersOf('line', lines, number);
}

// Returns numbers in the file as in " (faces 1, 4 and 12 more of the file)"; '' without numbers.
function numbersOf(name, numbers = [], total) {
    if (numbers.length === 0) {
        return '';
    }
    const listed = numbers.slice(0, MOST).map(formatCount);
    const more = Math.max(total, numbers.length) - listed.length;
    const words = more > 0 ? [...listed, `${formatCount(more)} more`] : listed;
    const last = words.pop();
    const all = words.length === 0 ? last : `${words.join(', ')} and ${last}`;
    return ` (${name}${numbers.length > 1 ? 's' : ''} ${all} of the file)`;
}

// Returns the sentences for what a repair did; a sentence that says so if it changed nothing.
function repairOf(repair) {
    const sentences = REPAIRS[repair.repair]?.(repair).filter(Boolean) ?? [];
    return sentences.length > 0
        ? sentences
        : [{ text: `The repair ${repair.repair} found nothing to do.`, elements: [] }];
}

function warningOf({ detail, count: number, vertices, ...placed }) {
    const begin = `${detail[0].toUpperCase()}${detail.slice(1)}`;
    const isCounted = number < 2 || vertices !== undefined || / times\b/.test(detail);
    const times = isCounted ? '' : ` (${formatCount(number)} times)`;
    return {
        text: `${begin}${times}${placeOf(number, placed)}.`,
        elements: vertices === undefined ? [] : [group('vertex', vertices, number)],
    };
}

// Returns {repairs, warnings}, two lists of sentences, for the report of an import.
export function sentencesOf({ repairs = [], warnings = [], more_warnings: more = 0 }) {
    const rest = {
        text: `${formatNumberOf(more, 'more warning is', 'more warnings are')} not listed.`,
        elements: [],
    };
    return {
        repairs: repairs.flatMap(repairOf),
        warnings: [...warnings.map(warningOf), ...(more > 0 ? [rest] : [])],
    };
}

// Returns how many repairs and warnings a report has, as in "3 repairs, 1 warning"; '' if none.
export function tallyOf({ repairs = [], warnings = [], more_warnings: more = 0 }) {
    const tally = [
        ['repair', repairs.length],
        ['warning', warnings.length + more],
    ];
    return tally
        .filter(([, number]) => number > 0)
        .map(([name, number]) => formatNumberOf(number, name))
        .join(', ');
}
