// defects.js - says in plain words what is wrong with a file or a mesh, and what the repairs of an
// import do and have done. Pure.

import { formatCount } from '../kit/dom.js';

// By the code of a refusal, of a warning or of a finding of a check: what one place is, what several
// places are.
export const DEFECTS = {
    repeated_corner: ['face uses a vertex twice', 'faces use a vertex twice'],
    too_few_corners: ['face has fewer than three corners', 'faces have fewer than three corners'],
    nonmanifold_edge: ['edge has more than two faces', 'edges have more than two faces'],
    orientation: [
        'edge lies between faces that disagree about which side is out',
        'edges lie between faces that disagree about which side is out',
    ],
    not_orientable: ['part has no inside, like a M\u00f6bius band', 'parts have no inside'],
    doubled_edge: [
        'pair of vertices is joined by two edges',
        'pairs of vertices are joined by two edges',
    ],
    closed_fan: [
        'vertex joins surfaces that only touch there',
        'vertices join surfaces that only touch there',
    ],
    bowtie: ['vertex joins parts that only touch there', 'vertices join parts that only touch there'],
    isolated_vertices: ['vertex belongs to no face', 'vertices belong to no face'],
    open_seams: [
        'edge lies on another edge without being joined to it',
        'edges lie on other edges without being joined to them',
    ],
    duplicate_position: [
        'vertex lies in the same place as another',
        'vertices lie in the same place as others',
    ],
    zero_length_edge: ['edge has no length', 'edges have no length'],
    degenerate_face: ['face has no area', 'faces have no area'],
    inside_out_component: ['part is inside out', 'parts are inside out'],
    open_border: ['hole or open border', 'holes or open borders'],
};

// The repairs that mend a defect of a mesh that was imported, by its code.
const MENDERS = {
    open_seams: 'weld',
    duplicate_position: 'weld',
    bowtie: 'split',
};

// By name of a repair: what it does, and how. Others are shown by their names.
const REPAIRS = {
    weld: [
        'Join vertices in the same place',
        'Closes seams between faces that only lie side by side. Seams of textures stay.',
    ],
    drop_degenerate: [
        'Mend faces that use a vertex twice',
        'Keeps the parts of these faces that have an area. A face without any is removed.',
    ],
    drop_duplicates: ['Remove repeated faces', 'Of faces with the same corners, the first one stays.'],
    orient: [
        'Turn faces so that they agree',
        'Turns the fewer faces of each part, until neighbours agree about which side is out.',
    ],
    split: [
        'Separate surfaces that only touch',
        'Where more than two faces share an edge, or parts meet in a vertex, each gets vertices of its own.',
    ],
    fill: ['Close small holes', 'Each hole gets one polygon.'],
};

// Returns "1 face" or "3 faces".
function tally(count, one, many) {
    return `${formatCount(count)} ${count === 1 ? one : many}`;
}

function wordsFor(code, count) {
    const [one, many] = DEFECTS[code] ?? [code.replaceAll('_', ' '), code.replaceAll('_', ' ')];
    return tally(count, one, many);
}

// Returns what is wrong with a file that was refused, {text, where, more} for each kind of defect:
// a sentence, the places in the words of the server, and how many places are not listed.
export function defectsOf({ elements, total, detail }) {
    const byCode = new Map();
    for (const { code, detail: place } of elements) {
        byCode.set(code, [...(byCode.get(code) ?? []), place]);
    }
    const hidden = Math.max(total - elements.length, 0);
    const found = [...byCode].map(([code, where]) => ({
        text: wordsFor(code, where.length),
        where,
        more: 0,
    }));
    if (found.length === 0) {
        return [{ text: detail, where: [], more: 0 }];
    }
    if (hidden > 0) {
        found.push({ text: `${formatCount(hidden)} more places`, where: [], more: 0 });
    }
    return found.map((one, i) => (i === 0 ? { ...one, where: [...placed(detail), ...one.where] } : one));
}

