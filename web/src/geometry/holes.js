// holes.js - finds the boundary half-edge of a hole that a click in the hole means. Pure.
//
//            rim, seen from the front            The pointer is in the hole if it is on the open
//        o==========================o            side of a boundary edge: the side on which the
//        |  the face beside the rim |            edge has no face. Through the hole other parts
//        o------------o-------------o            of the mesh may be visible.
//
// The arrays of geometry.js have only half-edges with a face. If a half-edge a -> b has a face and
// no face has b -> a, then b -> a is a boundary half-edge.

import { faceOf, isEdge, pointAt } from './geometry.js';
import { nearestOnSegment, placeOnScreen } from './view.js';

// holeAround() looks at no more than this many places of the screen, because each look draws the
// mesh.
const MOST_LOOKS = 4;

const BACK_REACH = 8; // CSS pixels, see holeAt()

// The sides of triangles that are edges, as {from, to, other, triangle}; `other` is the third corner
// of the triangle.
function sidesOf({ triangles }, which) {
    return which.flatMap((triangle) =>
        [0, 1, 2]
            .filter((side) => isEdge(triangles, triangle, side))
            .map((side) => {
                const [from, to, other] = [0, 1, 2].map(
                    (i) => triangles[4 * triangle + ((side + i) % 3)],
                );
                return { from, to, other, triangle };
            }),
    );
}

// Returns those sides whose half-edge has a boundary half-edge as its twin.
function boundaryOf({ triangles, triangleCount, vertexCount }, sides) {
    // An array is faster than a Set, which matters because millions of triangles are checked.
    const isEnd = new Uint8Array(vertexCount);
    sides.forEach(({ from, to }) => {
        isEnd[from] = 1;
        isEnd[to] = 1;
    });
    const keyOf = (from, to) => from * vertexCount + to;
    const inside = new Set();
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        for (let side = 0; side < 3; side++) {
            const [from, to] = [triangles[i + side], triangles[i + ((side + 1) % 3)]];
            if (isEnd[from] && isEnd[to] && from !== to && isEdge(triangles, i / 4, side)) {
                inside.add(keyOf(from, to));
            }
        }
    }
    return sides.filter(({ from, to }) => !inside.has(keyOf(to, from)));
}

// Returns twice the area of the triangle a, b, c on the screen; its sign tells the direction of its
// corners. Returns 0 if a corner is behind the camera.
function areaOf(places) {
    if (places.includes(null)) {
        return 0;
    }
    const [[ax, ay], [bx, by], [cx, cy]] = places;
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

// Returns whether the pointer is on the side of an edge where the edge has no face.
function isOpenAt(geometry, screen, { from, to, other }) {
    const [a, b, c] = [from, to, other].map((id) => placeOnScreen(screen, pointAt(geometry, id)));
    return areaOf([a, b, c]) * areaOf([a, b, [screen.x, screen.y]]) <= 0;
}

// Returns whether a triangle shows its back to the camera.
function isBack(geometry, screen, triangle) {
    const corners = [0, 1, 2].map((i) => geometry.triangles[4 * triangle + i]);
    // The y axis of the screen points down, so the corners of a front go round clockwise there.
    return areaOf(corners.map((id) => placeOnScreen(screen, pointAt(geometry, id)))) > 0;
}

// Returns whether the surface continues from the face beside a boundary edge to the face under the
// pointer, so that the pointer is on the surface beside the hole and not in it. This is so if both
// faces are the same, or if they touch and the camera sees the same side of both.
function isOnSurface(geometry, screen, { from, to, triangle }, under) {
    const { triangles } = geometry;
    if (faceOf(triangles, triangle) === faceOf(triangles, under)) {
        return true;
    }
    const corners = [0, 1, 2].map((i) => triangles[4 * under + i]);
    return (
        (corners.includes(from) || corners.includes(to)) &&
        isBack(geometry, screen, triangle) === isBack(geometry, screen, under)
    );
}

// Returns the boundary half-edge, {from, to, distance}, whose edge is visible near the pointer and
// nearest to it, if the pointer is in the hole there; else null. Where the camera looks through the
// hole at the back of the face beside its rim, the pointer is over this face and in the hole at
// once: there the boundary half-edge is chosen within BACK_REACH. The arguments are those of
// choose().
export function holeAt(geometry, seen, screen) {
    const distanceTo = ({ from, to }) =>
        nearestOnSegment(screen, pointAt(geometry, from), pointAt(geometry, to))?.distance ??
        Infinity;
    const isOver = seen.under >= 0 && seen.away === 0;
    const isIn = (side) =>
        isOpenAt(geometry, screen, side) &&
        !(isOver && isOnSurface(geometry, screen, side, seen.under));
    const isNearBack = ({ triangle, distance }) =>
        distance <= BACK_REACH && isBack(geometry, screen, triangle);
    const found = boundaryOf(geometry, sidesOf(geometry, seen.triangles))
        .map((side) => ({ ...side, distance: distanceTo(side) }))
        .filter((side) => isIn(side) || isNearBack(side))
        .sort((a, b) => a.distance - b.distance)
        .map(({ from, to, distance }) => ({ from: to, to: from, distance }));
    return found[0] ?? null;
}

// Returns the boundary half-edge, {from, to}, of the hole through which the pointer sees the back
// of a face: the nearest one that is visible and has its open side towards the pointer. Returns
// null if there is none. The arguments are those of choose().
export function holeAround(geometry, seen, screen) {
    if (!isBack(geometry, screen, seen.under)) {
        return null;
    }
    return (
        nearestHalfedges(geometry, screen).find(({ from, to, place }) => {
            const { triangles } = screen.look(place.x, place.y);
            return sidesOf(geometry, triangles).some(
                (side) =>
                    side.from === to && side.to === from && isOpenAt(geometry, screen, side),
            );
        }) ?? null
    );
}

// Returns the boundary half-edges nearest to the pointer, {from, to, place} each; `place` is the
// nearest point on the screen.
function nearestHalfedges(geometry, { boundary, ...screen }) {
    const found = [];
    for (let i = 0; i < boundary.length; i += 2) {
        const [from, to] = [boundary[i], boundary[i + 1]];
        const ends = [pointAt(geometry, from), pointAt(geometry, to)];
        const place = nearestOnSegment(screen, ...ends);
        if (place !== null) {
            found.push({ from, to, place });
        }
    }
    return found.sort((a, b) => a.place.distance - b.place.distance).slice(0, MOST_LOOKS);
}
