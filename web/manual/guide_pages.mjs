// guide_pages.mjs - the pages written by hand: getting started, half-edges, the guides, and the pages
// that lead to the others.

import { draw, frameOf } from '../src/manual/drawing.js';
import { noMarks } from '../src/manual/told.js';
import { h } from './html.mjs';
import { blocksOf, inline, stepOf } from './markdown.mjs';
import { code, requestBlock, table } from './parts.mjs';

const slugOf = (text) => text.toLowerCase().replaceAll('`', '').replaceAll(/[^a-z0-9]+/g, '-').replaceAll(/^-|-$/g, '');

// Returns the drawing of a fence ```drawing.
function drawing(mesh, { arrows = '', ids = 'all', view = 'top', picked = '' }, title) {
    const marks = noMarks();
    for (const word of picked.split(',').filter(Boolean)) {
        const [kind, id] = [{ v: 'vertex', e: 'edge', f: 'face' }[word[0]], Number(word.slice(1))];
        marks[kind].set(id, 'picked');
    }
    const list = arrows === 'all'
        ? mesh.halfedges.map(({ id, face }) => ({ id, kind: face === null ? 'hole' : 'plain' }))
        : arrows.split(',').filter(Boolean).map((word) => {
            const [id, name, kind = 'picked'] = word.split(':');
            return { id: Number(id), name: name && `${name} (h${id})`, kind };
        });
    return h('figure', {}, draw(mesh, frameOf([mesh], view), { marks, arrows: list, ids, title }), h('figcaption', {}, inline(title)));
}

function blockNodes(block, next, link) {
    switch (block.type) {
    case 'heading':
        return h(`h${block.level}`, { id: slugOf(block.text) }, inline(block.text, link));
    case 'paragraph':
        return h('p', {}, inline(block.text, link));
    case 'list':
        return h(block.ordered ? 'ol' : 'ul', {}, block.items.map((item) => h('li', {}, inline(item, link))));
    case 'table':
        return table(block.head, block.rows.map((row) => row.map((cell) => inline(cell, link))), block.head[0]);
    default:
        return fenceNodes(block, next);
    }
}

function fenceNodes(block, next) {
    if (block.kind === 'request') {
        return requestBlock(stepOf(block), { answer: next(), options: block.options, edit: 'edit' in block.options });
    }
    if (block.kind === 'drawing') {
        return drawing(next(), block.options, block.text);
    }
    const names = { python: 'Python', js: 'JavaScript', sh: 'Shell', text: 'Text', json: 'JSON' };
    return h('div', { class: 'plain-code' },
        h('p', { class: 'small' }, names[block.kind] ?? block.kind),
        h('pre', { class: 'shown', tabindex: 0 }, h('code', {}, block.text)));
}

// Returns the page of a guide. Its first line is the title, its first paragraph the lead.
function guidePage(slug, { text, answers }, { path, ...place }) {
    const [heading, lead, ...blocks] = blocksOf(text);
    return {
        path,
        title: heading.text,
        lead: lead.text,
        words: blocks.filter(({ type }) => type === 'heading').map((each) => each.text).join(' '),
        kind: 'guide',
        slug,
        ...place,
        body(link) {
            const rest = [...answers];
            return blocks.map((block) => blockNodes(block, () => rest.shift(), link));
        },
    };
}

// The guides in their order; the file of each is guides/NAME.md.
const GUIDES = ['repair', 'files', 'batches', 'history', 'live', 'questions', 'arrays', 'large', 'simplify', 'sets', 'retry', 'errors'];

