// soak.mjs - runs a daemon under requests of all kinds for an hour, and checks that its memory does
// not grow.
//
//     node soak.mjs --minutes 60 [--load 0.5] [--faces 400000] [--clients 2] [--seed N]
//     node soak.mjs --rounds 8 --faces 20000
//
// Each client runs rounds of steps (mix.mjs). After a round everything is as it was before it, so
// that the memory that the daemon then holds can be compared. Each minute has a line:
//
//     minute, requests so far and how many of them were refused; meshes and faces held now
//     loaded   MiB resident: the mean of the minute, and the maximum
//     at rest  after a round: MiB resident, MiB that the daemon itself counts, open descriptors
//
// At rest no client sends requests. The daemon returns freed memory to the system a second later,
// and a run of minutes waits for that, every ten seconds.
//
// The second half of the run is judged: the slopes of resident and of counted memory at rest, by
// least squares; how far memory at rest is above its level after the first quarter; the slope of
// the loaded means, if there are ten of them; descriptors; whether every request was answered as
// expected; whether the daemon ended well. A run of less than ten minutes, as in `make test`, has
// wider limits. `--load 0.5` pauses for as long as requests take. The figures of each minute go to
// soak.csv and soak.svg in build/; the slowest requests are listed, and the last line is `N passed,
// N failed`.

import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

import { drawSoak } from './draw.mjs';
import { Mix } from './mix.mjs';
import { Client, Daemon, mebibytes, slowest } from './wire.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const { values: options } = parseArgs({
    options: {
        minutes: { type: 'string' },
        rounds: { type: 'string' },
        load: { type: 'string', default: '1' },
        faces: { type: 'string', default: '400000' },
        clients: { type: 'string', default: '2' },
        seed: { type: 'string', default: process.env.SEED ?? '' },
        hedged: { type: 'string', default: process.env.HEDGED ?? path.join(root, 'build/hedged') },
        out: { type: 'string', default: path.join(root, 'build') },
    },
});

const STEPS = 60; // number of steps in a round
const SAMPLES = 250; // milliseconds between two measurements of the memory under load
// The budget of a mesh for undo. It is so small that it is soon full, because undone edits and
// `compact` leave entries in the history.
const UNDO_BUDGET = '512K';
// How far memory may rise and still count as constant, in MiB, or as a share of the level if that
// is more. In a shorter run the heaps still grow to their usual size, and the histories of the
// keepers still fill their budgets.
const STARTING = options.minutes === undefined ? 0.25 : 1;
const BOUNDS =
    Number(options.minutes ?? 0) < 10
        ? { slope: { share: 0, least: 4 }, counted: { share: 0, least: STARTING } }
        : { slope: { share: 0.01, least: 1 }, counted: { share: 0, least: 0.0625 } };
const REST_ABOVE = 16; // MiB that memory at rest may be above its level after warming up
const LOADED_SLOPE = { share: 0.1, least: 2 };
// How often memory is read at most while the test waits for it to fall: the daemon frees the memory
// for a client only a moment after the client has disconnected.
const MOST_LOOKS = 1000;
const LEFT_BEHIND = 0.0625;
// In a run of minutes the clients pause this often, for as long as the daemon needs to return freed
// memory to the system, which it does in the second after its last work.
const REST_EVERY = 10; // seconds
const MOST_REST = 5;
const REST_NOISE = 0.25; // MiB
const MOST_PROBLEMS = 20;

const seconds = () => performance.now() / 1000;
const seed = Number(options.seed) || Math.floor(Math.random() * 2 ** 31);
const began = seconds();
const daemon = await Daemon.start(options.hedged, ['--undo-budget', UNDO_BUDGET]);
const clients = Array.from(
    { length: Number(options.clients) },
    () => new Client(daemon, Number(options.load)),
);
const mixes = clients.map(
    (client, i) => new Mix(client, `c${i}`, seed + 7919 * i, Number(options.faces) / clients.length),
);
const sum = (of) => clients.reduce((all, client) => all + of(client), 0);
const rests = []; // {time, resident, counted, descriptors} after each round
const minutes = []; // lines of the table
let loaded = []; // samples of the minute

function sample() {
    loaded.push(daemon.memory().resident);
}

// Waits until no more memory is resident than at the earlier rest with the least resident memory.
async function settled() {
    const lowest = Math.min(...rests.map(({ resident }) => resident));
    const until = seconds() + MOST_REST;
    while (seconds() < until && !(daemon.memory().resident <= lowest + REST_NOISE)) {
        await new Promise((resolve) => setTimeout(resolve, SAMPLES));
    }
}

async function look() {
    if (options.minutes !== undefined) {
        if (seconds() - began < (rests.at(-1)?.time ?? -REST_EVERY) + REST_EVERY) {
            return;
        }
        await settled();
    }
    const lowest = Math.min(...rests.map((rest) => rest.counted));
    let counted;
    let looks = 0;
    do {
        const { value } = await clients[0].json('GET', '/v1/meshes', [200]);
        counted = mebibytes(value.memory_bytes);
    } while (counted > lowest + LEFT_BEHIND && ++looks < MOST_LOOKS);
    const { resident, descriptors } = daemon.memory();
    rests.push({ time: seconds() - began, resident, counted, descriptors });
}

const COLUMNS = ['minute', 'requests', 'refused', 'meshes', 'faces', 'loaded', 'most', 'rest',
    'counted', 'files'];
const WIDTHS = [6, 9, 8, 6, 8, 8, 8, 8, 8, 5];
const print = (cells) =>
    console.log(cells.map((cell, i) => String(cell).padStart(WIDTHS[i])).join(' '));

