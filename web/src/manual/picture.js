// picture.js - reads a mesh from the server in the form in which drawing.js draws it. `read` sends a
// GET to a path and returns the JSON of the answer.

// The most elements that one page of a list can have; drawings show much smaller meshes.
const PAGE = 10000;

export async function pictureOf(read, mesh) {
    const all = async (kind) => (await read(`/v1/meshes/${mesh}/${kind}?limit=${PAGE}`)).items;
    const [vertices, halfedges, faces] = [await all('vertices'), await all('halfedges'), await all('faces')];
    const points = Array.from({ length: Math.max(-1, ...vertices.map(({ id }) => id)) + 1 }, () => null);
    vertices.forEach(({ id, position }) => {
        points[id] = position;
    });
    return {
        points,
        halfedges: halfedges.map(({ id, origin, target, twin, face }) => ({ id, origin, target, twin, face })),
        faces: faces.map(({ id, vertices: corners }) => ({ id, vertices: corners })),
    };
}