export function guidePages({ guides, operations, problems, examples }) {
    const names = Object.keys(guides).filter((name) => !['start', 'half-edges'].includes(name));
    if ([...names].sort().join() !== [...GUIDES].sort().join()) {
        throw new Error(`the guides are ${names.join(', ')}, and their order names ${GUIDES.join(', ')}`);
    }
    const start = guidePage('start', guides.start, { path: 'docs/start', group: 'docs/start' });
    const halfEdges = guidePage('half-edges', guides['half-edges'], { path: 'docs/half-edges', group: 'docs/half-edges' });
    const list = GUIDES.map((slug) => guidePage(slug, guides[slug], {
        path: `docs/guides/${slug}`, group: 'docs/guides', crumbs: [{ path: 'docs/guides', title: 'Guides' }],
    }));
    const siblings = list.map(({ path, title }) => ({ path, title }));
    const cards = (pages, link) => h('ul', { class: 'cards' }, pages.map(({ path, title, lead }) => h('li', {},
        h('a', { href: link(`/${path}`) }, h('strong', {}, title)), h('span', { class: 'small' }, inline(lead, link)))));
    const index = {
        path: 'docs/guides',
        title: 'Guides',
        lead: 'One task each, from the first request to the result. Every request on these pages was sent to this release of the server when the page was made.',
        kind: 'list',
        group: 'docs/guides',
        body: (link) => [cards(list, link)],
    };
    const first = {
        path: 'docs',
        title: 'The manual of hedge',
        lead: 'hedge keeps polygon meshes on a server, as half-edges, and edits them over HTTP. This manual teaches it, and has a page for everything that it can do.',
        kind: 'list',
        wide: true,
        body: (link) => [
            h('div', { class: 'doors' },
                h('a', { class: 'door', href: link('/docs/start') }, h('strong', {}, 'Getting started'), h('span', {}, 'Make a mesh, look at it, change it, undo it: five minutes.')),
                h('a', { class: 'door', href: link('/docs/half-edges') }, h('strong', {}, 'Half-edges in ten steps'), h('span', {}, 'What twin, next and prev are, tried on a mesh of your own.')),
                h('a', { class: 'door', href: link('/docs/operations') }, h('strong', {}, `${operations.length} operations`), h('span', {}, 'Each with a drawing, its refusals, and a request to try.'))),
            h('h2', { id: 'guides' }, 'Guides'),
            cards(list, link),
            h('h2', { id: 'reference' }, 'Reference'),
            h('ul', {},
                h('li', {}, h('a', { href: link('/docs/routes') }, 'Routes'), `: the ${Object.keys(examples.routes).length} requests, with parameters and answers.`),
                h('li', {}, h('a', { href: link('/docs/operations') }, 'Operations'), ': the edits.'),
                h('li', {}, h('a', { href: link('/docs/problems') }, 'Problems'), `: the ${problems.length} ways to be refused, and what to do.`),
                h('li', {}, h('a', { href: link('/docs/types') }, 'Types'), ': the objects of requests and answers.'),
                h('li', {}, h('a', { href: link('/v1/openapi.json') }, 'OpenAPI document'), ', from which generators make clients: ', code('/v1/openapi.json'), '.')),
        ],
    };
    return [first, start, halfEdges, index, ...list.map((page) => ({ ...page, siblings }))];
}

// Returns the page that lists all pages, and the page for an address without a page.
export function listPages(pages) {
    const names = { guide: 'Learning and guides', operation: 'Operations', route: 'Routes', problem: 'Problems', type: 'Types' };
    const all = {
        path: 'docs/all',
        title: 'All pages',
        lead: `Every page of this manual: ${pages.length} of them. The search above finds them by any word of their titles.`,
        kind: 'list',
        wide: true,
        body: (link) => Object.entries(names).map(([kind, title]) => [
            h('h2', { id: kind }, title),
            h('ul', { class: 'columns-list' }, pages.filter((page) => page.kind === kind).map((page) =>
                h('li', {}, h('a', { href: link(`/${page.path}`) }, page.title)))),
        ]),
    };
    const missing = {
        path: 'docs/404',
        title: 'There is no such page',
        lead: 'The manual has no page at this address. Perhaps it was spelt differently: search for a word of it.',
        kind: 'missing',
        body: (link) => [h('ul', {},
            h('li', {}, h('a', { href: link('/docs') }, 'The first page of the manual')),
            h('li', {}, h('a', { href: link('/docs/all') }, 'All pages')),
            h('li', {}, h('a', { href: link('/') }, 'The viewer')))],
    };
    return [all, missing];
}
