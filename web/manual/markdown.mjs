// markdown.mjs - reads the guides, which are written in a small part of Markdown: headings (#, ##),
// paragraphs, lists (-, 1.), tables (|), `code`, **strong**, *emphasis*, [links](path), and fences.
//
// A fence ```request has the method and path in its first line, then headers, then a body in JSON.
// Words after "request" change how it is shown: `pick=a,b` shows only these members of the answer,
// `events=2` reads that many events, `status=422` says that this is the right answer, `lines=3` shows
// the first lines of a text, `quiet` shows the request folded and without its answer. A fence
// ```drawing draws the mesh named `mesh=`, with the half-edges `arrows=0:name,1:name`. Other fences are
// shown as they are; with the word `run`, the tests run them.

import { Html, escape } from './html.mjs';

function optionsOf(words) {
    return Object.fromEntries(words.map((word) => {
        const [, name, value] = /^([a-z]+)(?:=(.*))?$/.exec(word);
        return [name, value ?? true];
    }));
}

// Splits a text into blocks {type, ...}.
export function blocksOf(text) {
    const lines = text.split('\n');
    const blocks = [];
    for (let i = 0; i < lines.length; ) {
        const line = lines[i];
        const fence = /^```(\S*)\s*(.*)$/.exec(line);
        const heading = /^(#+) (.*)$/.exec(line);
        if (fence) {
            const end = lines.indexOf('```', i + 1);
            const words = fence[2].split(/\s+/).filter(Boolean);
            blocks.push({ type: 'fence', kind: fence[1], options: optionsOf(words), text: lines.slice(i + 1, end).join('\n') });
            i = end + 1;
        } else if (heading) {
            blocks.push({ type: 'heading', level: heading[1].length, text: heading[2] });
            i++;
        } else if (/^\s*$/.test(line)) {
            i++;
        } else {
            const isPart = (each) => each !== undefined && !/^\s*$/.test(each) && !/^(```|#)/.test(each);
            let end = i;
            while (isPart(lines[end])) {
                end++;
            }
            blocks.push(...partsOf(lines.slice(i, end)));
            i = end;
        }
    }
    return blocks;
}

function partsOf(lines) {
    if (lines[0].startsWith('|')) {
        const rows = lines.map((line) => line.slice(1, -1).split('|').map((cell) => cell.trim()));
        return [{ type: 'table', head: rows[0], rows: rows.slice(2) }];
    }
    const marker = /^(-|\d+\.) /;
    if (!marker.test(lines[0])) {
        return [{ type: 'paragraph', text: lines.join(' ') }];
    }
    const items = [];
    for (const line of lines) {
        if (marker.test(line)) {
            items.push(line.replace(marker, ''));
        } else {
            items[items.length - 1] += ` ${line.trim()}`;
        }
    }
    return [{ type: 'list', ordered: !lines[0].startsWith('-'), items }];
}

// Reads a fence ```request.
export function stepOf({ text, options }) {
    const [first, ...rest] = text.split('\n');
    const [method, path] = first.split(' ');
    const headers = {};
    while (rest.length > 0 && /^[A-Za-z-]+: /.test(rest[0])) {
        const [, name, value] = /^([A-Za-z-]+): (.*)$/.exec(rest.shift());
        headers[name] = value;
    }
    const content = rest.join('\n').trim();
    const isJson = (headers['Content-Type'] ?? 'json').includes('json');
    return {
        method,
        path,
        ...(Object.keys(headers).length > 0 && { headers }),
        ...(content !== '' && { body: isJson ? JSON.parse(content) : `${content}\n` }),
        ...(options.events && { events: Number(options.events) }),
        ...(options.status && { status: Number(options.status) }),
    };
}

// Returns what must be recorded for a guide, in order: {kind: "request", step} or {kind: "drawing",
// mesh}.
export function requestsOf(text) {
    return blocksOf(text)
        .filter(({ kind }) => kind === 'request' || kind === 'drawing')
        .map((block) => block.kind === 'request'
            ? { kind: 'request', step: stepOf(block) }
            : { kind: 'drawing', mesh: block.options.mesh });
}

// Writes the text of a paragraph as HTML. `link` turns the target of a link into an address.
export function inline(text, link = (target) => target) {
    const parts = text.split(/(`[^`]*`)/);
    const written = parts.map((part) => part.startsWith('`') && part.length > 1
        ? `<code>${escape(part.slice(1, -1))}</code>`
        : escape(part));
    const html = written.join('')
        .replace(/\[((?:[^\]<]|<code>.*?<\/code>)*)\]\(([^)]*)\)/g, (_, words, target) => `<a href="${escape(link(target))}">${words}</a>`)
        .replace(/\*\*([^*]+)\*\*/g, '<strong>$1</strong>')
        .replace(/(^|[\s(])\*([^*\s][^*]*)\*/g, '$1<em>$2</em>');
    return new Html(html);
}
