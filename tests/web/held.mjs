// held.mjs - a proxy to a daemon that holds back answers with levels of detail, and passes on only
// the part of them that a test allows.

import { EventEmitter, once } from 'node:events';
import { createServer, request as send } from 'node:http';

// Starts the proxy and returns {url, next(), closers, stop()}. next() waits until the page requests
// levels and returns an object that controls the answer, of which nothing is passed on at first:
//
//   sendTo(part)  passes on everything up to a part of its bytes, 0 to 1
//   end()         ends the answer as if it were complete
//   breakOff()    breaks the connection
//   closed()      resolves when the page no longer waits for the answer
export async function holdLevels(t, daemon) {
    const asked = new EventEmitter();
    const server = createServer((request, answer) => {
        if (request.url.endsWith('/progressive')) {
            hold(daemon.url + request.url, answer).then((held) => asked.emit('levels', held));
        } else {
            forward(daemon.url + request.url, request, answer);
        }
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    t.after(() => {
        server.close();
        server.closeAllConnections();
    });
    return {
        ...daemon,
        url: `http://127.0.0.1:${server.address().port}`,
        async next() {
            const [held] = await once(asked, 'levels');
            return held;
        },
    };
}

async function hold(url, answer) {
    const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer());
    let sent = 0;
    return {
        sendTo(part) {
            const end = Math.floor(part * bytes.length);
            answer.write(bytes.subarray(sent, end));
            sent = end;
        },
        end: () => answer.end(),
        breakOff: () => answer.destroy(),
        closed: () => answer.destroyed || once(answer, 'close'),
    };
}

function forward(url, request, answer) {
    const { method, headers } = request;
    const onward = send(url, { method, headers });
    onward.on('response', (upstream) => {
        answer.writeHead(upstream.statusCode, upstream.headers);
        upstream.on('error', () => answer.destroy());
        upstream.pipe(answer);
    });
    onward.on('error', () => answer.destroy());
    answer.on('close', () => onward.destroy());
    request.pipe(onward);
}
