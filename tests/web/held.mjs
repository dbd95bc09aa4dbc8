// held.mjs - a way to a daemon on which levels of detail come as a test lets them.

import { EventEmitter, once } from 'node:events';
import { createServer, request as send } from 'node:http';

// {url, next(), closers, stop()}: next() is the next answer of levels the page asks for, of which
// it has had nothing yet:
//
//   sendTo(part)  all up to a part of its bytes, 0 to 1
//   end()         no more comes, as if that were all
//   breakOff()    the connection ends
//   closed()      when nobody waits for it any more
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
