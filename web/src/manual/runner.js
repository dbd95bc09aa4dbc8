// runner.js - sends the requests of a page of the manual to the server that shows it.
//
// The meshes of the manual have ids such as try-kite. A page that is open adds a suffix of its own to
// them, so that it disturbs no other reader, and deletes them when it is left. In what is shown, the suffix is
// left out.

import { sendAny } from '../wire/api.js';
import { pictureOf } from './picture.js';

// A stream is closed after this many milliseconds, even if not all events have come.
const STREAM = 3000;
// Milliseconds between requests for the state of a job.
const POLL = 100;

const suffix = Math.random().toString(36).slice(2, 8).padEnd(6, '0');
const used = new Set();

// Returns a text in which the ids of the manual's meshes are those of this page.
function ours(text) {
    return text.replace(/\btry-([a-z]+)\b/g, (_, name) => {
        used.add(`try-${name}-${suffix}`);
        return `try-${name}-${suffix}`;
    });
}

const theirs = (text) => text.replaceAll(`-${suffix}`, '');

export class Runner {
    constructor(root) {
        this.root = root;
        window.addEventListener('pagehide', () => this.clear({ keepalive: true }));
    }

    address(path) {
        return this.root + path.slice(1);
    }

    // Deletes the meshes of this page.
    async clear(options = {}) {
        const ids = [...used];
        used.clear();
        await Promise.all(ids.map((id) =>
            sendAny(this.address(`/v1/meshes/${id}`), { method: 'DELETE', ...options }).catch(() => {})));
    }

    // Sends the requests `steps` one after the other, and returns the answer to the last one:
    // {status, media, text, bytes}. `before` is called when all but the last were sent.
    async run(steps, before = async () => {}) {
        await this.clear();
        let job = 'JOB';
        let answer;
        for (const [i, step] of steps.entries()) {
            if (i === steps.length - 1) {
                await before();
            }
            answer = await this.sendStep({ ...step, path: step.path.replace('JOB', job) });
            const made = /\/v1\/jobs\/([^/]+)$/.exec(answer.location ?? '');
            if (made) {
                [, job] = made;
            }
            if (made && i < steps.length - 1) {
                await this.waitFor(job);
            }
        }
        return { ...answer, text: theirs(answer.text) };
    }

    async sendStep({ method, path, headers = {}, body, events }) {
        const isText = typeof body === 'string';
        const content = body === undefined ? undefined : ours(isText ? body : JSON.stringify(body));
        const type = content === undefined || headers['Content-Type'] ? {} : { 'Content-Type': 'application/json' };
        const stop = new AbortController();
        const answer = await sendAny(this.address(ours(path)), {
            method,
            headers: { ...type, ...headers },
            body: content,
            signal: stop.signal,
        });
        const media = (answer.headers.get('Content-Type') ?? '').split(';')[0];
        const told = { status: answer.status, media, location: answer.headers.get('Location') };
        if (media === 'text/event-stream') {
            const text = await readEvents(answer, events ?? 1, stop);
            return { ...told, text, bytes: text.length };
        }
        const data = await answer.arrayBuffer();
        return { ...told, text: new TextDecoder().decode(data), bytes: data.byteLength };
    }

    async waitFor(job) {
        for (;;) {
            const answer = await sendAny(this.address(`/v1/jobs/${job}`));
            const { state } = answer.ok ? await answer.json() : {};
            if (state !== 'queued' && state !== 'running') {
                return;
            }
            await new Promise((resolve) => {
                setTimeout(resolve, POLL);
            });
        }
    }

    // Reads a mesh of this page as drawing.js draws it; null if it cannot be read.
    async picture(mesh) {
        try {
            return await pictureOf(async (path) => {
                const answer = await sendAny(this.address(path));
                if (!answer.ok) {
                    throw new Error(`status ${answer.status}`);
                }
                return answer.json();
            }, ours(mesh));
        } catch {
            return null;
        }
    }
}

// Reads a stream until it has sent `wanted` events, or until time is up.
async function readEvents(answer, wanted, stop) {
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    const timer = setTimeout(() => stop.abort(), STREAM);
    let text = '';
    try {
        while (text.split('\n\n').slice(0, -1).filter((block) => /^event: /m.test(block)).length < wanted) {
            const { done, value } = await reader.read();
            if (done) {
                break;
            }
            text += value;
        }
    } catch {
        // The time is up; what has come is shown.
    }
    clearTimeout(timer);
    stop.abort();
    return text;
}
