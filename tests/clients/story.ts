// story.ts - what each client does with the daemon, and what it must be answered.
//
// A program fills in a Client with calls of what its generator made. It returns parts of the
// answers, narrowed down where an answer is one of several, so that it compiles only if the
// generated types name these parts. The story compares their values. The mesh is two triangles
// beside edge 2, which is then split.

export interface Summary {
    id: string;
    counts: { vertices: number; edges: number; faces: number };
}

// The elements that edge_split made, from its result.
export interface Split {
    revision: number | undefined;
    vertex: unknown;
    edges: number[] | undefined;
}

// Each call is one request.
export interface Client {
    create(vertices: [number, number, number][], faces: number[][]): Promise<Summary>;
    split(mesh: string, edge: number): Promise<Split>;
    loop(mesh: string, halfedge: number): Promise<{ halfedges: number[]; vertices: number[] }>;
    faces(mesh: string, vertices: number[]): Promise<{ offsets: number[]; ids: number[] }>;
    face(mesh: string, face: number): Promise<{ status: number; halfedge: number | undefined }>;
    remove(mesh: string): Promise<number>;
}

// Returns the address of the daemon, without a slash at its end.
export function base(): string {
    return known(process.argv[2], 'address of a daemon');
}

// Returns a value that must be there.
export function known<T>(value: T | undefined, name: string): T {
    if (value === undefined) {
        throw new Error(`there is no ${name}`);
    }
    return value;
}

let answered = 0;

// Waits for an answer, counts it, and returns it.
async function answer<T>(call: Promise<T>): Promise<T> {
    const value = await call;
    answered++;
    return value;
}

function same(what: string, got: unknown, wanted: unknown): void {
    if (JSON.stringify(got) !== JSON.stringify(wanted)) {
        throw new Error(`${what}: ${JSON.stringify(got)} instead of ${JSON.stringify(wanted)}`);
    }
}

async function live(client: Client): Promise<void> {
    const points: [number, number, number][] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    const { id, counts } = await answer(client.create(points, [[0, 1, 2], [0, 2, 3]]));
    same('counts', [counts.vertices, counts.edges, counts.faces], [4, 5, 2]);
    const split = await answer(client.split(id, 2));
    same('edge_split', split, { revision: 2, vertex: 4, edges: [5, 6, 7] });
    const face = await answer(client.face(id, 0));
    same('status of the face', face.status, 200);
    const loop = await answer(client.loop(id, known(face.halfedge, 'half-edge of the face')));
    same('half-edges of the loop', loop.halfedges, [12, 2, 4]);
    same('vertices of the loop', loop.vertices, [4, 1, 2]);
    const { offsets, ids } = await answer(client.faces(id, [4, 0]));
    same('faces of vertices', { offsets, ids }, { offsets: [0, 4, 6], ids: [2, 0, 1, 3, 2, 3] });
    same('delete', await answer(client.remove(id)), 204);
    same('status after delete', (await answer(client.face(id, 0))).status, 404);
}

export function tell(client: Client): void {
    live(client).then(
        () => console.log(`${answered} requests were answered well`),
        (error: unknown) => {
            console.error(error);
            process.exitCode = 1;
        },
    );
}
