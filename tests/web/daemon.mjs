// daemon.mjs - the real daemon, started by a test on a free port and stopped when the test ends.
//
// HEDGED is the program and HEDGE_PAGE the built page; without them those of `make`.

import { spawn } from 'node:child_process';
import { once } from 'node:events';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

import { recorded } from './traffic.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
export const program = process.env.HEDGED ?? path.join(root, 'build/hedged');
const page = process.env.HEDGE_PAGE ?? path.join(root, 'build/web');

// {url, stop(), closers}; `t` is the context of the test, `flags` are more of hedged's. When it ends the closers are called, then
// the daemon is stopped: a page that is open would miss it.
export async function startDaemon(t, ...flags) {
    const child = spawn(program, ['--listen', '127.0.0.1:0', '--store', 'memory', '--web', page, ...flags], {
        stdio: ['ignore', 'ignore', 'pipe'],
    });
    const ended = new Promise((resolve) => {
        child.on('exit', resolve); // with its status
        child.on('error', resolve);
    });
    let proxy;
    const stop = async (signal = 'SIGTERM') => {
        child.kill(signal);
        const status = await ended;
        proxy?.close();
        return status;
    };
    const closers = [];
    t.after(async () => {
        await Promise.all(closers.map((close) => close()));
        await stop();
    });
    const lines = createInterface({ input: child.stderr });
    const ready = new Promise((resolve) => {
        lines.on('line', (line) => {
            const found = /listening on (http:\/\/\S+)$/.exec(line);
            if (found) {
                resolve(found[1]);
            }
        });
    });
    const url = await Promise.race([ready, ended]);
    if (typeof url !== 'string') {
        throw new Error(`${program} ended before it listened: ${url}`);
    }
    proxy = await recorded(url);
    return { url: proxy.url, stop, closers };
}

async function call(url, options) {
    const answer = await fetch(url, options);
    const body = await answer.json();
    if (!answer.ok) {
        throw new Error(`${url}: ${answer.status} ${body.detail}`);
    }
    return body;
}

// What the API says, beside the page.
export function get(daemon, path) {
    return call(`${daemon.url}/v1/meshes${path}`);
}

// The arrays to draw a mesh from, as they came.
export async function getGeometry(daemon, mesh) {
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}/geometry`);
    if (!answer.ok) {
        throw new Error(`geometry of ${mesh}: ${answer.status}`);
    }
    return answer.arrayBuffer();
}

export function post(daemon, path, body, type = 'application/json') {
    return call(`${daemon.url}/v1/meshes${path}`, {
        method: 'POST',
        headers: { 'Content-Type': type },
        body: typeof body === 'string' ? body : JSON.stringify(body),
    });
}

// All elements of a kind.
export async function getAll(daemon, mesh, kind) {
    const { items, next } = await get(daemon, `/${mesh}/${kind}?limit=10000`);
    if (next !== null) {
        throw new Error('more elements than one page holds');
    }
    return items;
}
