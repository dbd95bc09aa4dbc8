// traffic.mjs - a proxy in front of a daemon that records all requests and answers. In the last
// step of `make test`, check-traffic.mjs compares them with the OpenAPI document.
//
// With a proxy, browsers, generated clients and the commands of the README need no recorder of
// their own. The lines have the form of tests/traffic.h. In Accept-Encoding only gzip is passed on
// to the daemon, because node can decompress it to check the bodies.

import { appendFileSync } from 'node:fs';
import { Agent, createServer, request as send } from 'node:http';
import path from 'node:path';

// How many bytes of a JSON body are recorded at most. Of other bodies fewer bytes are enough,
// because they are not checked.
const JSON_BYTES = 1024 * 1024;
const OTHER_BYTES = 4 * 1024;

// Headers that concern one connection only, so that a proxy must not pass them on.
const OWN = new Set(['connection', 'keep-alive']);

// Returns the headers to pass on, as an object: from a list of headers, node would make a chunked
// request even if it has no body.
function forwarded(rawHeaders) {
    const kept = {};
    for (let i = 0; i < rawHeaders.length; i += 2) {
        const [name, value] = [rawHeaders[i], rawHeaders[i + 1]];
        if (!OWN.has(name.toLowerCase())) {
            const known = name.toLowerCase() === 'accept-encoding' ? gzipOf(value) : value;
            kept[name] = kept[name] === undefined ? known : [kept[name], known].flat();
        }
    }
    return kept;
}

function gzipOf(codings) {
    return /\bgzip\b/.test(codings) ? 'gzip' : 'identity';
}

// Collects what is recorded of a request or an answer while it passes through the proxy.
function collect(stream) {
    const json = stream.headers['content-type']?.includes('json');
    const most = json ? JSON_BYTES : OTHER_BYTES;
    const parts = [];
    let kept = 0;
    let length = 0;
    stream.on('data', (part) => {
        length += part.length;
        if (kept < most) {
            parts.push(part.subarray(0, most - kept));
            kept += parts.at(-1).length;
        }
    });
    return () => {
        const { rawHeaders: raw } = stream;
        const lines = raw.flatMap((name, i) => (i % 2 ? [] : [`${name}: ${raw[i + 1]}\r\n`]));
        return { head: lines.join(''), body: Buffer.concat(parts).toString('base64'), length };
    };
}

// Starts a proxy that records into the folder in the variable TRAFFIC, and returns its {url,
// close()}; without that variable, returns the daemon's own address.
export async function recorded(url) {
    const folder = process.env.TRAFFIC;
    if (folder === undefined) {
        return { url, close() {} };
    }
    const { hostname, port } = new URL(url);
    const file = path.join(folder, `web-${process.pid}.ndjson`);
    const agent = new Agent({ keepAlive: true });
    const server = createServer((asked, answered) => {
        const { method, url: target } = asked;
        const headers = forwarded(asked.rawHeaders);
        const request = collect(asked);
        const onward = send({ hostname, port, method, path: target, headers, agent });
        onward.on('response', (upstream) => {
            const answer = collect(upstream);
            upstream.on('end', () => {
                const { statusCode: status } = upstream;
                const line = { method, target, request: request(), status, answer: answer() };
                appendFileSync(file, `${JSON.stringify(line)}\n`);
            });
            upstream.on('error', () => answered.destroy());
            answered.writeHead(upstream.statusCode, forwarded(upstream.rawHeaders));
            upstream.pipe(answered);
        });
        // If the daemon closes its connection without an answer, the proxy closes the client's
        // connection, too.
        onward.on('error', () => asked.socket.destroy());
        answered.on('close', () => onward.destroy());
        asked.pipe(onward);
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return {
        url: `http://127.0.0.1:${server.address().port}`,
        close() {
            server.close();
            server.closeAllConnections();
            agent.destroy();
        },
    };
}
