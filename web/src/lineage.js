// lineage.js - what elements that are gone came from or went into, as far as edits have told. Pure.

// Of each, the oldest are forgotten.
const MOST = 10000;

const KINDS = { vertices: 'vertex', edges: 'edge', faces: 'face' };

export class Lineage {
    #merged = new Map(); // 'face:3' -> the id of the face it is part of now
    #parents = new Map(); // 'face:3' -> the id of the face it was cut from

    // An answer to an edit, or its event: `merged` and `parents` are {faces: [[of, id]], ...}.
    note({ merged = {}, parents = {} }) {
        for (const [map, told] of [[this.#merged, merged], [this.#parents, parents]]) {
            for (const [plural, pairs] of Object.entries(told)) {
                for (const [id, other] of pairs) {
                    put(map, `${KINDS[plural]}:${id}`, other);
                }
            }
        }
    }

    // Where an element that is gone is to be found: {kind, id}, or null. A half-edge went where its
    // edge did.
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
