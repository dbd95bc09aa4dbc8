// drawing.js - draws a small mesh as a picture made of lines: a tree of [tag, attributes, children],
// which the manual writes as SVG text and the page builds as elements. Pure: no document, no server.
//
// A mesh is {points, halfedges, faces}: `points` has a place or null for each vertex id, `halfedges`
// a row {id, origin, target, twin, face} for each half-edge, and `faces` a row {id, vertices} for
// each face.

// The size of a picture, and the room around the mesh in it.
export const WIDTH = 360;
const HEIGHT = 270;
const MARGIN = 26;
// The direction from which solids are seen: a turn around the z axis, then a tilt, in radians.
const TURN = 0.62;
const TILT = 0.5;
// Distance in pixels of the arrow of a half-edge from its edge, what is left out at its ends, and
// the length of its head.
const ASIDE = 6;
const SHORT = 15;
const HEAD = 7;
// Distance of a label from its vertex, and half the width of a letter.
const AWAY = 13;
const LETTER = 3.4;

// Returns the place of a point before it is fitted into the picture: {x, y, depth}; y grows
// downward, and depth towards the viewer.
function project([x, y, z], view) {
    if (view === 'top') {
        return { x, y: -y, depth: z };
    }
    const right = x * Math.cos(TURN) + y * Math.sin(TURN);
    const away = y * Math.cos(TURN) - x * Math.sin(TURN);
    return {
        x: right,
        y: -(z * Math.cos(TILT) + away * Math.sin(TILT)),
        depth: z * Math.sin(TILT) - away * Math.cos(TILT),
    };
}

// Returns a function that gives the place of a point in a picture into which all `meshes` fit.
export function frameOf(meshes, view) {
    const all = meshes.flatMap(({ points }) => points.filter(Boolean).map((point) => project(point, view)));
    const [xs, ys] = [all.map(({ x }) => x), all.map(({ y }) => y)];
    const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(
        (WIDTH - 2 * MARGIN) / Math.max(right - left, 1e-9),
        (HEIGHT - 2 * MARGIN) / Math.max(bottom - top, 1e-9),
    );
    const height = Math.round((bottom - top) * scale + 2 * MARGIN);
    const shift = (WIDTH - (right - left) * scale) / 2;
    return {
        view,
        height,
        place(point) {
            const { x, y, depth } = project(point, view);
            return { x: (x - left) * scale + shift, y: (y - top) * scale + MARGIN, depth };
        },
    };
}

const round = (x) => Math.round(x * 10) / 10;
const mean = (places) => ({
    x: places.reduce((sum, { x }) => sum + x, 0) / places.length,
    y: places.reduce((sum, { y }) => sum + y, 0) / places.length,
});

function isBackward(places) {
    const turned = places.reduce((sum, p, i) => {
        const q = places[(i + 1) % places.length];
        return sum + p.x * q.y - q.x * p.y;
    }, 0);
    return turned > 0; // y grows downward, so a face that is seen from its front turns the other way
}

// Returns where the label of a vertex stands: beside the vertex, away from the middle of the picture.
function asideOf({ x, y }, middle) {
    const [dx, dy] = [x - middle.x, y - middle.y];
    const length = Math.hypot(dx, dy);
    return length < 4 * AWAY ? { x: x + AWAY, y: y - 8 } : { x: x + (dx / length) * AWAY, y: y + (dy / length) * AWAY + 4 };
}

function label({ x, y }, text, kind) {
    return ['text', { x: round(x), y: round(y), class: `label ${kind}` }, [text]];
}

// Returns the arrow of a half-edge, beside its edge on the side of its face.
function arrow(from, to, { id, name, kind, outside }) {
    const length = Math.hypot(to.x - from.x, to.y - from.y);
    const along = { x: (to.x - from.x) / length, y: (to.y - from.y) / length };
    // The left of the direction of travel, in a picture whose y grows downward.
    const aside = { x: along.y, y: -along.x };
    const short = Math.min(SHORT, length / 4);
    const at = (far, side) => ({
        x: from.x + along.x * far + aside.x * side,
        y: from.y + along.y * far + aside.y * side,
    });
    const [start, end] = [at(short, ASIDE), at(length - short, ASIDE)];
    const barb = at(length - short - HEAD, ASIDE + HEAD * 0.6);
    const inner = at(length - short - HEAD, ASIDE - HEAD * 0.6);
    const points = [end, barb, inner].map(({ x, y }) => `${round(x)},${round(y)}`).join(' ');
    const tail = at(length - short - HEAD + 1, ASIDE);
    const text = name ?? `h${id}`;
    const middle = at(length / 2, ASIDE + 9 + Math.abs(aside.x) * LETTER * text.length);
    return ['g', { class: `arrow ${kind}${outside ? ' outside' : ''}` }, [
        ['line', { x1: round(start.x), y1: round(start.y), x2: round(tail.x), y2: round(tail.y) }, []],
        ['polygon', { points }, []],
        label({ x: middle.x, y: middle.y + 4 }, text, kind),
    ]];
}

