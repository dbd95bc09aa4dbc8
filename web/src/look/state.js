// state.js - the look of the view as a plain object, which can be stored and sent. Pure.
//
//   way          'solid', 'xray', 'wire' or 'points': how faces are drawn
//   isSmooth     smooth shading; edges at which faces meet at more than `crease` degrees stay sharp
//   crease       0 to 180
//   matcap       'none', 'clay', 'metal' or 'pearl'
//   hasEdges     the edges of faces are drawn
//   marksBacks   the backs of faces are marked
//   hasAxes, hasGrid, hasBox   axes, grid and bounding box are drawn
//   unit         what the coordinates of the mesh are: one of UNITS
//   hurry        what is drawn while the camera moves: 'auto', 'always' or 'never' a simpler mesh
//   section      null, or {axis, normal, at, isFlipped}: the plane of all points p of the mesh with
//                dot(normal, p) = at; `normal` has the length 1. What is above the plane is cut away
//                or, if it is flipped, what is below. `axis` is 'x', 'y', 'z' or 'free'

import { UNITS } from '../kit/units.js';

const CHOICES = {
    way: ['solid', 'xray', 'wire', 'points'],
    matcap: ['none', 'clay', 'metal', 'pearl'],
    unit: UNITS,
    hurry: ['auto', 'always', 'never'],
};
const FLAGS = ['isSmooth', 'hasEdges', 'marksBacks', 'hasAxes', 'hasGrid', 'hasBox'];

export const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

// The look of the first visit.
export const FIRST = {
    way: 'solid',
    isSmooth: false,
    crease: 40,
    matcap: 'none',
    hasEdges: true,
    marksBacks: false,
    hasAxes: false,
    hasGrid: false,
    hasBox: false,
    unit: '',
    hurry: 'auto',
    section: null,
};

export const WAYS = CHOICES.way;

// Returns a valid look from any value, such as one from a link: what is missing or wrong in it is
// taken from FIRST.
export function toState(value) {
    const said = typeof value === 'object' && value !== null ? value : {};
    const state = { ...FIRST, section: sectionOf(said.section) };
    for (const [name, options] of Object.entries(CHOICES)) {
        if (options.includes(said[name])) {
            state[name] = said[name];
        }
    }
    for (const name of FLAGS) {
        if (typeof said[name] === 'boolean') {
            state[name] = said[name];
        }
    }
    if (Number.isFinite(said.crease) && said.crease >= 0 && said.crease <= 180) {
        state.crease = said.crease;
    }
    return state;
}

function sectionOf(value) {
    const { axis, at, isFlipped } = value ?? {};
    const normal = axis === 'free' ? unitOf(value.normal) : AXES[axis];
    return normal && Number.isFinite(at) ? { axis, normal, at, isFlipped: isFlipped === true } : null;
}

function unitOf(vector) {
    if (!Array.isArray(vector) || vector.length !== 3 || !vector.every(Number.isFinite)) {
        return null;
    }
    const length = Math.hypot(...vector);
    return length > 0 && Number.isFinite(length) ? vector.map((value) => value / length) : null;
}

// Returns the plane of a section in view coordinates, {normal, at}, above which the mesh is cut away;
// `frame` is that of the geometry.
export function planeOf({ normal, at, isFlipped }, { origin, scale }) {
    const shift = normal.reduce((sum, value, axis) => sum + value * origin[axis], 0);
    const sign = isFlipped ? -1 : 1;
    return { normal: normal.map((value) => sign * value), at: sign * (at - shift) * scale };
}

// Returns the normal of a free section from its angles in degrees: `turn` around the z axis, `tilt`
// from the plane of x and y upward.
export function normalOfAngles(turn, tilt) {
    const [a, b] = [turn, tilt].map((degrees) => (degrees * Math.PI) / 180);
    return [Math.cos(b) * Math.cos(a), Math.cos(b) * Math.sin(a), Math.sin(b)];
}

// Returns the angles of a normal, {turn, tilt} in whole degrees.
export function anglesOf([x, y, z]) {
    const degrees = (angle) => Math.round((angle * 180) / Math.PI);
    return {
        turn: (degrees(Math.atan2(y, x)) + 360) % 360,
        tilt: degrees(Math.asin(Math.min(Math.max(z, -1), 1))),
    };
}

// Returns [least, most] of `at` for planes with this normal that meet a box, in the coordinates of the
// mesh; `box` is in view coordinates.
export function rangeOf(normal, { low, high }, { origin, scale }) {
    const sum = (bits) =>
        normal.reduce((total, value, axis) => {
            const corner = (value > 0 ? bits === 1 : bits === 0) ? high : low;
            return total + value * (corner[axis] / scale + origin[axis]);
        }, 0);
    return [sum(0), sum(1)];
}

// Returns a look as the text of a link: what differs from the look of the first visit, as JSON. If
// nothing does, returns null, or with `isShared` the text that says so, because others may have another
// look. What is drawn while the camera moves is left to each visitor.
export function linkOf(state, isShared = false) {
    const differs = Object.entries(state).filter(
        ([name, value]) => name !== 'hurry' && JSON.stringify(value) !== JSON.stringify(FIRST[name]),
    );
    return differs.length === 0 && !isShared ? null : JSON.stringify(Object.fromEntries(differs));
}

// Returns the look that the text of a link says, or null if it says none.
export function stateOfLink(text) {
    try {
        return toState(JSON.parse(text));
    } catch {
        return null;
    }
}
