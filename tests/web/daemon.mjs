// daemon.mjs - starts the real daemon for a test on a free port, and stops it when the test ends.
//
// The variable HEDGED is the path of the program and HEDGE_PAGE that of the built page; the default
// paths are those to which `make` writes.

import { spawn } from 'node:child_process';
import { once } from 'node:events';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

import { recorded } from './traffic.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
export const program = process.env.HEDGED ?? path.join(root, 'build/hedged');
const page = process.env.HEDGE_PAGE ?? path.join(root, 'build/web');

// Returns {url, direct, stop(), closers}; `direct` is the daemon's own address, past the recorder of
// traffic, which knows no coding but gzip. `t` is the context of the test, `flags` are further options of
// hedged. When the test ends, the closers are called first and then the daemon is stopped, because
// an open page would report a lost connection.
export async function startDaemon(t, ...flags) {
    const child = spawn(program, ['--listen', '127.0.0.1:0', '--store', 'memory', '--web', page, ...flags], {
        stdio: ['ignore', 'ignore', 'pipe'],
    });
    const ended = new Promise((resolve) => {
        child.on('exit', resolve); // resolves with the exit status
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
    return { url: proxy.url, direct: url, stop, closers };
}

async function call(url, options) {
    const answer = await fetch(url, options);
    const body = await answer.json();
    if (!answer.ok) {
        throw new Error(`${url}: ${answer.status} ${body.detail}`);
    }
    return body;
}

// Sends a GET to the API directly, not through the page, and returns the answer.
export function get(daemon, path) {
    return call(`${daemon.url}/v1/meshes${path}`);
}

// Returns the bytes of the arrays from which a mesh is drawn.
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

// Returns all elements of a kind.
export async function getAll(daemon, mesh, kind) {
    const { items, next } = await get(daemon, `/${mesh}/${kind}?limit=10000`);
    if (next !== null) {
        throw new Error('more elements than one page holds');
    }
    return items;
}
