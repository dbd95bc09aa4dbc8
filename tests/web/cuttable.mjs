// cuttable.mjs - a way to a daemon that a test can cut, as a network does.

import { connect, createServer } from 'node:net';

// {url, cut(), mend(), closers, stop()}: cut() ends all connections and lets none through until
// mend(). What runs beside the page still reaches the daemon itself.
export async function cuttable(t, daemon) {
    const { hostname, port } = new URL(daemon.url);
    const sockets = new Set();
    let isCut = false;
    const server = createServer((socket) => {
        if (isCut) {
            socket.destroy();
            return;
        }
        const onward = connect(Number(port), hostname);
        for (const [one, other] of [[socket, onward], [onward, socket]]) {
            sockets.add(one);
            one.on('error', () => {});
            one.on('close', () => {
                sockets.delete(one);
                other.destroy();
            });
            one.pipe(other);
        }
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    const end = () => sockets.forEach((socket) => socket.destroy());
    t.after(() => {
        end();
        server.close();
    });
    return {
        ...daemon,
        url: `http://127.0.0.1:${server.address().port}`,
        cut() {
            isCut = true;
            end();
        },
        mend() {
            isCut = false;
        },
    };
}
