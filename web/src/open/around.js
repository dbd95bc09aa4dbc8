// around.js - reads what is shown about an element in addition to its own members. Pure except for
// the parameter `ask`, a function that sends the server a list of questions and returns the answers
// in order.
//
//   rings      [{name, kind, ids}]   the neighbours, in the server's order
//   measures   [{name, value, power}]   such as a length or an angle, as text without a unit; `power`
//                                    is 1 for lengths, see units.js, and missing for angles
//   halfedges  [{id, origin, target, face, across, role}]: half-edges to draw as arrows; `across`
//              is the face of the twin, `role` says what the half-edge is to a selected one:
//              'self', 'next', 'prev', 'twin', or 'near' for all others

import { angleBetween, cross, dot, subtract } from '../geometry/vectors.js';
import { formatMeasure } from '../kit/dom.js';
import { formatAngle } from '../kit/lengths.js';

// The largest number of arrows that are drawn for one selection.
const MOST = 64;

// Returns the angle between the normals of the faces left and right of an edge: positive on a
// ridge, null if a face has no area.
export function foldAngle(left, right, direction) {
    const angle = angleBetween(left, right);
    return angle !== null && dot(cross(left, right), direction) < 0 ? -angle : angle;
}

// Returns an angle as a measure to show, in a list that is empty if there is none (null).
const angles = (name, angle) => (angle === null ? [] : [{ name, value: formatAngle(angle) }]);

// Returns whether `answer` is no error. A question to the server fails if the element that it asks
// about was deleted meanwhile.
const lives = (answer) => answer !== undefined && !('status' in answer);

async function ids(ask, relations, of) {
    const answers = await ask(relations.map((relation) => ({ relation, of })));
    return answers.map((answer) => (lives(answer) ? answer.ids : []));
}

// Reads the half-edges that are to be drawn as arrows; `roles` is a map from the ids of half-edges
// to their roles (see the top of this file).
async function halfedgesOf(ask, roles) {
    const wanted = [...roles.keys()].slice(0, MOST);
    const answers = await ask(
        wanted.flatMap((id) => [{ get: { halfedge: id } }, { get: { halfedge: id ^ 1 } }]),
    );
    return wanted
        .map((id, i) => [answers[2 * i], answers[2 * i + 1], roles.get(id)])
        .filter(([halfedge, twin]) => lives(halfedge) && lives(twin))
        .map(([{ id, origin, target, face }, twin, role]) => {
            return { id, origin, target, face, across: twin.face, role };
        });
}

// Returns a map from ids of half-edges to their roles. Each group is [role, ids]; an id that is in
// several groups gets the role of the first.
function rolesOf(...groups) {
    const roles = new Map();
    for (const [role, list] of groups) {
        for (const id of list) {
            if (!roles.has(id)) {
                roles.set(id, role);
            }
        }
    }
    return roles;
}

const withTwins = (list) => list.flatMap((id) => [id, id ^ 1]);

const readers = {
    async vertex({ id }, ask) {
        const of = { vertex: id };
        const [outgoing, vertices, faces] = await ids(ask, ['outgoing', 'vertices', 'faces'], of);
        return {
            rings: [
                { name: 'outgoing', kind: 'halfedge', ids: outgoing },
                { name: 'vertices', kind: 'vertex', ids: vertices },
                { name: 'faces', kind: 'face', ids: faces },
            ],
            measures: [],
            halfedges: await halfedgesOf(ask, rolesOf(['near', withTwins(outgoing)])),
        };
    },

    async halfedge({ id, next, prev, twin, origin, target, edge }, ask) {
        const of = { halfedge: id };
        const [loop, ring] = await ids(ask, ['loop', 'ring'], of);
        const [from, to, before, whole] = await ask([
            { get: { vertex: origin } },
            { get: { vertex: target } },
            { get: { halfedge: prev } },
            { get: { edge } },
        ]);
        const measures = [];
        if (lives(whole)) {
            measures.push({ name: 'length', value: formatMeasure(whole.length), power: 1 });
        }
        if ([from, to, before].every(lives)) {
            const [behind] = await ask([{ get: { vertex: before.origin } }]);
            const sides = [to, behind].map((v) => subtract(v.position, from.position));
            measures.push(...angles('angle', angleBetween(...sides)));
        }
        return {
            rings: [
                { name: 'loop', kind: 'halfedge', ids: loop },
                { name: 'ring', kind: 'halfedge', ids: ring },
            ],
            measures,
            halfedges: await halfedgesOf(
                ask,
                rolesOf(['self', [id]], ['next', [next]], ['prev', [prev]], ['twin', [twin]],
                    ['near', loop]),
            ),
        };
    },

    async edge({ halfedges, vertices, faces }, ask) {
        const measures = [];
        if (!faces.includes(null)) {
            const [left, right, from, to] = await ask([
                ...faces.map((face) => ({ get: { face } })),
                ...vertices.map((vertex) => ({ get: { vertex } })),
            ]);
            if ([left, right, from, to].every(lives)) {
                const direction = subtract(to.position, from.position);
                const fold = foldAngle(left.normal, right.normal, direction);
                measures.push(...angles('fold angle', fold));
            }
        }
        return {
            rings: [],
            measures,
            halfedges: await halfedgesOf(ask, rolesOf(['near', halfedges])),
        };
    },

    async face({ id, halfedges }, ask) {
        const [faces] = await ids(ask, ['faces'], { face: id });
        return {
            rings: [{ name: 'faces', kind: 'face', ids: faces }],
            measures: [],
            halfedges: await halfedgesOf(ask, rolesOf(['near', withTwins(halfedges)])),
        };
    },
};

export function describe(kind, element, ask) {
    return readers[kind](element, ask);
}
