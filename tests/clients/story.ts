// story.ts - what each client does with the daemon, and what it must be answered.
//
// A program fills in a Client with calls of what its generator made; it takes the values out of
// the answers by the generated types, so that it compiles only if these name them. The story
// compares the values. The mesh is two triangles beside edge 2, which is then split.

export interface Client {
    create(vertices: [number, number, number][], faces: number[][]):
        Promise<{ id: string; vertices: number; edges: number; faces: number }>;
    split(mesh: string, edge: number): Promise<{ revision: number; vertex: unknown; edges: number[] }>;
    loop(mesh: string, halfedge: number): Promise<{ halfedges: number[]; vertices: number[] }>;
    faces(mesh: string, vertices: number[]): Promise<{ offsets: number[]; ids: number[] }>;
    face(mesh: string, face: number): Promise<{ status: number; halfedge: number | undefined }>;
    remove(mesh: string): Promise<number>;
}

// Returns the address of the daemon, without a slash at its end.
export function base(): string {
    const url = process.argv[2];
    if (url === undefined) {
        throw new Error('no address of a daemon');
    }
    return url;
}

// Returns a value that an answer must have.
export function known<T>(value: T | undefined, name: string): T {
    if (value === undefined) {
        throw new Error(`the answer has no ${name}`);
    }
    return value;
}

function same(what: string, got: unknown, wanted: unknown): void {
    if (JSON.stringify(got) !== JSON.stringify(wanted)) {
        throw new Error(`${what}: ${JSON.stringify(got)} instead of ${JSON.stringify(wanted)}`);
    }
}

async function live(client: Client): Promise<void> {
    const { id, ...counts } = await client.create(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        [[0, 1, 2], [0, 2, 3]],
    );
    same('counts', counts, { vertices: 4, edges: 5, faces: 2 });
    same('edge_split', await client.split(id, 2), { revision: 2, vertex: 4, edges: [5, 6, 7] });
    const { status, halfedge } = await client.face(id, 0);
    same('status of the face', status, 200);
    const loop = { halfedges: [12, 2, 4], vertices: [4, 1, 2] };
    same('loop', await client.loop(id, known(halfedge, 'halfedge')), loop);
    same('faces of vertices', await client.faces(id, [4, 0]), { offsets: [0, 4, 6], ids: [2, 0, 1, 3, 2, 3] });
    same('delete', await client.remove(id), 204);
    same('status after delete', (await client.face(id, 0)).status, 404);
}

export function tell(client: Client): void {
    live(client).then(
        () => console.log('the story ended well'),
        (error: unknown) => {
            console.error(error);
            process.exitCode = 1;
        },
    );
}
