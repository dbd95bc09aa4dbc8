// wire.mjs - the daemon of the soak test, seen from outside: requests to it, and the memory that it
// takes.

import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { Agent, request } from 'node:http';
import { createInterface } from 'node:readline';

const MIB = 1024 * 1024;
const TICKS = 100; // clock ticks of processor time in a second of /proc
const SLOWEST = 5; // number of slowest requests that are listed in the end

export class Daemon {
    constructor(child, url) {
        this.child = child;
        this.url = url;
        this.ended = once(child, 'exit');
    }

    // Starts the daemon on a free port.
    static async start(program, flags) {
        const child = spawn(program, ['--listen', '127.0.0.1:0', '--store', 'memory', '--log', 'off', ...flags], {
            stdio: ['ignore', 'ignore', 'pipe'],
        });
        process.on('exit', () => child.kill());
        for await (const line of createInterface({ input: child.stderr })) {
            const found = /listening on (http:\/\/\S+)$/.exec(line);
            if (found) {
                child.stderr.pipe(process.stderr);
                return new Daemon(child, found[1]);
            }
        }
        throw new Error(`${program} ended before it listened`);
    }

    // Returns MiB that are resident now, the maximum since the last call with `anew`, and the
    // number of open descriptors.
    memory(anew = false) {
        const folder = `/proc/${this.child.pid}`;
        const status = readFileSync(`${folder}/status`, 'utf8');
        const mib = (name) => Number(new RegExp(`^${name}:\\s*(\\d+)`, 'm').exec(status)[1]) / 1024;
        if (anew) {
            writeFileSync(`${folder}/clear_refs`, '5');
        }
        return {
            resident: mib('VmRSS'),
            peak: mib('VmHWM'),
            descriptors: readdirSync(`${folder}/fd`).length,
        };
    }

    // Returns the seconds of processor time that all threads have used so far.
    processor() {
        const line = readFileSync(`/proc/${this.child.pid}/stat`, 'latin1');
        const [user, system] = line.slice(line.lastIndexOf(')') + 2).split(' ').slice(11, 13);
        return (Number(user) + Number(system)) / TICKS;
    }

    // Stops the daemon; returns its exit status.
    async stop() {
        this.child.kill('SIGTERM');
        const [status] = await this.ended;
        return status;
    }
}

// A client with one connection that is kept. Every answer must have one of the expected statuses.
export class Client {
    constructor(daemon, load) {
        const { hostname, port } = new URL(daemon.url);
        this.daemon = daemon;
        this.to = { hostname, port };
        this.agent = new Agent({ keepAlive: true, maxSockets: 1 });
        this.load = load;
        this.requests = 0;
        this.refused = 0;
        this.problems = [];
        this.slowest = []; // {time, processor, what} in seconds, the slowest first
    }

    // Notes a slow request. The processor time of the daemon includes the requests of other clients
    // at that time.
    timed(began, processor, what) {
        const time = (performance.now() - began) / 1000;
        if (this.slowest.length < SLOWEST || time > this.slowest.at(-1).time) {
            this.slowest.push({ time, processor: this.daemon.processor() - processor, what: what() });
            this.slowest = slowest(this.slowest);
        }
    }

    // Pauses so that no more than `load` of the time is spent on requests.
    async rest(began) {
        if (this.load < 1) {
            const busy = performance.now() - began;
            await new Promise((resolve) => setTimeout(resolve, busy * (1 / this.load - 1)));
        }
    }

    // Sends a request; returns {status, headers, body}. With `cut` the connection is closed after
    // the first piece of the answer. With `type` the body is sent as it is, otherwise as JSON.
    async send(method, path, expected, { body, type, headers = {}, cut = false } = {}) {
        const began = performance.now();
        const processor = this.daemon.processor();
        const bytes = body === undefined || type ? body : Buffer.from(JSON.stringify(body));
        const all = { 'Accept-Encoding': 'identity', ...headers };
        if (bytes !== undefined) {
            all['Content-Type'] = type ?? 'application/json';
            all['Content-Length'] = bytes.length;
        }
        const asked = request({ ...this.to, method, path, headers: all, agent: this.agent });
        asked.end(bytes);
        const [answer] = await once(asked, 'response');
        const pieces = [];
        for await (const piece of answer) {
            pieces.push(piece);
            if (cut) {
                break; // ends the loop, which destroys the connection
            }
        }
        const result = {
            status: answer.statusCode,
            headers: answer.headers,
            body: Buffer.concat(pieces),
        };
        this.timed(began, processor, () => `${method} ${path} ` +
            `${bytes === undefined ? '' : type ? `${type}, ${bytes.length} bytes` : bytes.subarray(0, 200)}`);
        this.requests++;
        this.refused += result.status >= 400;
        if (!expected.includes(result.status)) {
            this.strange(`${method} ${path} ${bytes?.subarray(0, 300) ?? ''}: ${result.status}, ` +
                `not ${expected.join(' or ')}: ${result.body.subarray(0, 300)}`);
        }
        await this.rest(began);
        return result;
    }

    async json(method, path, expected, options) {
        const result = await this.send(method, path, expected, options);
        const value = result.body.length > 0 ? JSON.parse(result.body) : null;
        return { ...result, value };
    }

    // Notes that an answer was not as expected in something other than its status.
    strange(what) {
        this.problems.push(what);
    }

    // Listens to a mesh, calls `act`, and disconnects when this many edits have been received, as
    // listeners do.
    async listen(path, act) {
        const asked = request({ ...this.to, path, agent: false });
        asked.end();
        const [stream] = await once(asked, 'response');
        this.requests++;
        let text = '';
        let wake = () => {};
        stream.setEncoding('utf8');
        stream.on('data', (piece) => {
            text += piece;
            wake();
        });
        stream.on('close', () => wake());
        const until = async (holds) => {
            while (!holds() && !stream.destroyed) {
                await new Promise((resolve) => {
                    wake = resolve;
                });
            }
        };
        await until(() => text.includes('\n\n'));
        const edits = await act();
        await until(() => text.split(/^event: /m).length > edits);
        if (text.split(/^event: /m).length <= edits) {
            this.strange(`${path} ended before it told of ${edits} edits: ${text.slice(-300)}`);
        }
        asked.destroy();
    }

    end() {
        this.agent.destroy();
    }
}

export const slowest = (list) => [...list].sort((a, b) => b.time - a.time).slice(0, SLOWEST);
export const mebibytes = (bytes) => bytes / MIB;
