// parts.mjs - pieces of several pages: requests with their answers, tables, types in words.

import { alternatives, typeOf } from '../src/wire/schema.js';
import { h } from './html.mjs';
import { formatJson } from '../src/manual/json_text.js';
import { inline } from './markdown.mjs';
import { LANGUAGES, samplesOf } from './samples.mjs';

// A list in an answer that has more items is cut.
const MOST_ITEMS = 24;

const STATUS = {
    200: 'OK', 201: 'Created', 202: 'Accepted', 204: 'No Content', 303: 'See Other', 304: 'Not Modified',
};

export const code = (text) => h('code', {}, text);

// Returns a table. It may be wider than the page, so it can be scrolled, by the keyboard, too. On a
// telephone each row becomes a block, except those of a table of numbers.
export function table(heads, rows, label, kind = 'rows') {
    return h('div', { class: `table ${kind}`, tabindex: 0, role: 'group', 'aria-label': label ?? heads[0] },
        h('table', {},
            h('thead', {}, h('tr', {}, heads.map((head) => h('th', { scope: 'col' }, head)))),
            h('tbody', {}, rows.map((cells) => h('tr', {}, cells.map((cell, i) => h('td', { 'data-head': heads[i] }, cell)))))));
}

// --- requests and answers ---

// Returns an object with only the members that `paths` name, such as "counts" or "forward.upper".
function picked(value, paths) {
    const result = {};
    for (const path of paths) {
        const names = path.split('.');
        let [from, to] = [value, result];
        for (const [i, name] of names.entries()) {
            if (from[name] === undefined) {
                throw new Error(`the answer has no member ${path}`);
            }
            to[name] = i === names.length - 1 ? from[name] : (to[name] ?? {});
            [from, to] = [from[name], to[name]];
        }
    }
    return result;
}

// Returns the text of an answer as readers see it; of an object only the members in `pick`, if given,
// and of a text only the first `lines` lines.
export function answerText({ media, text, bytes }, { pick, lines } = {}) {
    if (bytes === 0) {
        return '';
    }
    if (text.includes('\0') || text.includes('\uFFFD')) {
        return `${bytes} bytes of ${media}`;
    }
    if (/json$/.test(media) && !media.endsWith('ndjson')) {
        const value = JSON.parse(text);
        const written = formatJson(pick === undefined ? value : picked(value, pick.split(',')), { most: MOST_ITEMS });
        if (pick === undefined) {
            return written;
        }
        // What is left out is told after the last member, in the form that the others have.
        return written.endsWith('\n}') ? `${written.slice(0, -2)},\n  …\n}` : `${written.slice(0, -1)}, …}`;
    }
    const parts = text.trimEnd().split('\n').map((line) => (line.length > 400 ? `${line.slice(0, 400)}…` : line));
    const most = Number(lines ?? 40);
    return parts.length > most ? [...parts.slice(0, most), `… ${parts.length - most} more lines`].join('\n') : parts.join('\n');
}

let blocks = 0;

// Returns the code of a request in each language, of which the reader sees one.
function sample(step, answer) {
    const number = blocks++;
    const texts = samplesOf(step, answer);
    const classes = Object.fromEntries(LANGUAGES.map((language) => [language, language.toLowerCase()]));
    return h('fieldset', { class: 'sample' },
        h('legend', { class: 'unseen' }, `Code for ${step.method ?? 'GET'} ${step.path}`),
        LANGUAGES.map((language, i) => [
            h('input', { type: 'radio', class: classes[language], id: `l${number}${classes[language]}`, name: `l${number}`, value: classes[language], checked: i === 0 }),
            h('label', { for: `l${number}${classes[language]}` }, language),
        ]),
        LANGUAGES.map((language) => h('pre', { class: classes[language], tabindex: 0 }, h('code', {}, texts[language]))));
}

// Returns a request as a section: its code, and the recorded answer, which the script replaces when
// the reader runs it. `edit`: the reader may change the body. `run: false`: the reader cannot run it.
// `save` names a job that the request begins.
export function requestBlock(step, { answer, options = {}, edit = false, run = true, shown }) {
    const told = { method: step.method ?? 'GET', path: step.path, headers: step.headers, body: step.body, events: step.events };
    const { quiet } = options;
    const text = shown ?? (answer === undefined || quiet ? undefined : answerText(answer, options));
    const isRefused = answer !== undefined && answer.status >= 400;
    const inner = [
        sample(step, answer),
        text === undefined ? h('div', { class: 'answer', hidden: true }) : h('div', { class: 'answer' },
            answer === undefined ? h('p', { class: 'status' }, 'Answer') :
                h('p', { class: `status${isRefused ? ' refused' : ''}` }, `${answer.status} ${STATUS[answer.status] ?? JSON.parse(answer.text).title}`),
            text === '' ? '' : h('pre', { tabindex: 0 }, h('code', {}, text))),
    ];
    return h('div', {
        class: 'request',
        'data-step': run ? JSON.stringify(told) : undefined,
        'data-edit': edit && run && step.body !== undefined ? '' : undefined,
        'data-pick': options.pick,
    },
    h('p', { class: 'line' }, h('span', { class: `method ${told.method.toLowerCase()}` }, told.method), ' ', h('code', {}, step.path)),
    ...(quiet ? [h('details', {}, h('summary', {}, 'Show the request'), ...inner)] : inner));
}

// Returns the requests that prepare an example, folded, with the number of what they are.
export function setupBlock(steps, words = 'First, make the mesh') {
    if (steps.length === 0) {
        return '';
    }
    return h('details', { class: 'setup' },
        h('summary', {}, steps.length === 1 ? words : `${words} (${steps.length} requests)`),
        steps.map((step) => requestBlock(step, {})));
}

// --- types ---

export function typeNodes(schema, link) {
    return typeOf(schema).map((part) =>
        typeof part === 'string' ? part : h('a', { href: link.schema(part.ref) }, part.ref));
}

export function membersTable({ properties, required = [] }, link) {
    return table(['Member', 'Type', 'Meaning'], Object.entries(properties).map(([name, schema]) => [
        [code(name), required.includes(name) ? h('span', { class: 'must' }, ' required') : ''],
        typeNodes(schema, link),
        inline(schema.description ?? '', link),
    ]), 'Members');
}

// Returns what a schema is, in tables.
export function schemaNodes(schema, link) {
    const choices = alternatives(schema);
    const named = choices.filter((each) => each.$ref);
    return [
        ...choices.filter((each) => each.properties).map((each) => [
            each.description ? h('p', {}, inline(each.description, link)) : '',
            membersTable(each, link),
        ]),
        named.length === 0 ? '' : [
            h('p', {}, schema.allOf ? 'All of these together:' : 'One of these:'),
            h('ul', { class: named.length > 8 ? 'columns-list' : undefined }, named.map((each) => h('li', {}, ...typeNodes(each, link)))),
        ],
        schema.properties && Object.keys(schema.properties).length > 0 ? membersTable(schema, link) : '',
        choices.length === 0 && !schema.properties ? h('p', {}, ...typeNodes(schema, link)) : '',
    ];
}
