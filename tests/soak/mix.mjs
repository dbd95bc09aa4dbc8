// mix.mjs - what one client of the soak test does: requests of all kinds, in an order that follows
// from a seed.
//
// A client has a keeper, a mesh that stays, and up to GUESTS meshes that come and go. A round has a
// number of steps; at its end everything is as it was before: the guests are deleted, and the
// keeper is undone to its first state and compacted. So the daemon must hold as much memory as
// after every earlier round.

import { countIssued, numbersFrom, randomEdit } from '../web/random.mjs';

const GUESTS = 4;
// The mesh that the keeper is made from. It is so small that an edit of all of it can still be
// undone.
const KEEPER = { shape: 'torus', major_segments: 60, minor_segments: 60 };
const FORMATS = ['obj', 'off', 'ply', 'ply&encoding=ascii', 'stl', 'stl&encoding=ascii', 'glb', 'json'];
// Formats that keep polygons, and so the number of faces.
const EXACT = ['obj', 'off', 'ply', 'json'];
const CODINGS = ['identity', 'gzip', 'zstd'];
// The largest number and size of the files that a client keeps for uploading.
const SHELF = 12;
const SHELF_BYTES = 8 * 1024 * 1024;

const minimal = { Prefer: 'return=minimal' };

// Requests that must be refused, whatever the mesh is like.
const REFUSED = [
    ['POST', '/edits', { op: 'edge_split', edge: 4e9 }, [422]],
    ['POST', '/edits', { op: 'edge_splt', edge: 0 }, [400]],
    ['POST', '/edits', { op: 'vertex_move', vertex: 0, by: [1, 2] }, [400]],
    ['POST', '/edits', { ops: [{ op: 'vertex_add', position: [0, 0, 0] },
        { op: 'face_poke', face: 4e9 }] }, [422]],
    ['POST', '/edits', { op: 'vertex_add', position: [0, 0, 0], expected_revision: 0 }, [400, 412]],
    ['POST', '/edits', { op: 'decimate', ratio: 2 }, [400]],
    ['POST', '/undo', { to_revision: 1e9 }, [400, 409, 410, 422]],
    ['POST', '/query', { queries: [{ relation: 'faces', of: { vertex: 4e9 } }] }, [200]],
    ['POST', '/query', { queries: 1 }, [400]],
    ['GET', '/vertices/4000000000', undefined, [404]],
    ['GET', '/content?format=dxf', undefined, [400]],
    ['GET', '/faces?cursor=nothing', undefined, [400]],
];

