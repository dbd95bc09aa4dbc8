// requests.js - lets readers change and run the requests of a page.

import { make } from '../kit/dom.js';
import { draw, frameOf } from './drawing.js';
import { formatJson } from './json_text.js';
import { Runner } from './runner.js';
import { idsOf, listedSets, markSets, noMarks, sentenceOf } from './told.js';

// A list in an answer that has more items is cut.
const MOST_ITEMS = 24;
const SVG = 'http://www.w3.org/2000/svg';

// Builds the elements of a drawing.
function nodeOf([tag, attributes, children]) {
    const node = document.createElementNS(SVG, tag);
    Object.entries(attributes).forEach(([name, value]) => node.setAttribute(name, value));
    node.append(...children.map((child) => (typeof child === 'string' ? child : nodeOf(child))));
    return node;
}

function textOf({ media, text, bytes }) {
    if (bytes === 0) {
        return '';
    }
    if (/json$/.test(media) && !media.endsWith('ndjson')) {
        return formatJson(JSON.parse(text), { most: MOST_ITEMS });
    }
    return /[\0\uFFFD]/.test(text) ? `${bytes} bytes of ${media}` : text.trimEnd();
}

const NAMES = { 200: 'OK', 201: 'Created', 202: 'Accepted', 204: 'No Content', 304: 'Not Modified' };

function statusOf({ status, media, text }) {
    const title = media === 'application/problem+json' ? JSON.parse(text).title : (NAMES[status] ?? '');
    return `${status} ${title}`;
}

// One request of the page.
class Request {
    constructor(element) {
        this.element = element;
        this.step = JSON.parse(element.dataset.step);
        this.answer = element.querySelector('.answer');
        this.button = make('button', { type: 'button', className: 'run' }, 'Run');
        this.wrong = make('p', { className: 'wrong', role: 'alert' });
        this.field = null;
        const bar = make('p', { className: 'bar' }, this.button);
        if ('edit' in element.dataset) {
            this.addField(bar);
        }
        const inner = element.querySelector('details') ?? element;
        inner.insertBefore(bar, this.answer);
        bar.after(this.wrong);
    }

    // Adds a field for the body of the request, which the reader may change.
    addField(bar) {
        const { body } = this.step;
        const text = typeof body === 'string' ? body : formatJson(body, { room: 66 });
        const lines = text.split('\n').length;
        this.field = make('textarea', { value: text, rows: Math.min(Math.max(lines, 2), 14), spellcheck: false });
        this.field.setAttribute('aria-label', `Body of ${this.step.method} ${this.step.path}`);
        const summary = make('summary', {}, 'Change the body');
        bar.append(make('details', { className: 'change' }, summary, this.field));
    }

    // Returns the request as the reader wants it. Throws if a changed body is not JSON, unless the
    // example has a body that is no JSON, too.
    read() {
        if (this.field === null || typeof this.step.body === 'string') {
            return { ...this.step, ...(this.field && { body: this.field.value }) };
        }
        try {
            return { ...this.step, body: JSON.parse(this.field.value) };
        } catch (error) {
            throw new Error(`The body is not JSON: ${error.message}`);
        }
    }

    show(answer) {
        const text = textOf(answer);
        const status = make('p', { className: answer.status >= 400 ? 'status refused' : 'status' }, statusOf(answer), make('span', { className: 'live' }, ' from this server'));
        const shown = text === '' ? [] : [make('pre', { tabIndex: 0 }, make('code', {}, text))];
        this.answer.hidden = false;
        this.answer.replaceChildren(status, ...shown);
    }
}

// Draws what the reader's edit has done in place of the drawings of the page.
function redraw(figure, before, after, answer) {
    const { created, deleted } = JSON.parse(answer.text);
    const frame = frameOf([before, after], figure.dataset.view);
    const [gone, made] = [listedSets(deleted), listedSets(created)];
    const { view } = figure.dataset;
    const [lost, won] = [markSets(noMarks(), deleted, 'gone'), markSets(noMarks(), created, 'new')];
    const drawn = [
        draw(before, frame, { marks: lost, ids: idsOf(before, view, lost), title: sentenceOf('Before your edit', before) }),
        draw(after, frame, { marks: won, ids: idsOf(before, view, won), title: sentenceOf('After your edit', after, made && ` New: ${made}.`) }),
    ];
    figure.querySelectorAll('svg').forEach((old, i) => old.replaceWith(nodeOf(drawn[i])));
    const words = [gone && `Deleted: ${gone}.`, made && `New: ${made}.`].filter(Boolean).join(' ');
    figure.querySelector('figcaption').textContent = `Your edit. ${words}`;
}

async function run(runner, requests, at, figure) {
    const request = requests[at];
    request.button.disabled = true;
    request.wrong.textContent = '';
    try {
        const steps = requests.slice(0, at + 1).map((each) => each.read());
        const mesh = /^\/v1\/meshes\/(try-[a-z]+)\/edits$/.exec(request.step.path)?.[1];
        const draws = figure !== null && mesh !== undefined;
        let before = null;
        const answer = await runner.run(steps, async () => {
            before = draws ? await runner.picture(mesh) : null;
        });
        request.show(answer);
        const after = draws && answer.status === 200 ? await runner.picture(mesh) : null;
        if (before !== null && after !== null) {
            redraw(figure, before, after, answer);
        }
    } catch (error) {
        request.wrong.textContent = error.message;
    }
    request.button.disabled = false;
    request.button.focus();
}

// Gives each request of the page its button. Running one sends all requests before it first, because
// they make what it needs.
export function startRequests(root) {
    const runner = new Runner(root);
    const requests = [...document.querySelectorAll('.request[data-step]')].map((element) => new Request(element));
    const figure = document.querySelector('figure[data-operation]');
    requests.forEach((request, at) => {
        request.button.addEventListener('click', () => run(runner, requests, at, figure));
    });
}
