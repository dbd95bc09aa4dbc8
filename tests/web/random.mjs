// random.mjs - makes random edits; equal seeds make equal edits.

// Returns a function that returns pseudo-random numbers below n (Marsaglia, "Xorshift RNGs", 2003).
export function numbersFrom(seed) {
    let state = seed >>> 0 || 1;
    return (n) => {
        state ^= state << 13;
        state ^= state >>> 17;
        state ^= state << 5;
        state >>>= 0;
        return Math.floor((state / 2 ** 32) * n);
    };
}

// Returns a random edit of random elements; the server may refuse it. `below(n)` returns a random
// number below n, and `issued` has an upper bound of the ids of each kind of element.
export function randomEdit(below, issued) {
    const id = (kind) => below(issued[kind]);
    const by = [0, 1, 2].map(() => (below(200) - 100) / 2000);
    return [
        () => ({ op: 'face_poke', face: id('faces') }),
        () => ({ op: 'edge_split', edge: id('edges') }),
        () => ({ op: 'edge_flip', edge: id('edges') }),
        () => ({ op: 'edge_collapse', edge: id('edges') }),
        () => ({ op: 'face_join', edge: id('edges') }),
        () => ({ op: 'face_delete', face: id('faces') }),
        () => ({ op: 'vertex_move', vertex: id('vertices'), by }),
        () => ({ op: 'vertex_add', position: by }),
    ][below(8)]();
}

// Raises the upper bounds of ids in `issued` by the elements that an answer says were created.
export function countIssued(issued, { created }) {
    for (const kind of Object.keys(issued)) {
        issued[kind] = created[kind].reduce((most, id) => Math.max(most, id + 1), issued[kind]);
    }
}
