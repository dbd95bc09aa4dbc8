// check-traffic.mjs FOLDER - checks that all requests and answers that were recorded in the files
// of FOLDER agree with the daemon's OpenAPI document, and that every operation of the document was
// used. The document is taken from an answer in these files. All exchanges with the same method,
// path and status count as one test, because their number depends on how threads and frames
// happened to run; the last line is `N passed, N failed`.

import { createReadStream } from 'node:fs';
import { readdir } from 'node:fs/promises';
import path from 'node:path';
import { createInterface } from 'node:readline';

import { Contract } from './contract.mjs';

const SHOWN_BYTES = 200; // of a request's target or body, at most
const SHOWN_WRONGS = 5; // exchanges of one test that are shown, at most

const folder = process.argv[2];
const names = (await readdir(folder)).filter((name) => name.endsWith('.ndjson')).sort();

async function* exchanges() {
    for (const name of names) {
        const lines = createInterface({ input: createReadStream(path.join(folder, name)) });
        for await (const line of lines) {
            yield JSON.parse(line);
        }
    }
}

async function findDocument() {
    for await (const { method, target, status, answer } of exchanges()) {
        const plain = !/^content-encoding:/im.test(answer.head);
        if (method === 'GET' && target === '/v1/openapi.json' && status === 200 && plain) {
            const bytes = Buffer.from(answer.body, 'base64');
            if (bytes.length < answer.length) {
                throw new Error(`only ${bytes.length} bytes of the document were kept`);
            }
            return JSON.parse(bytes);
        }
    }
    return undefined;
}

function textOf({ body }) {
    return Buffer.from(body ?? '', 'base64').toString().slice(0, SHOWN_BYTES);
}

function show({ method, target, status, request, answer }, wrong) {
    console.log(`    ${method} ${target.slice(0, SHOWN_BYTES)}: ${wrong.join('; ')}`);
    console.log(`        asked: ${textOf(request)}\n        said: ${status} ${textOf(answer)}`);
}

async function checkAll(contract) {
    const wrongs = new Map();
    let count = 0;
    for await (const exchange of exchanges()) {
        const { name, wrong } = contract.check(exchange);
        count += 1;
        wrongs.set(name, (wrongs.get(name) ?? 0) + (wrong.length > 0 ? 1 : 0));
        if (wrong.length > 0 && wrongs.get(name) <= SHOWN_WRONGS) {
            console.log(`FAILED ${name}`);
            show(exchange, wrong);
        }
    }
    const unreached = contract.unreached();
    for (const name of unreached) {
        console.log(`FAILED ${name}: no exchange reached it`);
    }
    console.log(`note: ${count} exchanges, ${contract.operations.length} operations`);
    const failed = [...wrongs.values()].filter((each) => each > 0).length;
    return [wrongs.size - failed, failed + unreached.length];
}

const document = await findDocument();
if (document === undefined) {
    console.log('FAILED no exchange was recorded that fetched /v1/openapi.json');
}
const [passed, failed] = document === undefined ? [0, 1] : await checkAll(new Contract(document));
console.log(`${passed} passed, ${failed} failed`);
process.exitCode = failed === 0 ? 0 : 1;
