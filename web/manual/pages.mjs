// pages.mjs - makes the files of the manual from what record.mjs has written.

import { writePage } from './frame.mjs';
import { guidePages, listPages } from './guide_pages.mjs';
import { operationPages } from './operation_pages.mjs';
import { problemPages, routePages, schemaPathsOf, typePages } from './reference_pages.mjs';

// Returns the pages {path, title, lead, words, kind, ...} of the manual.
export function pagesOf(recorded) {
    const pages = [
        ...guidePages(recorded),
        ...operationPages(recorded),
        ...routePages(recorded),
        ...problemPages(recorded),
        ...typePages(recorded),
    ];
    return [...pages, ...listPages(pages)];
}

// Returns the list in which the search looks: [title, path, kind, label, words] for each page.
export function indexOf(pages) {
    return pages
        .filter(({ kind }) => kind !== 'missing')
        .map(({ title, path, kind, label = '', lead = '', words = '' }) => [title, path, kind, label, `${lead} ${words}`.slice(0, 240)]);
}

// Returns the files of the pages as a map from names to texts. `assets` has the paths of the style, the
// script, the icon and the list in which the search looks.
export function filesOf(pages, recorded, assets) {
    const all = { ...assets, schemas: schemaPathsOf(recorded) };
    return new Map(pages.map((page) => [`${page.path}.html`, writePage(page, all)]));
}