function minuteEnds() {
    const { peak } = daemon.memory(true);
    const mean = loaded.reduce((all, one) => all + one, 0) / loaded.length;
    const rest = rests.at(-1);
    loaded = [];
    if (rest === undefined || Number.isNaN(mean)) {
        return;
    }
    minutes.push({
        minute: minutes.length + 1,
        requests: sum((client) => client.requests),
        refused: sum((client) => client.refused),
        meshes: mixes.reduce((all, mix) => all + 1 + mix.guests.length, 0),
        faces: mixes.reduce((all, mix) => all + mix.live(), 0),
        loaded: mean,
        most: peak,
        rest: rest.resident,
        counted: rest.counted,
        files: rest.descriptors,
    });
    const { minute, requests, refused, meshes, faces, ...sizes } = minutes.at(-1);
    const { loaded: load, most, rest: quiet, counted, files } = sizes;
    const shown = [load, most, quiet, counted].map((mib) => mib.toFixed(2));
    print([minute, requests, refused, meshes, faces, ...shown, files]);
}

// Returns how much `of` grows over the whole list, by least squares.
function growth(list, of) {
    const mean = (value) => list.reduce((all, one) => all + value(one), 0) / list.length;
    const time = mean((one) => one.time);
    const level = mean(of);
    const above = mean((one) => (one.time - time) * (of(one) - level));
    const below = mean((one) => (one.time - time) ** 2);
    const slope = below > 0 ? above / below : 0;
    return { level, grown: slope * (list.at(-1).time - list[0].time) };
}

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

const judged = { passed: 0, failed: 0 };
function judge(holds, what) {
    judged[holds ? 'passed' : 'failed']++;
    console.log(`${holds ? 'ok' : 'FAILED'} ${what}`);
}

const allowed = ({ share, least }, level) => Math.max(share * level, least);

function judgeSlope(name, list, of, bound) {
    const { level, grown } = growth(list, of);
    const most = allowed(bound, level);
    const sign = grown < 0 ? '' : '+';
    judge(grown <= most, `${name}: ${level.toFixed(2)} MiB, ${sign}${grown.toFixed(3)} over the ` +
        `second half (at most +${most.toFixed(2)})`);
}

function judgeAll(status) {
    const half = rests.slice(Math.floor(rests.length / 2));
    const quarter = rests.slice(Math.floor(rests.length / 4), Math.floor(rests.length / 2));
    judgeSlope('resident at rest', half, ({ resident }) => resident, BOUNDS.slope);
    judgeSlope('counted at rest', half, ({ counted }) => counted, BOUNDS.counted);
    const level = median(quarter.map(({ resident }) => resident));
    const highest = Math.max(...half.map(({ resident }) => resident));
    judge(highest <= level + REST_ABOVE, `highest at rest: ${(highest - level).toFixed(2)} MiB above ` +
        `the level after a quarter (at most ${REST_ABOVE})`);
    if (minutes.length >= 20) {
        const timed = minutes.map((line) => ({ ...line, time: line.minute }));
        judgeSlope('loaded, by the minute', timed.slice(timed.length / 2), (one) => one.loaded,
            LOADED_SLOPE);
    }
    const files = half.map(({ descriptors }) => descriptors);
    judge(Math.max(...files) <= Math.max(...quarter.map(({ descriptors }) => descriptors)) + 2,
        `open descriptors: ${Math.min(...files)} to ${Math.max(...files)}`);
    const problems = clients.flatMap((client) => client.problems);
    problems.slice(0, MOST_PROBLEMS).forEach((problem) => console.log(`    ${problem}`));
    judge(problems.length === 0, `${sum((client) => client.requests)} requests answered as expected, ` +
        `${sum((client) => client.refused)} of them by a refusal`);
    judge(status === 0, `the daemon ended with ${status}`);
}

function isOver(round) {
    const tooMany = sum((client) => client.problems.length) > MOST_PROBLEMS;
    return tooMany || (options.minutes !== undefined
        ? seconds() - began >= 60 * Number(options.minutes) && round >= 4
        : round >= Number(options.rounds ?? 8));
}

console.log(`SEED=${seed}`);
await Promise.all(mixes.map((mix) => mix.begin()));
print(COLUMNS);
const ticks = [setInterval(sample, SAMPLES), setInterval(minuteEnds, 60_000)];
let rounds = 0;
for (; !isOver(rounds); rounds++) {
    await Promise.all(
        mixes.map(async (mix) => {
            for (let i = 0; i < STEPS; i++) {
                await mix.step();
            }
            await mix.settle();
        }),
    );
    await look();
}
ticks.forEach(clearInterval);
clients.forEach((client) => client.end());
const status = await daemon.stop();
console.log(`note: ${rounds} rounds of ${mixes.length} clients in ${(seconds() - began).toFixed(0)} s, ` +
    `SEED=${seed}`);
slowest(clients.flatMap((client) => client.slowest)).forEach(({ time, processor, what }) =>
    console.log(`slowest: ${time.toFixed(1)} s, ${processor.toFixed(1)} s of processor, ${what}`));
if (minutes.length > 0) {
    mkdirSync(options.out, { recursive: true });
    const lines = minutes.map((line) => Object.values(line).join());
    writeFileSync(path.join(options.out, 'soak.csv'), `${[COLUMNS.join(), ...lines].join('\n')}\n`);
    writeFileSync(path.join(options.out, 'soak.svg'), drawSoak(minutes));
}
judgeAll(status);
console.log(`${judged.passed} passed, ${judged.failed} failed`);
process.exitCode = judged.failed > 0 ? 1 : 0;
