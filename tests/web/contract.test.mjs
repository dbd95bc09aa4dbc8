// contract.test.mjs - tests the comparison of recorded traffic with the OpenAPI document: it must
// accept what a daemon really answered, and find every kind of falsified answer.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

import { Contract } from './contract.mjs';
import { startDaemon } from './daemon.mjs';

const endings = [];
let daemon;
let contract;
before(async () => {
    daemon = await startDaemon({ after: (ending) => endings.unshift(ending) });
    contract = new Contract(await (await fetch(`${daemon.url}/v1/openapi.json`)).json());
    const square = '{"vertices":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]],"faces":[[0,1,2],[0,2,3]]}';
    const made = await ask('PUT', '/v1/meshes/square', square);
    assert.equal(made.status, 201);
});
after(async () => {
    for (const ending of endings) {
        await ending();
    }
});

function message(headers, body) {
    const head = [...headers].map(([name, value]) => `${name}: ${value}\r\n`).join('');
    const bytes = Buffer.from(body);
    return { head, body: bytes.toString('base64'), length: bytes.length };
}

// Sends a request, and returns it with its answer in the form in which traffic.mjs records both.
async function ask(method, target, body, headers = {}) {
    const all = body === undefined ? headers : { 'content-type': 'application/json', ...headers };
    const plain = { ...all, 'accept-encoding': 'identity' }; // fetch would hide a coding
    const answer = await fetch(daemon.url + target, { method, headers: plain, body });
    return {
        method,
        target,
        request: message(Object.entries(all), body ?? ''),
        status: answer.status,
        answer: message(answer.headers, Buffer.from(await answer.arrayBuffer())),
    };
}

// Returns a copy of a recorded request or answer in which `change(text)` replaces the body.
function rewrite(part, change) {
    const text = Buffer.from(part.body, 'base64').toString();
    const body = Buffer.from(change(text));
    return { ...part, body: body.toString('base64'), length: body.length };
}

function answering(change) {
    return (exchange) => ({ ...exchange, answer: rewrite(exchange.answer, change) });
}

function answeringJson(change) {
    return answering((text) => {
        const value = JSON.parse(text);
        change(value);
        return JSON.stringify(value);
    });
}

function answeringHead(change) {
    return ({ answer, ...rest }) => ({ ...rest, answer: { ...answer, head: change(answer.head) } });
}

// Returns a recorded request or answer as it would be if its body were compressed by gzip.
function gzipped({ head, body }) {
    const packed = gzipSync(Buffer.from(body, 'base64'));
    return {
        head: `${head}Content-Encoding: gzip\r\n`,
        body: packed.toString('base64'),
        length: packed.length,
    };
}

function without(name) {
    return answeringHead((head) => head.replace(new RegExp(`^${name}:.*\r\n`, 'im'), ''));
}

const SUMMARY = ['GET', '/v1/meshes/square'];
const HALFEDGE = ['GET', '/v1/meshes/square/halfedges/0'];
const PAGE = ['GET', '/v1/meshes/square/vertices?limit=2'];
const LINES = ['GET', '/v1/meshes/square/faces', undefined, { accept: 'application/x-ndjson' }];
const ABSENT = ['GET', '/v1/meshes/square/halfedges/99'];
const NOWHERE = ['GET', '/v1/nowhere'];
const WRONG_METHOD = ['DELETE', '/v1/meshes'];
const OPTIONS = ['OPTIONS', '/v1/meshes'];
const HEAD = ['HEAD', '/v1/meshes/square'];
const COPY = ['POST', '/v1/meshes/square/copy', '{"name":"another"}'];
const POKE = ['POST', '/v1/meshes/square/edits', '{"op":"face_poke","face":0,"dry_run":true}'];
const MOVE = ['POST', '/v1/meshes/square/edits', '{"op":"vertex_move","vertex":0,"by":[0,0,1]}'];
const OBJ = ['GET', '/v1/meshes/square/content?format=obj'];
const QUERY = [
    'POST',
    '/v1/meshes/square/query',
    '{"queries":[{"get":{"face":0}},{"get":{"face":99}},{"find":1}]}',
];

test('what the daemon says is what it promises', async () => {
    const real = [SUMMARY, HALFEDGE, PAGE, LINES, ABSENT, NOWHERE, WRONG_METHOD, OPTIONS, HEAD];
    for (const request of [...real, COPY, POKE, MOVE, OBJ, QUERY]) {
        assert.deepEqual(contract.check(await ask(...request)).wrong, [], request.join(' '));
    }
});

test('what it says in gzip is what it promises', async () => {
    for (const request of [SUMMARY, PAGE, LINES, ABSENT, COPY, POKE]) {
        const { answer, ...rest } = await ask(...request);
        const found = contract.check({ ...rest, answer: gzipped(answer) });
        assert.deepEqual(found.wrong, [], request.join(' '));
    }
});

