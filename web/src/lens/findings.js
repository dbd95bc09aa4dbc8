// findings.js - makes the groups of findings that the check lens lists from the server's
// answers. Pure.
//
// A group is {name, title, total, items, all}: `total` counts findings that the server does not
// list, too; `all` is the mend of all, see mends.js, or null. An item is
//
//   key         a name that stays the same while the mesh changes
//   text        what was found
//   place       where it is, in the mesh's own coordinates, or null
//   kind, ids   the elements that are selected when the item is opened; null if they are the faces
//   component   of a component, of which this is one
//   vertices    the vertices that the camera should see
//   normal      the direction from which they are seen, or null
//   mends       how it can be mended, the best way first

import { formatCount, formatMeasure, formatNumberOf } from '../kit/dom.js';
import { formatSize } from '../kit/units.js';
import { hasVertex, pointAt } from '../geometry/geometry.js';
import { cornersOf, isFlat, lengthOf, normalOf, placeOf } from './places.js';
import { mendOfAll, mendsOfComponent, mendsOfDefect, mendsOfLoop } from './mends.js';

// By name of the group, its title.
const TITLES = {
    problems: 'Broken invariants',
    loops: 'Boundary loops',
    components: 'Components',
    bowtie: 'Bow-ties',
    isolated_vertex: 'Isolated vertices',
    duplicate_position: 'Vertices in the same place',
    zero_length_edge: 'Edges without length',
    degenerate_face: 'Faces without area',
    nonplanar_face: 'Faces that are not flat',
    small_component: 'Small components',
    inside_out_component: 'Components inside out',
    self_intersection: 'Faces that intersect',
};

const DIGITS = 4;

const COMPONENT_CODES = ['small_component', 'inside_out_component'];

const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}`;

// Returns the elements whose members the groups need, {kind, id} each.
export function elementsOf({ defects, problems }) {
    return [...problems, ...defects]
        .filter(({ kind, code }) => kind === 'edge' || kind === 'halfedge' || code === 'degenerate_face')
        .map(({ kind, id }) => ({ kind, id }));
}

// Returns the groups. `answers` has the answers of the server: {check, loops, components, elements},
// where `elements` maps "kind:id" to the element. `isTriangles` says that all faces are triangles.
export function groupsOf(geometry, { check, loops, components, elements }, isTriangles) {
    const codes = Object.keys(check.totals).filter((code) => code !== 'problems');
    const groupOf = (name, found, items, total = found.length) => ({
        name,
        title: TITLES[name] ?? sentence(name.replaceAll('_', ' ')),
        total,
        items,
        all: mendOfAll(name, found, isTriangles, check.thresholds),
    });
    const defectsOf = (code) => check.defects.filter((defect) => defect.code === code);
    const listed = (name, found, total) =>
        groupOf(name, found, found.map((one) => itemOf(geometry, name, one, elements)), total);
    const sized = loops.map((loop) => ({ ...loop, size: sizeOf(geometry, loop) }));
    sized.sort((a, b) => b.size - a.size);
    const byFaces = [...components].sort((a, b) => b.faces - a.faces);
    return [
        listed('problems', check.problems, check.totals.problems),
        ...codes.map((code) => listed(code, defectsOf(code), check.totals[code])),
        groupOf('loops', sized, sized.map((loop) => itemOfLoop(geometry, loop, isTriangles))),
        groupOf('components', byFaces, byFaces.map((one) => itemOfComponent(geometry, one))),
    ].filter(({ total }) => total > 0);
}

function sizeOf(geometry, { vertices }) {
    return vertices.every((id) => hasVertex(geometry, id)) ? lengthOf(geometry, vertices) : 0;
}

function itemOfLoop(geometry, loop, isTriangles) {
    const { halfedge, halfedges, vertices, length, size } = loop;
    return {
        key: `loops:${halfedge}`,
        text: `${formatNumberOf(length, 'edge')}, perimeter ${formatSize(size, 1, DIGITS)}`,
        place: placeOf(geometry, vertices),
        kind: 'halfedge',
        ids: halfedges,
        vertices,
        normal: size > 0 ? normalOf(geometry, vertices) : null,
        mends: mendsOfLoop(loop, isTriangles || (size > 0 && !isFlat(geometry, vertices))),
    };
}

function itemOfComponent(geometry, component) {
    const { face, faces, vertices: count } = component;
    const vertices = cornersOf(geometry, [face]);
    return {
        key: `components:${face}`,
        text: `${formatNumberOf(faces, 'face')}, ${formatNumberOf(count, 'vertex', 'vertices')}`,
        place: placeOf(geometry, vertices),
        kind: 'face',
        ids: null,
        component: face,
        vertices,
        normal: null,
        mends: mendsOfComponent(component),
    };
}

// Returns the item of a defect or of a broken invariant, as the server sent it.
function itemOf(geometry, name, defect, elements) {
    const { kind, id, other, detail, rule } = defect;
    const element = elements.get(`${kind}:${id}`);
    const ids = other === undefined ? [id] : [other, id];
    const vertices = ids.flatMap((one) => verticesOf(geometry, kind, one, element));
    const isComponent = COMPONENT_CODES.includes(name);
    const lengths = name === 'degenerate_face' ? sidesOf(geometry, element) : [];
    return {
        key: `${name}:${rule ?? ''}${ids.join()}`,
        text: rule === undefined ? `${sentence(detail)}.` : `${rule}: ${detail}.`,
        place: placeOf(geometry, vertices),
        kind,
        ids: isComponent ? null : ids,
        component: isComponent ? id : undefined,
        vertices,
        normal: null,
        mends: rule === undefined ? mendsOfDefect(defect, element, lengths) : [],
    };
}

function verticesOf(geometry, kind, id, element) {
    if (kind === 'vertex') {
        return [id];
    }
    return kind === 'face'
        ? cornersOf(geometry, [id])
        : (element?.vertices ?? [element?.origin, element?.target].filter((one) => one >= 0));
}

// Returns the lengths of the sides of a face, in view coordinates.
function sidesOf(geometry, face) {
    const vertices = face?.vertices ?? [];
    return vertices.map((from, i) => {
        const [a, b] = [from, vertices[(i + 1) % vertices.length]].map((id) => pointAt(geometry, id));
        return Math.hypot(...a.map((value, axis) => b[axis] - value));
    });
}

// Returns what was found in one sentence. `groups` are those of groupsOf().
export function summaryOf(groups, isComplete) {
    const totalOf = (name) => groups.find((group) => group.name === name)?.total ?? 0;
    const defects = groups
        .filter(({ name }) => name !== 'loops' && name !== 'components')
        .reduce((sum, { total }) => sum + total, 0);
    const words = [
        defects === 0 ? 'No defects' : formatNumberOf(defects, 'defect'),
        totalOf('loops') === 0 ? 'no boundary' : formatNumberOf(totalOf('loops'), 'boundary loop'),
        formatNumberOf(totalOf('components'), 'component'),
    ];
    const more = isComplete ? '' : ' There may be more faces that intersect.';
    return `${words.join(', ')}.${more}`;
}

// Returns a place as in "at 0.5, 0, 1".
export function wordsOfPlace(place) {
    return place === null
        ? ''
        : `at ${place.map((value) => formatMeasure(value, DIGITS)).join(', ')}`;
}

// Returns how many findings of a group are not listed, in a sentence; '' if all are.
export function restOf({ total, items }) {
    return total > items.length
        ? `The server lists the first ${formatCount(items.length)} of ${formatCount(total)}.`
        : '';
}
