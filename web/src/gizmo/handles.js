// handles.js - the nodes of SVG that are the gizmo's handles. Each is drawn twice: as it is seen, and
// wider and invisible, so that a finger can take hold of it.

const NAMESPACE = 'http://www.w3.org/2000/svg';

const BOX = 6; // half the side of a box, in CSS pixels
const DISC = 8; // radius of the disc
const HEAD = 9; // length of the head of an arrow

const KINDS = ['ring', 'arrow', 'box'];

// Makes the handles in an element of SVG. Returns {all}: a list of {handle: {kind, axis}, node,
// shape}; `node` takes the events, `shape` is seen.
export function makeHandles(svg) {
    const handles = KINDS.flatMap((kind) => [0, 1, 2].map((axis) => ({ kind, axis })));
    const all = [...handles, { kind: 'disc', axis: null }].map((handle) => {
        const node = document.createElementNS(NAMESPACE, 'g');
        node.dataset.handle = `${handle.kind}${handle.axis ?? ''}`;
        node.setAttribute('class', `handle ${handle.kind} axis-${handle.axis ?? 'all'}`);
        const [wide, shape] = ['wide', 'seen'].map((name) => {
            const path = document.createElementNS(NAMESPACE, 'path');
            path.setAttribute('class', name);
            node.append(path);
            return path;
        });
        svg.append(node);
        return { handle, node, wide, shape };
    });
    return { all };
}

// Draws the handles where handlesAt() in shape.js says, or hides all of them (null).
export function drawHandles(svg, { all }, places) {
    svg.style.display = places === null ? 'none' : '';
    for (const { handle, node, wide, shape } of places === null ? [] : all) {
        const path = pathOf(handle, places);
        node.style.display = path === null ? 'none' : '';
        shape.setAttribute('d', path ?? '');
        wide.setAttribute('d', path ?? '');
    }
}

function pathOf({ kind, axis }, { middle, arrows, boxes, rings }) {
    if (kind === 'disc') {
        const [x, y] = middle;
        return `M${x - DISC},${y}a${DISC},${DISC} 0 1 0 ${2 * DISC},0a${DISC},${DISC} 0 1 0 ${-2 * DISC},0z`;
    }
    if (kind === 'ring') {
        return rings[axis].map((piece) => `M${piece.map((point) => point.join()).join('L')}`).join('');
    }
    if (kind === 'box') {
        const [x, y] = boxes[axis] ?? [];
        return boxes[axis] && `M${x - BOX},${y - BOX}h${2 * BOX}v${2 * BOX}h${-2 * BOX}z`;
    }
    return arrows[axis] && arrowPath(...arrows[axis]);
}

function arrowPath([ax, ay], [bx, by]) {
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const [ux, uy] = [(bx - ax) / length, (by - ay) / length];
    const [x, y] = [bx - HEAD * ux, by - HEAD * uy];
    const side = HEAD / 2;
    return (
        `M${ax},${ay}L${bx},${by}` +
        `M${x - side * uy},${y + side * ux}L${bx},${by}L${x + side * uy},${y - side * ux}`
    );
}
