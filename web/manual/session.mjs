// session.mjs - a daemon that runs while the examples of the manual are recorded.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { request } from 'node:http';

// What differs from one recording to the next, and the text that the manual shows instead.
const DIFFERS = [
    [/"(created|modified|time|started|finished|expires)":"[^"]*Z"/g, '"$1":"2026-01-01T12:00:00.000Z"'],
    [/,"request_id":"[^"]*"/g, ''],
    [/ticket=hedge_[A-Za-z0-9_-]*/g, 'ticket=hedge_p6Dq0wYzR2mXk8VtB4nHs1LcJf7GaEu9TiKo3CvQy5W'],
    [/^id: [0-9a-f]{16}/gm, 'id: 5d1b27c0e4a9f386'],
    [/"((?:vertices|halfedges|edges|faces|edits)\.)[0-9a-f]{16}\./g, '"$1ad63b089ed4da62a.'],
    [/"(seconds|duration|uptime)":[0-9.e-]+/g, '"$1":0.01'],
];

export class Session {
    // Starts `program` with further `flags`. In headers of requests, TOKEN stands for `token`.
    static async start(program, ...flags) {
        const session = new Session();
        session.child = spawn(program, ['--listen', '127.0.0.1:0', '--store', 'memory', '--log', 'off', ...flags], {
            stdio: ['ignore', 'ignore', 'pipe'],
        });
        session.ended = new Promise((resolve) => {
            session.child.on('exit', resolve);
            session.child.on('error', resolve);
        });
        const said = [];
        const ready = new Promise((resolve) => {
            createInterface({ input: session.child.stderr }).on('line', (line) => {
                said.push(line);
                const found = /listening on (http:\/\/\S+)$/.exec(line);
                if (found) {
                    resolve(found[1]);
                }
            });
        });
        session.url = await Promise.race([ready, session.ended]);
        if (typeof session.url !== 'string') {
            throw new Error(`${program} ended before it listened: ${said.join('\n')}`);
        }
        return session;
    }

    async stop() {
        this.child.kill();
        await this.ended;
    }

    // Sends a request {method, path, headers, body}, where the body is an object (sent as JSON) or a
    // text, and returns {status, headers, media, text, bytes}. Of an event stream only `events`
    // events are read. The path is sent as it is, so that a request may also be wrong.
    send({ method = 'GET', path, headers = {}, body, events }) {
        const content = body === undefined || typeof body === 'string' ? body : JSON.stringify(body);
        const sent = Object.fromEntries(
            Object.entries(headers).map(([name, value]) => [name, value.replace('TOKEN', this.token)]),
        );
        if (content !== undefined && sent['Content-Type'] === undefined) {
            sent['Content-Type'] = 'application/json';
        }
        if (content !== undefined && sent['Content-Length'] === undefined && sent['Transfer-Encoding'] === undefined) {
            sent['Content-Length'] = Buffer.byteLength(content);
        }
        return new Promise((resolve, reject) => {
            const { hostname, port } = new URL(this.url);
            const asked = request({ hostname, port, path, method, headers: sent, agent: false }, (answer) => {
                const parts = [];
                const finish = () => {
                    const bytes = Buffer.concat(parts);
                    resolve({
                        status: answer.statusCode,
                        headers: answer.headers,
                        media: (answer.headers['content-type'] ?? '').split(';')[0],
                        text: plain(bytes.toString('utf8')),
                        bytes: bytes.length,
                        head: bytes.subarray(0, 48).toString('hex'),
                    });
                };
                answer.on('data', (part) => {
                    parts.push(part);
                    if (events !== undefined && count(Buffer.concat(parts).toString()) >= events) {
                        finish();
                        asked.destroy();
                    }
                });
                answer.on('end', finish);
                answer.on('error', () => {});
            });
            asked.on('error', reject);
            asked.end(content);
        });
    }

    // Sends a request that must succeed, and returns the JSON of the answer.
    async json(step) {
        const answer = await this.send(step);
        if (answer.status >= 400) {
            throw new Error(`${step.method ?? 'GET'} ${step.path}: ${answer.status} ${answer.text}`);
        }
        return answer.text === '' ? null : JSON.parse(answer.text);
    }
}

function count(stream) {
    return stream.split('\n\n').slice(0, -1).filter((block) => /^event: /m.test(block)).length;
}

function plain(text) {
    return DIFFERS.reduce((shown, [pattern, by]) => shown.replace(pattern, by), text);
}