// Each row of the table has a title, a request, a function that falsifies the exchange, and what
// the comparison must say about the falsified exchange.
const lies = [
    ['a status that is not declared', HALFEDGE, (e) => ({ ...e, status: 202 }), /202 is not decl/],
    ['a media type that is not declared', HALFEDGE,
        answeringHead((head) => head.replace('application/json', 'text/plain')),
        /text\/plain is not declared/],
    ['no media type', HALFEDGE, without('content-type'), /media type undefined/],
    ['no ETag of a read', HALFEDGE, without('etag'), /no header ETag/],
    ['no ETag of an edit', MOVE, without('etag'), /no ETag/],
    ['no Location', COPY, without('location'), /no header Location/],
    ['no Allow', WRONG_METHOD, without('allow'), /Allow is undefined/],
    ['an Allow that forgets one', WRONG_METHOD,
        answeringHead((head) => head.replace('POST, ', '')), /Allow is .* and not/],
    ['no Allow for OPTIONS', OPTIONS, without('allow'), /no Allow/],
    ['no Link beside a cursor', PAGE, without('link'), /Link is undefined/],
    ['a Link at the end', PAGE, answeringJson((page) => { page.next = null; }), /next is null/],
    ['a header that is not declared', HALFEDGE,
        answeringHead((head) => `${head}Location: /\r\n`), /location is not declared/],
    ['a 503 without Retry-After', ABSENT, (e) => ({ ...e, status: 503 }), /no header Retry-After/],
    ['a body that is not JSON', HALFEDGE, answering((text) => text.slice(1)), /not JSON/],
    ['a body that is not UTF-8', HALFEDGE,
        ({ answer, ...rest }) => ({ ...rest, answer: { ...answer, body: '/w==', length: 1 } }),
        /not JSON/],
    ['a member that is missing', HALFEDGE, answeringJson((h) => { delete h.twin; }), /twin/],
    ['a member of another type', HALFEDGE, answeringJson((h) => { h.twin = '1'; }), /integer/],
    ['a member nobody declared', HALFEDGE, answeringJson((h) => { h.more = 1; }), /unevaluated/],
    ['one deep inside', SUMMARY, answeringJson((s) => { s.counts.more = 1; }), /unevaluated/],
    ['one in a whole of parts', COPY, answeringJson((s) => { s.more = 1; }), /unevaluated/],
    ['one in a list', PAGE, answeringJson(({ items }) => { items[1].more = 1; }), /unevaluated/],
    ['a number in place of null', SUMMARY, answeringJson((s) => { s.name = null; }), /string/],
    ['a time that is none', SUMMARY, answeringJson((s) => { s.created = 'now'; }), /date-time/],
    ['a value out of its choices', QUERY,
        answeringJson(({ results }) => { results[1].element.kind = 'fan'; }), /answer|match/],
    ['a result that the operation has not', POKE,
        answeringJson(({ results }) => { results[0].edge = 1; }), /match exactly one/],
    ['a result of another type', POKE,
        answeringJson(({ results }) => { results[0].vertex = [4]; }), /match exactly one/],
    ['a parent alone', POKE,
        answeringJson(({ parents }) => { parents.faces = [[1]]; }), /fewer than 2/],
    ['lines without an end', LINES, answering((text) => text.replace(/\{"end.*\n/, '')), /the end/],
    ['lines with two ends', LINES, answering((text) => text + text), /the end/],
    ['a line that is no element', LINES, answering((text) => text.replace('"id"', '"is"')), /body/],
    ['a line that breaks off', LINES, answering((text) => text.trimEnd()), /has no end/],
    ['a body of HEAD', HEAD, answering(() => '{}'), /HEAD has a body/],
    ['a body of nothing', OPTIONS, (e) => ({ ...e, method: 'DELETE', status: 204,
        target: '/v1/meshes/square', answer: message([], '{}') }), /none is declared/],
    ['a refusal that is no problem', ABSENT,
        answeringJson((problem) => { delete problem.code; }), /code/],
    ['a refusal with another status', ABSENT,
        answeringJson((problem) => { problem.status = 400; }), /its status says 400/],
    ['success elsewhere', NOWHERE, (e) => ({ ...e, status: 200 }), /no such path/],
    ['a refusal elsewhere that is no problem', NOWHERE,
        answeringHead((head) => head.replace('application/problem+json', 'text/html')),
        /a refusal is/],
    ['success of a method it has not', WRONG_METHOD,
        (e) => ({ ...e, status: 204 }), /has no DELETE/],
    ['an unknown parameter that was taken', SUMMARY,
        (e) => ({ ...e, target: `${e.target}?more=1` }), /more is not declared/],
    ['a bad parameter that was taken', PAGE,
        (e) => ({ ...e, target: e.target.replace('=2', '=0') }), /limit=0/],
    ['a choice that was taken', OBJ,
        (e) => ({ ...e, target: e.target.replace('=obj', '=dxf') }), /format=dxf/],
    ['a bad variable that was taken', HALFEDGE,
        (e) => ({ ...e, target: e.target.replace('/0', '/-1') }), /\{id\}=-1/],
    ['a bad body that was taken', POKE,
        (e) => ({ ...e, request: rewrite(e.request, (text) => text.replace('0', '"0"')) }), /body/],
    ['an unknown member that was taken', COPY,
        (e) => ({ ...e, request: rewrite(e.request, () => '{"more":1}') }), /additional/],
    ['no body where one is required', POKE,
        (e) => ({ ...e, request: rewrite(e.request, () => '') }), /required, and was taken/],
    ['a body where none is', SUMMARY,
        (e) => ({ ...e, request: message([['content-type', 'application/json']], '{}') }),
        /not declared, and was taken/],
    ['a body of another type', COPY,
        (e) => ({ ...e, request: message([['content-type', 'text/plain']], '{}') }),
        /text\/plain is not declared, and/],
    ['a member nobody declared, in gzip', HALFEDGE, (e) => {
        const { answer, ...rest } = answeringJson((h) => { h.more = 1; })(e);
        return { ...rest, answer: gzipped(answer) };
    }, /unevaluated/],
    ['a bad body in gzip that was taken', POKE, (e) => {
        const request = rewrite(e.request, (text) => text.replace('0', '"0"'));
        return { ...e, request: gzipped(request) };
    }, /body/],
    ['a coding that is not declared', HALFEDGE,
        answeringHead((head) => `${head}Content-Encoding: br\r\n`), /Content-Encoding: /],
    ['a coding of nothing', OPTIONS, (e) => ({ ...e, method: 'DELETE', status: 204,
        target: '/v1/meshes/square', answer: message([['content-encoding', 'gzip']], '') }),
        /content-encoding is not declared/],
    ['a bad question that was answered', QUERY,
        (e) => ({ ...e, request: rewrite(e.request, (text) => text.replace('"get"', '"got"')) }),
        /queries/],
];

for (const [title, request, lie, expected] of lies) {
    test(`found: ${title}`, async () => {
        const { wrong } = contract.check(lie(await ask(...request)));
        assert.match(wrong.join('; '), expected);
    });
}

test('found: an event that is not as it was described', async () => {
    const job = await ask('POST', '/v1/meshes', '{"shape":"cube"}', { prefer: 'respond-async' });
    const { id } = JSON.parse(Buffer.from(job.answer.body, 'base64'));
    const stream = await ask('GET', `/v1/jobs/${id}/events`);
    assert.deepEqual(contract.check(stream).wrong, []);
    for (const lie of ['"states"', '"state":1,"was"']) {
        const { wrong } = contract.check(answering((text) => text.replace('"state"', lie))(stream));
        assert.match(wrong.join('; '), /^event job: /);
    }
    const renamed = answering((text) => text.replace('event: bye', 'event: end'))(stream);
    assert.match(contract.check(renamed).wrong.join('; '), /^event end: /);
});

// Returns what check-traffic.mjs, the last step of `make test`, prints about some exchanges.
async function checkFolder(t, exchanges) {
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-traffic-'));
    t.after(() => rm(folder, { recursive: true }));
    const lines = exchanges.map((exchange) => `${JSON.stringify(exchange)}\n`).join('');
    await writeFile(path.join(folder, 'a.ndjson'), lines);
    const program = fileURLToPath(new URL('check-traffic.mjs', import.meta.url));
    return new Promise((resolve) => {
        execFile(process.execPath, [program, folder], (error, text) =>
            resolve({ status: error === null ? 0 : error.code, text }),
        );
    });
}

test('a folder without traffic fails', async (t) => {
    const { status, text } = await checkFolder(t, []);
    assert.equal(status, 1);
    assert.match(text, /^0 passed, 1 failed$/m);
});

test('an operation that nothing reached fails by its name', async (t) => {
    const described = await ask('GET', '/v1/openapi.json');
    const lie = answeringJson((halfedge) => delete halfedge.next);
    const { status, text } = await checkFolder(t, [
        described,
        await ask(...SUMMARY),
        lie(await ask(...HALFEDGE)),
    ]);
    assert.equal(status, 1);
    assert.match(text, /^FAILED POST \/v1\/meshes\/\{mesh\}\/undo: no exchange reached it$/m);
    assert.doesNotMatch(text, /^FAILED GET \/v1\/meshes\/\{mesh\}[: ]/m);
    assert.match(text, /^FAILED GET \/v1\/meshes\/\{mesh\}\/halfedges\/\{id\} 200$/m);
    const [, passed, failed] = /^(\d+) passed, (\d+) failed$/m.exec(text);
    assert.equal(passed, '2');
    assert.equal(Number(failed), contract.operations.length - 3 + 1);
});
