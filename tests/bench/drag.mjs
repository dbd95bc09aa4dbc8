// drag.mjs - measures how often a second a client gets the positions of a mesh of 50,176 vertices
// while one of them is dragged: POST .../deform through HTTP, one request at a time, as the page
// sends them (web/src/bend).
//
//   node drag.mjs BASE [STEPS]
//
// BASE is the address of a daemon. Every answer is read and has the positions of all vertices that
// follow. The first step also makes the system of equations.

const [base, steps = '60'] = process.argv.slice(2);
const SIDE = 223; // cells; a vertex more
const TARGET = 20;
const BYTES = 28; // of a vertex in the answer

async function post(path, body) {
    const answer = await fetch(`${base}/v1/meshes${path}`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json', Prefer: 'wait=10' },
        body: JSON.stringify(body),
    });
    const bytes = await answer.arrayBuffer();
    if (answer.status !== 200 && answer.status !== 201) {
        throw new Error(`${path}: ${answer.status} ${new TextDecoder().decode(bytes)}`);
    }
    return bytes;
}

// Returns how many milliseconds each of some calls took, ascending.
async function measure(count, act) {
    const times = [];
    for (let i = 0; i < count; i++) {
        const start = performance.now();
        await act(i);
        times.push(performance.now() - start);
    }
    return times.sort((a, b) => a - b);
}

const median = (times) => times[times.length >> 1];
const row = (name, value, unit, end) =>
    console.log(`${name.padEnd(28)} ${value.toFixed(1).padStart(8)} ${unit}${end}`);

await post('?id=drag', { shape: 'grid', columns: SIDE, rows: SIDE });
const along = [...Array(SIDE + 1).keys()];
const rim = along.flatMap((i) => [i, SIDE * (SIDE + 1) + i, i * (SIDE + 1), i * (SIDE + 1) + SIDE]);
const fixed = [...new Set(rim)];
const vertices = [Math.floor(((SIDE + 1) * (SIDE + 2)) / 2)];
const count = (SIDE + 1) ** 2;
const drag = (i) => ({ op: 'deform', method: 'arap', steps: 1, vertices, by: [0, 0, 0.001 * i], fixed });

const [first] = await measure(1, () => post('/drag/deform', drag(0)));
const times = await measure(Number(steps), async (i) => {
    const bytes = await post('/drag/deform', drag(i + 1));
    if (bytes.byteLength !== BYTES * (count - fixed.length)) {
        throw new Error(`${bytes.byteLength} bytes`);
    }
});
const rate = 1000 / median(times);
row('first step of a drag', first, 'ms', '   the system of equations is made');
row('a step, median', median(times), 'ms', `   ${count} vertices, ${times.length} steps`);
row('a step, 95th percentile', times[Math.floor(times.length * 0.95)], 'ms', '');
row('steps', rate, '/s', `     target ${TARGET}   ${rate >= TARGET ? 'met' : 'falls short'}`);