// Draws a mesh. `marks` says what is special: {vertex, edge, face}, each a map from ids to a word such
// as "new", "gone" or "picked", and `arrows`, a list of {id, name, kind} of half-edges. `ids` says
// which elements get their ids written: everything with "all", all vertices and what is marked with
// "vertices", only what is marked with "marked", or nothing with "none". `title` is the text for
// readers who do not see the picture.
export function draw(mesh, frame, { marks = {}, arrows = [], ids = 'marked', title }) {
    const places = mesh.points.map((point) => (point === null ? null : frame.place(point)));
    const middle = mean(places.filter(Boolean));
    const labels = (mark) => ids === 'all' || (mark !== undefined && ids !== 'none');
    const row = new Map(mesh.halfedges.map((halfedge) => [halfedge.id, halfedge]));
    const depths = new Map();
    const items = [];
    for (const { id, vertices } of mesh.faces) {
        const corners = vertices.map((vertex) => places[vertex]);
        const depth = corners.reduce((sum, corner) => sum + corner.depth, 0) / corners.length;
        depths.set(id, depth);
        const mark = marks.face?.get(id);
        const side = isBackward(corners) ? ' back' : '';
        items.push([depth, ['polygon', {
            class: `face${side}${mark === undefined ? '' : ` ${mark}`}`,
            points: corners.map(({ x, y }) => `${round(x)},${round(y)}`).join(' '),
        }, []]]);
        if (labels(mark)) {
            const { x, y } = mean(corners);
            items.push([depth + 1e-3, label({ x, y: y + 4 }, `f${id}`, `of-face ${mark ?? ''}`)]);
        }
    }
    // An edge is drawn after the nearer of its faces, and a vertex after the nearest of its edges, so
    // that faces in front of them hide them.
    const nearest = new Map();
    for (const { id, origin, target, face, twin } of mesh.halfedges.filter((each) => each.id % 2 === 0)) {
        const beside = [face, row.get(twin).face].filter((each) => each !== null);
        const depth = Math.max(...beside.map((each) => depths.get(each))) + 2e-3;
        const [a, b] = [places[origin], places[target]];
        const mark = marks.edge?.get(id / 2);
        const isOpen = beside.length < 2;
        items.push([depth + (mark === undefined ? 0 : 1e-3), ['line', {
            class: `edge${isOpen ? ' open' : ''}${mark === undefined ? '' : ` ${mark}`}`,
            x1: round(a.x), y1: round(a.y), x2: round(b.x), y2: round(b.y),
        }, []]]);
        if (labels(mark)) {
            const { x, y } = mean([a, b]);
            items.push([depth + 2e-3, label({ x, y: y + 4 }, `e${id / 2}`, `of-edge ${mark ?? ''}`)]);
        }
        for (const vertex of [origin, target]) {
            nearest.set(vertex, Math.max(nearest.get(vertex) ?? -Infinity, depth));
        }
    }
    places.forEach((place, id) => {
        const mark = marks.vertex?.get(id);
        if (place === null) {
            return;
        }
        const depth = (nearest.get(id) ?? place.depth) + 4e-3;
        items.push([depth, ['circle', {
            class: `vertex${mark === undefined ? '' : ` ${mark}`}`,
            cx: round(place.x), cy: round(place.y), r: mark === undefined ? 3 : 4.5,
        }, []]]);
        if (labels(mark) || ids === 'vertices') {
            items.push([depth + 1e-3, label(asideOf(place, middle), `v${id}`, `of-vertex ${mark ?? ''}`)]);
        }
    });
    for (const given of arrows) {
        const { origin, target, face } = row.get(given.id);
        const drawn = arrow(places[origin], places[target], { ...given, outside: face === null });
        items.push([Infinity, drawn]);
    }
    items.sort(([a], [b]) => a - b);
    return ['svg', {
        class: 'mesh', viewBox: `0 0 ${WIDTH} ${frame.height}`, role: 'img', 'aria-label': title,
    }, items.map(([, item]) => item)];
}
