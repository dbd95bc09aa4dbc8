// offers.js - offers to colour the mesh by what an operation has changed or found.

// Writes the distances of the vertices from another mesh, or from a revision of the open one, into the
// attribute `deviation`, and colours the mesh by them.
export async function colourByDeviation(other, { colouring, editing, session }) {
    const operation = { op: 'deviation', with: other };
    const answer = await editing.watch('deviation', (work) => session.run(operation, work));
    if (answer !== null) {
        await colouring.colorBy('attribute', 'vertices', 'deviation');
    }
}

// Operations after which the page offers to show how good the triangles are.
const MADE_TRIANGLES = ['remesh', 'delaunay', 'triangulate'];

// Operations after which the page offers to show how far the surface has moved.
const MOVED = ['decimate', 'smooth', 'deform'];

// Returns what the page offers after an operation on a mesh whose revision was `before`: {label, run},
// or null.
export function nextAfter(operation, before, tools) {
    const { colouring, onError } = tools;
    const { op } = operation;
    const show = (label, act) => ({ label, isOffer: true, run: () => act().catch(onError) });
    if (op === 'deviation') {
        const { attribute = 'deviation' } = operation;
        return show('Colour by the deviation', () =>
            colouring.colorBy('attribute', 'vertices', attribute),
        );
    }
    if (op === 'segment') {
        const { into = 'patch' } = operation;
        return show('Colour by patch', () => colouring.colorBy('attribute', 'faces', into));
    }
    if (MADE_TRIANGLES.includes(op)) {
        return show('Colour by the smallest angle', () =>
            colouring.colorBy('measure', 'faces', 'smallest_angle'),
        );
    }
    if (MOVED.includes(op)) {
        return show('Colour by the deviation', () => colourByDeviation(before, tools));
    }
    return null;
}