// The line or byte of the file at which the first defect is, if the refusal names it.
function placed(detail) {
    const [place] = /^(line|byte) \d+/.exec(detail) ?? [];
    return place === undefined ? [] : [`first at ${place} of the file`];
}

// Returns what is wrong with a mesh that was imported, as defectsOf() does, and with `mender`, the
// repair that mends it, or undefined. `check` is the answer of GET .../check, or null.
export function defectsIn({ counts, import: report }, check) {
    const warned = (report?.warnings ?? [])
        .filter(({ code }) => code in DEFECTS)
        .map(({ code, count, line, vertices = [] }) => ({
            code,
            count,
            where: [
                ...(line === undefined ? [] : [`first at line ${line} of the file`]),
                ...vertices.map((id) => `vertex ${id}`),
            ],
        }));
    const isNew = ([code, count]) =>
        count > 0 && code in DEFECTS && !warned.some((one) => sameOf(one.code) === sameOf(code));
    const checked = Object.entries(check?.totals ?? {})
        .filter(isNew)
        .map(([code, count]) => ({
            code,
            count,
            where: check.defects.filter((one) => one.code === code).map(({ detail }) => detail),
        }));
    const loops = counts.boundary_loops;
    const open = loops > 0 ? [{ code: 'open_border', count: loops, where: [] }] : [];
    return [...warned, ...checked, ...open].map(({ code, count, where }) => ({
        code,
        text: wordsFor(code, count),
        where,
        more: where.length === 0 ? 0 : Math.max(count - where.length, 0),
        mender: MENDERS[code],
    }));
}

// A check calls one defect by another code than an import does, and vertices in the same place are
// the ends of open seams.
function sameOf(code) {
    return { isolated_vertex: 'isolated_vertices', duplicate_position: 'open_seams' }[code] ?? code;
}

// Returns [label, doc], what a repair does.
export function repairWords(name) {
    return REPAIRS[name] ?? [name.replaceAll('_', ' '), ''];
}

// Returns what a repair has done, from its report in the answer to an import.
export function doneBy(report) {
    const { repair, count } = report;
    const parts = {
        weld: () => [[count, 'vertex joined to another', 'vertices joined to others']],
        drop_degenerate: () => [
            [count, 'face removed', 'faces removed'],
            [report.mended, 'face mended', 'faces mended'],
        ],
        drop_duplicates: () => [[count, 'face removed', 'faces removed']],
        orient: () => [
            [count, 'face turned', 'faces turned'],
            [report.not_orientable, 'part has no inside', 'parts have no inside'],
        ],
        split: () => [[count, 'vertex made', 'vertices made']],
        fill: () => [
            [count, 'hole closed', 'holes closed'],
            [report.left, 'left open', 'left open'],
        ],
    }[repair] ?? (() => [[count, 'change', 'changes']]);
    const words = parts()
        .filter(([number]) => number > 0)
        .map(([number, one, many]) => tally(number, one, many));
    return words.length === 0 ? 'nothing to do' : `${words.join(', ')}${linesOf(report)}`;
}

const MOST_LINES = 6;

function linesOf({ lines = [] }) {
    if (lines.length === 0) {
        return '';
    }
    const more = lines.length > MOST_LINES ? ', \u2026' : '';
    const word = lines.length === 1 ? 'line' : 'lines';
    return ` (${word} ${lines.slice(0, MOST_LINES).join(', ')}${more})`;
}

// Returns the sizes of a mesh in words, such as "8 vertices, 6 faces, closed".
export function sizesOf({ counts, closed }) {
    const parts = [
        tally(counts.vertices, 'vertex', 'vertices'),
        tally(counts.faces, 'face', 'faces'),
    ];
    if (counts.components > 1) {
        parts.push(`${formatCount(counts.components)} parts`);
    }
    const { boundary_loops: loops } = counts;
    parts.push(closed && loops === 0 ? 'closed' : wordsFor('open_border', loops));
    return parts.join(', ');
}
