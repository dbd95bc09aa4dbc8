// cuttable.mjs - a proxy to a daemon; a test can make it break all connections, like a failure of
// the network.

import { connect, createServer } from 'node:net';

// Starts the proxy and returns {url, cut(), mend(), closers, stop()}: cut() ends all connections
// through the proxy and allows no new ones until mend() is called. The daemon's own address still
// works.
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
