// frame.mjs - what all pages of the manual have in common: head, navigation, search, foot.

import { h, write } from './html.mjs';
import { inline } from './markdown.mjs';

export const SECTIONS = [
    { path: 'docs/start', title: 'Getting started' },
    { path: 'docs/half-edges', title: 'Half-edges' },
    { path: 'docs/guides', title: 'Guides' },
    { path: 'docs/operations', title: 'Operations' },
    { path: 'docs/routes', title: 'Routes' },
    { path: 'docs/problems', title: 'Problems' },
    { path: 'docs/types', title: 'Types' },
];

// Returns a function `link` that turns an address such as /docs/start into one relative to a page, and
// link.schema, which returns the address of the page about a schema. The page of missing pages is
// shown at any address, so its links are not relative.
function linker(from, schemas) {
    const up = from === 'docs/404' ? '/' : '../'.repeat(from.split('/').length - 1);
    const link = (target) => (target.startsWith('/') ? up + target.slice(1) || './' : target);
    link.schema = (name) => {
        if (!schemas.has(name)) {
            throw new Error(`the OpenAPI document has no schema ${name}`);
        }
        return link(schemas.get(name));
    };
    return link;
}

// Returns a paragraph of a text with `code` and [links](/docs/...).
export function prose(text, link) {
    return h('p', {}, inline(text, link));
}

// Writes a page {path, title, lead, body, group, siblings}: `group` is a path of SECTIONS, `siblings`
// are the pages {path, title} beside it, in their order. `assets` has the paths of the style, script,
// icon and list of pages, and `schemas`, a map from the names of schemas to the addresses of pages.
export function writePage({ path, title, lead, kind, body, group, siblings = [], wide = false, crumbs = [] }, assets) {
    const link = linker(path, assets.schemas);
    const at = siblings.findIndex((each) => each.path === path);
    const beside = [siblings[at - 1], siblings[at + 1]];
    const current = (each) => (each.path === path ? 'page' : undefined);
    const nav = SECTIONS.map((section) =>
        h('li', {}, h('a', { href: link(`/${section.path}`), 'aria-current': section.path === path ? 'page' : section.path === group ? 'true' : undefined }, section.title)),
    );
    const aside = siblings.length < 2 ? '' : h('nav', { class: 'beside', 'aria-label': 'Pages of this part' },
        h('p', { class: 'small' }, 'In this part'),
        h('ul', {}, siblings.map((each) => h('li', {}, h('a', { href: link(`/${each.path}`), 'aria-current': current(each) }, each.title)))));
    const turn = at < 0 || siblings.length < 2 ? '' : h('nav', { class: 'turn', 'aria-label': 'Next and previous page' },
        beside[0] ? h('a', { href: link(`/${beside[0].path}`), rel: 'prev' }, h('span', {}, 'Previous'), ' ', beside[0].title) : h('span', {}),
        beside[1] ? h('a', { href: link(`/${beside[1].path}`), rel: 'next' }, h('span', {}, 'Next'), ' ', beside[1].title) : '');
    const trail = crumbs.length === 0 ? '' : h('p', { class: 'crumbs' },
        crumbs.map((each, i) => [i > 0 ? ' / ' : '', h('a', { href: link(`/${each.path}`) }, each.title)]));
    const document = h('html', { lang: 'en' },
        h('head', {},
            h('meta', { charset: 'utf-8' }),
            h('meta', { name: 'viewport', content: 'width=device-width, initial-scale=1' }),
            h('meta', { name: 'color-scheme', content: 'light dark' }),
            h('title', {}, path === 'docs' ? 'hedge: the manual' : `${title} - hedge`),
            lead === undefined ? '' : h('meta', { name: 'description', content: lead.replaceAll('`', '').replace(/\[([^\]]*)\]\([^)]*\)/g, '$1') }),
            h('link', { rel: 'icon', href: link(`/${assets.icon}`), type: 'image/svg+xml' }),
            h('link', { rel: 'stylesheet', href: link(`/${assets.style}`) }),
            h('script', { type: 'module', src: link(`/${assets.script}`) })),
        h('body', { 'data-root': path === 'docs/404' ? '/' : link('/'), 'data-index': link(`/${assets.index}`), 'data-missing': kind === 'missing' },
            h('a', { class: 'skip', href: '#content' }, 'Skip to the text'),
            h('header', { class: 'top' },
                h('p', { class: 'brand' }, h('a', { href: link('/docs'), 'aria-current': path === 'docs' ? 'page' : undefined },
                    h('img', { src: link(`/${assets.icon}`), alt: '', width: 22, height: 22 }), 'hedge manual')),
                h('nav', { class: 'sections', 'aria-label': 'Parts of the manual' }, h('ul', {}, nav)),
                h('p', { class: 'tools' }, h('a', { href: link('/docs/all') }, 'All pages'), ' ', h('a', { href: link('/') }, 'Viewer'))),
            h('div', { class: `columns${aside === '' ? ' alone' : ''}` },
                h('main', { id: 'content', class: wide ? 'wide' : undefined },
                    trail, h('h1', {}, title), lead === undefined ? '' : h('p', { class: 'lead' }, inline(lead, link)),
                    body(link), turn),
                aside),
            h('footer', {}, h('p', {}, 'hedge, MIT licence. This manual belongs to the server that shows it. ',
                h('a', { href: link('/v1/openapi.json') }, 'OpenAPI document'), '.'))));
    return `<!doctype html>\n${write(document)}\n`;
}
