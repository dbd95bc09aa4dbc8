// lineage.js - which elements replaced elements that are gone, as far as edits reported it. Pure.

// Maximum number of entries of each map; the oldest are forgotten.
const MOST = 10000;

const KINDS = { vertices: 'vertex', edges: 'edge', faces: 'face' };

export class Lineage {
    #merged = new Map(); // 'face:3' -> the id of the face into which it was merged
    #parents = new Map(); // 'face:3' -> the id of the face from which it was split

    // Records the answer to an edit, or its event: `merged` and `parents` are {faces: [[of, id]],
    // ...}.
    note({ merged = {}, parents = {} }) {
        for (const [map, told] of [[this.#merged, merged], [this.#parents, parents]]) {
            for (const [plural, pairs] of Object.entries(told)) {
                for (const [id, other] of pairs) {
                    put(map, `${KINDS[plural]}:${id}`, other);
                }
            }
        }
    }

    // Returns the element that replaced one that is gone: {kind, id}, or null. A half-edge follows
    // its edge.
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
