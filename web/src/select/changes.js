// changes.js - the changes of a selection that need no drawing. Pure.
//
// Each change is a function of the kind of the selected elements, the set of them (see sets.js) and
// the arrays of the mesh, which returns the new selection, {kind, set}. The kind is null if nothing is
// selected.

import {
    allOf,
    borderOf,
    byAngle,
    connected,
    grown,
    inverted,
    shrunk,
} from '../geometry/sets.js';

const sameKind = (change) => (kind, set, geometry) => ({ kind, set: change(kind, set, geometry) });

export const CHANGES = {
    invert: sameKind(inverted),
    grow: sameKind(grown),
    shrink: sameKind(shrunk),
    connected: sameKind(connected),

    // The edges around the selected faces, or the boundary of the mesh if no faces are selected.
    boundary(kind, set, geometry) {
        const faces = kind === 'face' ? set : allOf('face', geometry);
        return { kind: 'edge', set: borderOf(faces, geometry) };
    },
};

// Returns the faces around the selected ones, up to edges with a larger dihedral angle, in degrees.
export function around(set, degrees, geometry) {
    return { kind: 'face', set: byAngle(set, (degrees * Math.PI) / 180, geometry) };
}

// Combines two sets of one kind: `how` is 'only' (the second in place of the first), 'add' or
// 'remove'.
export function combined(before, found, how) {
    if (how === 'only') {
        return found;
    }
    const set = found.slice();
    for (let i = 0; i < set.length; i++) {
        const had = before[i] ?? 0;
        set[i] = how === 'add' ? found[i] | had : had & (1 - found[i]);
    }
    return set;
}
