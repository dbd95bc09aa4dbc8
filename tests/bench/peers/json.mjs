// json.mjs - the program of the JSON rows that runs in node; side.h describes its input and output.
// The document is a string in memory before it is parsed, and again a string after it is written.

import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';

const [, , , , , folder] = process.argv;

const seconds = () => {
    const { user, system } = process.cpuUsage();
    return (user + system) / 1e6;
};

const rows = {
    json_read(text) {
        const start = seconds();
        const document = JSON.parse(text);
        return { value: seconds() - start, document };
    },
    json_print(text) {
        const document = JSON.parse(text);
        const start = seconds();
        const printed = JSON.stringify(document);
        return { value: seconds() - start, amount: printed.length, document };
    },
};

// Combines counts into 64 bits as bench_counts of side.h does.
const counts = ({ vertices, faces }) =>
    [0, vertices.length, 0, faces.length].reduce(
        (hash, count) => BigInt.asUintN(64, hash * 0x9e3779b97f4a7c15n + BigInt(count)),
        0n,
    );

for await (const name of createInterface({ input: process.stdin })) {
    if (!(name in rows)) {
        console.log('unknown');
        continue;
    }
    const text = readFileSync(`${folder}/input.json`, 'utf8');
    const { value, amount = text.length, document } = rows[name](text);
    const exact = counts(document).toString(16).padStart(16, '0');
    console.log(`${value} ${amount} ${exact} -`);
}
