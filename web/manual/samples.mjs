// samples.mjs - writes a request as a command of curl, and as programs in Python and JavaScript that
// need nothing but what these languages bring along.

import { formatJson } from '../src/manual/json_text.js';

// Where the samples send their requests. The script of the pages replaces it by the address of the
// server that the reader uses.
export const BASE = 'http://127.0.0.1:8080';

export const LANGUAGES = ['curl', 'Python', 'fetch'];

const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;

// Whether a text needs quotes in a shell.
const isPlain = (text) => /^[\w:/.%+=,-]*$/.test(text);

function bodyText(body) {
    return typeof body === 'string' ? body : formatJson(body, { room: 66 });
}

function headersOf({ headers = {}, body }) {
    return body === undefined || headers['Content-Type'] ? headers : { 'Content-Type': 'application/json', ...headers };
}

function methodOf({ method = 'GET' }) {
    return method;
}

function curl(step) {
    const method = methodOf(step);
    const url = BASE + step.path;
    const parts = ['curl'];
    if (step.events !== undefined) {
        parts.push('-N');
    }
    if (method !== 'GET' && !(method === 'POST' && step.body !== undefined)) {
        parts.push(`-X ${method}`);
    }
    const lines = [`${parts.join(' ')} ${isPlain(url) ? url : quoted(url)}`];
    for (const [name, value] of Object.entries(headersOf(step))) {
        lines.push(`-H ${quoted(`${name}: ${value}`)}`);
    }
    if (step.binary) {
        lines.push('-o answer.bin');
    }
    if (step.body !== undefined) {
        lines.push(`--data-binary ${quoted(bodyText(step.body))}`.replace('--data-binary', typeof step.body === 'string' ? '--data-binary' : '-d'));
    }
    return lines.join(' \\\n    ');
}

// Writes a JSON value as Python.
function pythonOf(text) {
    return text.replace(/"(?:[^"\\]|\\.)*"|\b(true|false|null)\b/g, (found, word) =>
        word === undefined ? found : { true: 'True', false: 'False', null: 'None' }[word],
    );
}

function python(step) {
    const method = methodOf(step);
    const url = JSON.stringify(BASE + step.path);
    const headers = headersOf(step);
    const json = step.body !== undefined && typeof step.body !== 'string';
    const args = [url];
    if (step.body !== undefined) {
        args.push(json ? 'data=json.dumps(body).encode()' : 'data=body.encode()');
    }
    if (Object.keys(headers).length > 0) {
        args.push(`headers=${JSON.stringify(headers)}`);
    }
    if (method !== (step.body === undefined ? 'GET' : 'POST')) {
        args.push(`method="${method}"`);
    }
    const isPlainGet = args.length === 1;
    const oneLine = args.join(', ');
    const request = isPlainGet ? url : `Request(${oneLine.length < 68 ? oneLine : `\n    ${args.join(',\n    ')},\n`})`;
    const readsJson = step.reads === 'json';
    const lines = [
        ...(json || readsJson || step.fails ? ['import json'] : []),
        ...(step.fails ? ['from urllib.error import HTTPError'] : []),
        `from urllib.request import ${isPlainGet ? 'urlopen' : 'Request, urlopen'}`,
        '',
        ...(step.body === undefined ? [] : [`body = ${json ? pythonOf(bodyText(step.body)) : `"""${step.body.replaceAll('\\', '\\\\')}"""`}`]),
        ...(isPlainGet ? [] : [`request = ${request}`]),
    ];
    const opened = isPlainGet ? url : 'request';
    const read = step.events !== undefined
        ? ['    for line in answer:', '        print(line.decode(), end="")']
        : readsJson
          ? ['    print(json.load(answer))']
          : step.reads === 'bytes'
            ? ['    data = answer.read()', '    print(len(data), "bytes")']
            : step.reads === 'nothing'
              ? ['    print(answer.status)']
              : ['    print(answer.read().decode())'];
    const block = [`with urlopen(${opened}) as answer:`, ...read];
    if (step.fails) {
        return [...lines, 'try:', ...block.map((line) => `    ${line}`), 'except HTTPError as error:', '    print(json.load(error))'].join('\n');
    }
    return [...lines, ...block].join('\n');
}

function javascript(step) {
    const method = methodOf(step);
    const headers = headersOf(step);
    const options = [];
    if (method !== 'GET') {
        options.push(`  method: '${method}',`);
    }
    if (Object.keys(headers).length > 0) {
        options.push(`  headers: ${JSON.stringify(headers)},`);
    }
    if (step.body !== undefined) {
        const json = typeof step.body !== 'string';
        options.push(json ? `  body: JSON.stringify(${formatJson(step.body, { indent: 2, room: 62 })}),` : `  body: ${JSON.stringify(step.body)},`);
    }
    const url = `'${BASE}${step.path.replaceAll("'", "\\'")}'`;
    const lines = [`const answer = await fetch(${url}${options.length === 0 ? '' : `, {\n${options.join('\n')}\n}`});`];
    if (step.events !== undefined) {
        lines.push(
            'const text = answer.body.pipeThrough(new TextDecoderStream());',
            'for await (const piece of text) {',
            '  console.log(piece);',
            '}',
        );
    } else if (step.reads === 'json' || step.fails) {
        lines.push('console.log(await answer.json());');
    } else if (step.reads === 'bytes') {
        lines.push('const data = await answer.arrayBuffer();', "console.log(data.byteLength, 'bytes');");
    } else if (step.reads === 'nothing') {
        lines.push('console.log(answer.status);');
    } else {
        lines.push('console.log(await answer.text());');
    }
    return lines.join('\n');
}

// Returns how a program reads an answer: as "json", "text", "bytes" or "nothing".
export function readsOf({ media = '', bytes = 1 }) {
    if (bytes === 0) {
        return 'nothing';
    }
    if (/json$/.test(media) && media !== 'application/x-ndjson') {
        return 'json';
    }
    return /^text\/|ndjson|^model\/(obj|x-off|mtl)/.test(media) ? 'text' : 'bytes';
}

// Returns the code of a request in each language. `answer` is the recorded answer, which decides how
// the code reads it.
export function samplesOf(step, answer) {
    const reads = readsOf(answer ?? {});
    const told = { ...step, reads, fails: answer !== undefined && answer.status >= 400, binary: reads === 'bytes' };
    return { curl: curl(told), Python: python(told), fetch: javascript(told) };
}
