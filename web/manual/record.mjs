// record.mjs HEDGED FILE - starts the daemon HEDGED, reads its tables, sends every request that the
// manual shows, and writes tables and answers to FILE as JSON. FILE is not touched if nothing has
// changed.
//
// An answer of another status than the manual says is an error, so the manual cannot show a request
// that does not work.

import { execFileSync } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { pictureOf } from '../src/manual/picture.js';
import { requestsOf } from './markdown.mjs';
import { MESHES } from './meshes.mjs';
import { OPERATIONS } from './operations.mjs';
import { PROBLEMS } from './problems.mjs';
import { ROUTES } from './routes.mjs';
import { Session } from './session.mjs';

const [program, file] = process.argv.slice(2);
const texts = path.join(path.dirname(fileURLToPath(import.meta.url)), 'guides');

// Returns the request that makes a mesh of meshes.mjs.
const makeMesh = (name) => ({ method: 'PUT', path: `/v1/meshes/try-${name}`, body: MESHES[name] });
const edit = (name, body) => ({ method: 'POST', path: `/v1/meshes/try-${name}/edits`, body });

const picture = (session, mesh) => pictureOf((target) => session.json({ path: target }), mesh);

// Returns functions that find elements of a mesh by vertices.
function finderOf({ points, halfedges, faces }) {
    const halfedge = (origin, target) => {
        const found = halfedges.find((each) => each.origin === origin && each.target === target);
        if (found === undefined) {
            throw new Error(`no half-edge from ${origin} to ${target}`);
        }
        return found.id;
    };
    return {
        halfedge,
        edge: (a, b) => Math.floor(halfedge(a, b) / 2),
        // The half-edge between two vertices that has no face.
        hole: (a, b) => halfedges.find(({ origin, target, face }) =>
            face === null && [a, b].includes(origin) && [a, b].includes(target)).id,
        face: (...corners) => faces.find(({ vertices }) =>
            vertices.length === corners.length && corners.every((each) => vertices.includes(each))).id,
        highest: () => {
            const height = ({ vertices }) => vertices.reduce((sum, each) => sum + points[each][2], 0);
            return [...faces].sort((a, b) => height(b) - height(a))[0].id;
        },
    };
}

// Sends a request and checks the status of the answer: that of the step, or a success.
async function sendChecked(session, step, what) {
    const answer = await session.send(step);
    const wanted = step.status;
    if (wanted === undefined ? answer.status >= 400 : answer.status !== wanted) {
        throw new Error(`${what}: ${step.method ?? 'GET'} ${step.path}: ${answer.status} ${answer.text}`);
    }
    const { status, media, bytes, text, head } = answer;
    return { status, media, bytes, text, head, location: answer.headers.location };
}

// Deletes all meshes, so that each example begins as it does for a reader.
async function clear(session) {
    const { items } = await session.json({ path: '/v1/meshes?limit=1000' });
    for (const { id } of items) {
        await session.send({ method: 'DELETE', path: `/v1/meshes/${id}` });
    }
}

async function recordOperation(session, name, example) {
    const { mesh, before, needs = [], after, view, use, select = false } = example;
    const steps = [
        ...needs.map(makeMesh),
        makeMesh(mesh),
        ...before.map((op) => edit(mesh, op)),
    ];
    await clear(session);
    for (const step of steps) {
        await session.json(step);
    }
    const old = await picture(session, `try-${mesh}`);
    const request = edit(mesh, example.request(finderOf(old)));
    const answer = await sendChecked(session, request, name);
    // Some edits are invisible until something moves; `after` moves it, for the picture only.
    const told = JSON.parse(answer.text);
    for (const op of after?.(told) ?? []) {
        await session.json(edit(mesh, op));
    }
    const result = await picture(session, `try-${mesh}`);
    const counts = await session.json({ path: `/v1/meshes/try-${mesh}?revision=${told.revision}` });
    const first = await session.json({ path: `/v1/meshes/try-${mesh}?revision=${told.revision - 1}` }).catch(() => null);
    let selected;
    if (select) {
        const { items } = await session.json({ path: `/v1/meshes/try-${mesh}/attributes/faces/selected` })
            .then((values) => ({ items: values }));
        selected = items;
    }
    return {
        setup: steps, request, answer, view, use, selected, moved: after !== undefined,
        before: { ...old, counts: first?.counts ?? null, euler: first?.euler ?? null },
        after: { ...result, counts: counts.counts, euler: counts.euler },
    };
}

async function waitFor(session, job) {
    let state = 'queued';
    while (['queued', 'running'].includes(state)) {
        ({ state } = await session.json({ path: job }));
    }
}

// Sends `steps`, replaces JOB by the id of the job that one of them began, and returns the answer to
// the last one.
async function recordSteps(session, steps, what) {
    let job = null;
    let answer;
    for (const step of steps) {
        const real = job === null ? step : { ...step, path: step.path.replace('JOB', job) };
        answer = await sendChecked(session, real, what);
        job = /^\/v1\/jobs\/([^/]+)$/.exec(answer.location ?? '')?.[1] ?? job;
        if (answer.status === 202 && answer.location !== undefined) {
            await waitFor(session, answer.location);
        }
    }
    return job === null ? answer : { ...answer, text: answer.text.replaceAll(job, 'b3vCwT0aQkPz81LmXyRs2d') };
}

