// lineage.js - remembers which elements have replaced deleted elements, as far as edits have
// reported it. Pure.

import { KIND_OF } from '../geometry/kinds.js';

// The maximum number of entries in each map of replaced elements; beyond it the oldest entries are
// dropped.
const MOST = 10000;

export class Lineage {
    #merged = new Map(); // 'face:3' -> the id of the face into which it was merged
    #parents = new Map(); // 'face:3' -> the id of the face from which it was split

    // Records what an edit reported, in its answer or its event: `merged` and `parents` are {faces:
    // [[id, other], ...], edges: ..., vertices: ...}, where `other` is the id of the element into
    // which `id` was merged, or from which it was split.
    note({ merged = {}, parents = {} }) {
        for (const [map, told] of [[this.#merged, merged], [this.#parents, parents]]) {
            for (const [plural, pairs] of Object.entries(told)) {
                for (const [id, other] of pairs) {
                    put(map, `${KIND_OF[plural]}:${id}`, other);
                }
            }
        }
    }

    // Returns the element that replaced a deleted element, {kind, id}, or null. If the deleted
    // element is a half-edge, this is the edge that replaced the half-edge's edge.
    heirOf({ kind, id }) {
        const [whole, at] = kind === 'halfedge' ? ['edge', Math.floor(id / 2)] : [kind, id];
        const key = `${whole}:${at}`;
        const heir = this.#merged.get(key) ?? this.#parents.get(key);
        return heir === undefined ? null : { kind: whole, id: heir };
    }
}

function put(map, key, value) {
    map.delete(key);
    map.set(key, value);
    if (map.size > MOST) {
        map.delete(map.keys().next().value);
    }
}