// Bodies that must be refused because they are no mesh.
const BROKEN = [
    ['model/obj', 'v 0 0 0\nf 1 2 3\n', [400, 422]],
    ['model/ply', 'ply\nformat ascii 1.0\nelement vertex 4294967295\nproperty float x\nend_header\n',
        [400, 413, 422]],
    ['model/stl', `${'x'.repeat(80)}\xff\xff\xff\xff`, [400, 413, 422]],
    ['model/x-off', 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n', [400, 422]],
    ['application/json', '{"vertices":[[0,0,0]],"faces":[[0,0,0]]}', [422]],
    ['application/json', '{"vertices":[[0,0,', [400]],
    ['model/gltf-binary', 'glTF', [400, 422]],
];

export class Mix {
    // `most` is the number of faces that all guests together may have at once.
    constructor(client, name, seed, most) {
        this.client = client;
        this.name = name;
        this.below = numbersFrom(seed);
        this.most = most;
        this.guests = [];
        this.shelf = [];
        this.made = 0;
        const steps = [
            [4, this.create], [30, this.edit], [8, this.batch], [8, this.undo], [4, this.redo],
            [5, this.refused], [3, this.broken], [4, this.whole], [5, this.export],
            [2, this.leave], [2, this.check], [8, this.read], [3, this.listen], [1, this.copy],
            [2, this.attributes], [2, this.job], [2, this.keyed], [2, this.delete],
        ];
        this.steps = steps.flatMap(([weight, step]) => Array(weight).fill(step));
    }

    pick(list) {
        return list[this.below(list.length)];
    }

    // Returns a mesh for the next step. The keeper is chosen more often than a guest, because the
    // keeper is undone to its first revision at the end of a round.
    mesh() {
        return this.guests.length === 0 || this.below(3) === 0 ? this.keeper : this.pick(this.guests);
    }

    path(mesh, rest = '') {
        return `/v1/meshes/${mesh.id}${rest}`;
    }

    // Notes the upper bounds of the ids of a new mesh: its summary has the counts of elements, and
    // all its ids are below these counts.
    describe(id, summary) {
        const { counts: { vertices, edges, faces } = {}, revision } = summary ?? {};
        return { id, faces, revision, clean: true, issued: { vertices, edges, faces } };
    }

    live() {
        return [this.keeper, ...this.guests].reduce((sum, { faces }) => sum + faces, 0);
    }

    async begin() {
        const id = `${this.name}-keeper`;
        const body = KEEPER;
        const { value } = await this.client.json('PUT', `/v1/meshes/${id}`, [201], { body });
        this.keeper = this.describe(id, value);
        this.first = JSON.stringify(value.counts);
    }

    async step() {
        const mesh = this.mesh();
        await this.pick(this.steps).call(this, mesh);
    }

    // Returns everything to the state in which a round begins.
    async settle() {
        while (this.guests.length > 0) {
            await this.delete();
        }
        const { keeper, client } = this;
        // Undo, compact and an export bring the keeper into the same state after each round.
        await client.send('POST', this.path(keeper, '/undo'), [204, 409], {
            body: { to_revision: keeper.revision },
            headers: minimal,
        });
        await client.send('POST', this.path(keeper, '/edits'), [204], {
            body: { op: 'compact' },
            headers: minimal,
        });
        await client.send('GET', this.path(keeper, '/content?format=ply'), [200]);
        const { value } = await client.json('GET', this.path(keeper), [200]);
        if (JSON.stringify(value.counts) !== this.first) {
            client.strange(`${keeper.id} is ${JSON.stringify(value.counts)}, no more ${this.first}`);
        }
        this.keeper = this.describe(keeper.id, value);
    }

    // --- meshes that come and go ---

    shape() {
        // A number of faces from ten to `most`. Numbers around n and around 2 n are equally likely.
        const faces = Math.floor(10 * (this.most / 10) ** (this.below(1000) / 1000));
        const side = Math.max(3, Math.floor(Math.sqrt(faces)));
        return this.pick([
            { shape: 'torus', major_segments: side, minor_segments: side },
            { shape: 'grid', columns: side, rows: side },
            { shape: 'uv_sphere', segments: side, rings: side },
            { shape: 'cylinder', segments: Math.min(faces, 4096) },
            { shape: 'icosphere', subdivisions: Math.max(0, Math.floor(Math.log2(faces / 20) / 2)) },
            { shape: 'dodecahedron' },
        ]);
    }

    async make(faces) {
        while (this.guests.length >= GUESTS || (this.guests.length > 0 && this.live() + faces > this.most)) {
            await this.delete();
        }
    }

    async create() {
        const id = `${this.name}-${this.made++}`;
        if (this.shelf.length > 0 && this.below(2) === 0) {
            const { type, body, coding, faces, exact } = this.pick(this.shelf);
            await this.make(faces);
            const headers = coding === 'identity' ? {} : { 'Content-Encoding': coding };
            const { value } = await this.client.json('PUT', `/v1/meshes/${id}`, [201, 202], {
                body,
                type,
                headers: { ...headers, Prefer: 'wait=600' },
            });
            const read = value.counts?.faces;
            if (read !== faces && (exact || !(read >= faces))) {
                this.client.strange(`${type} of ${faces} faces was read as ${read}`);
            }
            this.guests.push(this.describe(id, value));
            return;
        }
        const body = this.shape();
        await this.make(this.most / 10);
        const { value } = await this.client.json('PUT', `/v1/meshes/${id}`, [201], {
            body,
            headers: { Prefer: 'wait=600' },
        });
        this.guests.push(this.describe(id, value));
    }

    async delete() {
        const guest = this.guests.shift();
        if (guest !== undefined) {
            await this.client.send('DELETE', this.path(guest), [204]);
        }
    }

    async copy(wanted) {
        await this.make(wanted.faces);
        const mesh = this.guests.includes(wanted) ? wanted : this.keeper;
        const id = `${this.name}-${this.made++}`;
        const { value } = await this.client.json('POST', this.path(mesh, '/copy'), [201], {
            body: { id },
            headers: { Prefer: 'wait=600' },
        });
        // A copy of a mesh has as many deleted ids as the mesh.
        const { issued } = mesh; // the dead ones, too
        this.guests.push({ ...this.describe(id, value), issued: { ...issued }, clean: false });
    }

    // --- edits ---

    async edited(mesh, body, expected = [200, 422], headers = {}) {
        const { status, value } = await this.client.json('POST', this.path(mesh, '/edits'), expected, {
            body,
            headers: { Prefer: 'wait=600', ...headers },
        });
        if (status === 200) {
            countIssued(mesh.issued, value);
            mesh.clean = false;
            mesh.faces += value.created.faces.length - value.deleted.faces.length;
        }
        return value;
    }

    async edit(mesh) {
        await this.edited(mesh, randomEdit(this.below, mesh.issued));
    }

    // A list of edits that are hardly ever refused, so that most lists are done as a whole.
    async batch(mesh) {
        const ops = [];
        for (let i = this.below(60) + 2; i > 0; i--) {
            ops.push(
                this.below(20) === 0
                    ? { op: 'vertex_add', position: [i, 0, 0] }
                    : { op: 'vertex_move', vertex: this.below(60 * 60), by: [0, 0, i / 1e4] },
            );
        }
        await this.edited(mesh, { ops, dry_run: this.below(8) === 0 });
    }

    async keyed(mesh) {
        const guest = mesh === this.keeper ? this.guests[0] : mesh;
        if (guest !== undefined) {
            const headers = { 'Idempotency-Key': `"${this.made++}"` };
            const body = randomEdit(this.below, guest.issued);
            await this.edited(guest, body, [200, 422], headers);
            await this.client.send('POST', this.path(guest, '/edits'), [200, 422], { body, headers });
        }
    }

    async undo(mesh) {
        const steps = this.below(4) === 0 ? this.below(60) + 1 : this.below(3) + 1;
        await this.client.send('POST', this.path(mesh, '/undo'), [204, 409], {
            body: { steps },
            headers: minimal,
        });
    }

    async redo(mesh) {
        await this.client.send('POST', this.path(mesh, '/redo'), [204, 409], {
            body: { steps: this.below(30) + 1 },
            headers: minimal,
        });
    }

    async refused(mesh) {
        const [method, rest, body, expected] = this.pick(REFUSED);
        await this.client.send(method, this.path(mesh, rest), expected, { body });
    }

    async broken() {
        const [type, text, expected] = this.pick(BROKEN);
        const coded = this.below(4) === 0;
        await this.client.send('POST', '/v1/meshes', coded ? [400, 422] : expected, {
            body: Buffer.from(text, 'latin1'),
            type,
            headers: coded ? { 'Content-Encoding': this.pick(['gzip', 'zstd']) } : {},
        });
    }

    // Runs an operation on the whole mesh of a guest, then asks for the counts of the mesh.
    async whole() {
        const mesh = this.guests.at(-1);
        if (mesh === undefined) {
            return;
        }
        const small = 4 * mesh.faces + this.live() < this.most;
        const body = this.pick([
            () => ({ op: 'compact' }),
            () => ({ op: 'triangulate' }),
            () => ({ op: 'decimate', ratio: 0.3 }),
            () => ({ op: small ? 'subdivide' : 'reverse' }),
            () => (small ? { op: 'subdivide', scheme: 'loop' } : { op: 'delete_isolated' }),
            () => ({ op: 'transform', matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1] }),
            () => ({ op: 'plane_cut', point: [0.01, 0, 0], normal: [1, 0.1, 0] }),
            () => ({ op: 'delaunay' }),
            () => (small ? { op: 'append', mesh: this.keeper.id } : { op: 'dual' }),
            () => ({ op: 'weld', tolerance: 1e-9 }),
            () => ({ op: 'segment', angle: 0.5, features: 'ignore' }),
            () => ({ op: 'select', by: 'half_space', point: [0, 0, 0], normal: [1, 1, this.below(9)] }),
        ])();
        const { status } = await this.client.send('POST', this.path(mesh, '/edits'), [204, 422], {
            body,
            headers: { Prefer: 'return=minimal, wait=600' },
        });
        if (status === 204) {
            const { value } = await this.client.json('GET', this.path(mesh), [200]);
            Object.assign(mesh, { ...this.describe(mesh.id, value), clean: false });
            // `issued` must be an upper bound of the ids, and deleted ids are not in the counts.
            for (const kind of Object.keys(mesh.issued)) {
                mesh.issued[kind] += 100;
            }
        }
    }

    async attributes(mesh) {
        const path = this.path(mesh, `/attributes/vertices/heat${this.below(3)}`);
        if (this.below(3) > 0) {
            await this.client.send('PUT', path, [204], {
                body: { type: 'float', components: 1 + this.below(3) },
                headers: minimal,
            });
        } else {
            await this.client.send('DELETE', path, [204, 404], { headers: minimal });
        }
    }

    // Makes a mesh by a job, to whose events a client listens, or which is cancelled.
    async job() {
        await this.make(this.most / 10);
        const id = `${this.name}-${this.made++}`;
        const { headers } = await this.client.send('PUT', `/v1/meshes/${id}`, [202], {
            body: this.shape(),
            headers: { Prefer: 'respond-async' },
        });
        const { location } = headers;
        if (this.below(3) === 0) {
            await this.client.send('DELETE', location, [202, 204]);
        }
        await this.client.send('GET', `${location}/events`, [200, 404]);
        await this.client.send('DELETE', location, [202, 204, 404]);
        const { status, value } = await this.client.json('GET', `/v1/meshes/${id}`, [200, 404]);
        if (status === 200) {
            this.guests.push(this.describe(id, value));
        }
    }

    // --- reading ---

    // Exports a mesh. Some files are kept to be uploaded: those of meshes without defects, which
    // every format can hold.
    async export(mesh) {
        const format = this.pick(FORMATS);
        const { headers, body } = await this.client.send(
            'GET', this.path(mesh, `/content?format=${format}`), [200],
            { headers: { 'Accept-Encoding': this.pick(CODINGS) } },
        );
        if (body.length === 0) {
            this.client.strange(`${mesh.id} as ${format} is empty`);
        }
        if (mesh.clean && body.length < SHELF_BYTES && mesh.faces > 0) {
            this.shelf.push({
                type: headers['content-type'],
                body,
                coding: headers['content-encoding'] ?? 'identity',
                faces: mesh.faces,
                exact: EXACT.includes(format.split('&')[0]),
            });
            this.shelf = this.shelf.slice(-SHELF);
        }
    }

    // Disconnects in the middle of an answer.
    async leave(mesh) {
        await this.client.send('GET', this.path(mesh, `/content?format=${this.pick(FORMATS)}`), [200], {
            cut: true,
            headers: { 'Accept-Encoding': this.pick(CODINGS) },
        });
    }

    // If faces cross each other everywhere, the search takes more steps than a request may, so a
    // job does it.
    async check(mesh) {
        const path = this.path(mesh, '/check');
        const { value } = await this.client.json('GET', path, [200]);
        if (value.valid !== true) {
            this.client.strange(`${mesh.id} is not valid: ${JSON.stringify(value).slice(0, 300)}`);
        }
        if (mesh.faces < 5000 && this.below(3) === 0) {
            const answer = await this.client.send(
                'GET', `${path}?self_intersections=true`, [202],
                { headers: { Prefer: 'respond-async' } },
            );
            await this.outcome(answer, [200, 413]);
        }
    }

    // Reads the result of a job and deletes the job, whose result would otherwise be kept for an
    // hour.
    async outcome({ headers: { location } }, expected) {
        await this.client.send('GET', `${location}/events`, [200]);
        await this.client.send('GET', `${location}/result`, expected);
        await this.client.send('DELETE', location, [204]);
    }

    async read(mesh) {
        const of = { vertices: 'all' };
        const vertex = this.below(mesh.issued.vertices);
        const [method, rest, expected, body] = this.pick([
            ['GET', '', [200]],
            ['GET', `/vertices/${vertex}`, [200, 404, 410]],
            ['GET', `/faces/${this.below(mesh.issued.faces)}/edges`, [200, 404, 410]],
            ['GET', '/edits?limit=20', [200]],
            ['GET', '/geometry', [200]],
            ['GET', '/progressive', [200, 202, 422]],
            ['GET', '/boundaries', [200]],
            ['GET', '/components', [200]],
            ['GET', '/faces?limit=1000', [200]],
            ['POST', '/query', [200, 413], { queries: [{ relation: 'vertices', of }] }],
            ['POST', '/query', [200], { queries: [{ closest: [2, 0, 0] },
                { ray: { origin: [9, 0.1, 0.1], direction: [-1, 0, 0] } }] }],
            ['POST', '/traverse', [200, 404, 410, 422],
                { walk: 'rings', from: { vertex }, depth: 3 }],
        ]);
        const answer = await this.client.send(method, this.path(mesh, rest), expected, {
            body,
            headers: { 'Accept-Encoding': this.pick(CODINGS) },
        });
        if (answer.status === 202) {
            await this.outcome(answer, [200, 422]);
        }
    }

    // Listens to a guest and edits it. A listener leaves a queue of events, which collects events
    // for a while after the listener has gone; a guest is used because it is deleted together with
    // its queue.
    async listen() {
        const mesh = this.guests[0];
        if (mesh !== undefined) {
            await this.client.listen(this.path(mesh, '/events'), async () => {
                for (let i = 0; i < 3; i++) {
                    await this.edited(mesh, { op: 'vertex_add', position: [i, 1, 1] }, [200]);
                }
                return 3;
            });
        }
    }
}