async function recordRoute(session, { path: template, method, id }) {
    const { mesh = 'kite', setup = [], answer: isShown = true, run = true, ...given } = ROUTES[id] ?? {};
    const needsMesh = template.includes('{mesh}');
    const filled = template.replace('{mesh}', `try-${mesh}`).replace('{id}', '0').replace('{job}', 'JOB');
    const request = { method, path: filled, ...given };
    const before = [...(needsMesh ? [makeMesh(mesh)] : []), ...setup];
    await clear(session);
    const answer = isShown ? await recordSteps(session, [...before, request], id) : undefined;
    return { setup: before, request, answer, run };
}

// Starts a daemon with options of its own and, if `token` is a role with settings such as "write
// prefix=a-", with a token, by which it replaces TOKEN in requests.
async function startOwn(flags, token) {
    if (token === undefined) {
        return Session.start(program, ...flags);
    }
    const [role, ...settings] = token.split(' ');
    const [secret, line] = execFileSync(program, ['--new-token', 'reader', role], { encoding: 'utf8' }).split('\n');
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-manual-'));
    try {
        const tokens = path.join(folder, 'tokens');
        await writeFile(tokens, `${[line, ...settings].join(' ')}\n`, { mode: 0o600 });
        const session = await Session.start(program, '--tokens', tokens, ...flags);
        session.token = secret;
        return session;
    } finally {
        await rm(folder, { recursive: true });
    }
}

async function recordProblem(shared, code, { flags, token, steps, mesh }) {
    if (steps === undefined) {
        return undefined;
    }
    const own = flags !== undefined || token !== undefined;
    const session = own ? await startOwn(flags ?? [], token) : shared;
    try {
        if (!own) {
            await clear(session);
        }
        const setup = mesh === undefined ? [] : [mesh].flat().map(makeMesh);
        for (const step of setup) {
            await session.json(step);
        }
        const named = mesh === undefined ? undefined : await picture(session, `try-${[mesh].flat().at(-1)}`);
        const list = typeof steps === 'function' ? steps(finderOf(named)) : steps;
        const request = list.at(-1);
        for (const step of list.slice(0, -1)) {
            await session.send(step);
        }
        const answer = await session.send(request);
        const problem = answer.text === '' ? {} : JSON.parse(answer.text);
        if (problem.code !== code) {
            throw new Error(`the example of ${code} is answered ${answer.status} ${answer.text}`);
        }
        const { status, media, bytes, text } = answer;
        return { setup: [...setup, ...list.slice(0, -1)], request, answer: { status, media, bytes, text }, flags, runs: !own };
    } finally {
        if (session !== shared) {
            await session.stop();
        }
    }
}

async function recordGuide(session, slug, text) {
    const answers = [];
    await clear(session);
    for (const { kind, step, mesh } of requestsOf(text)) {
        answers.push(kind === 'drawing' ? await picture(session, mesh) : await recordSteps(session, [step], slug));
    }
    return { text, answers };
}

function routesOf({ paths }) {
    return Object.entries(paths).flatMap(([template, { parameters, ...methods }]) =>
        Object.entries(methods).map(([method, { operationId }]) => ({
            path: template, method: method.toUpperCase(), id: operationId,
        })),
    );
}

const failures = [];

// Does some work for each of the entries, one after the other, and collects what fails.
async function inOrder(entries, work) {
    const done = {};
    for (const [name, value] of entries) {
        try {
            done[name] = await work(name, value);
        } catch (error) {
            failures.push(error.message);
            done[name] = null;
        }
    }
    return done;
}

const session = await Session.start(program);
const recorded = { meshes: MESHES };
try {
    recorded.openapi = await session.json({ path: '/v1/openapi.json' });
    recorded.operations = (await session.json({ path: '/v1/operations' })).operations;
    recorded.problems = (await session.json({ path: '/v1/problems' })).problems;
    const guides = (await readdir(texts)).filter((name) => name.endsWith('.md')).sort();
    recorded.guides = await inOrder(
        await Promise.all(guides.map(async (name) => [name.slice(0, -3), await readFile(path.join(texts, name), 'utf8')])),
        (slug, text) => recordGuide(session, slug, text),
    );
    recorded.examples = {
        operations: await inOrder(
            recorded.operations.map(({ name }) => [name, OPERATIONS[name]]),
            (name, example) => example && recordOperation(session, name, example),
        ),
        routes: await inOrder(
            routesOf(recorded.openapi).map((route) => [route.id, route]),
            (id, route) => recordRoute(session, route),
        ),
        problems: await inOrder(
            recorded.problems.map(({ code }) => [code, PROBLEMS[code]]),
            async (code, row) => row && {
                cure: row.cure,
                when: row.when,
                example: await recordProblem(session, code, row),
            },
        ),
    };
} finally {
    await session.stop();
}
for (const [kind, examples] of Object.entries(recorded.examples)) {
    const lost = Object.keys(examples).filter((name) => examples[name] === undefined);
    if (lost.length > 0) {
        failures.push(`the manual has no text for the ${kind} ${lost.join(', ')}`);
    }
}
if (failures.length > 0) {
    throw new Error(`\n${failures.join('\n')}`);
}
const text = JSON.stringify(recorded);
if ((await readFile(file, 'utf8').catch(() => '')) !== text) {
    await writeFile(file, text);
}
