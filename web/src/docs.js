// docs.js - the script of the pages of the manual. The pages are complete without it: it adds the
// search, the buttons that copy and run, and the way from old addresses to new ones.

import './look/theme.js';
import { startRequests } from './manual/requests.js';
import { startSamples } from './manual/samples.js';
import { Search } from './manual/search.js';

const { root, index } = document.body.dataset;

// The manual was one page once, and its sections had addresses such as docs#create_mesh. Returns the
// page that has taken the place of a section, or null.
function pageOf(section) {
    // op_size is a type, all other schemas with such a name belong to operations.
    const schema = /^schema-(?:(op|done)_(?!size$))?(.+)$/.exec(section);
    if (schema) {
        return `docs/${schema[1] === undefined ? 'types' : 'operations'}/${schema[2]}`;
    }
    if (section === 'refusals') {
        return 'docs/problems';
    }
    return /^[a-z]+(_[a-z]+)+$/.test(section) ? `docs/routes/${section}` : null;
}

// Returns the words of a part of an address; it may be anything.
function wordsOf(part) {
    try {
        return decodeURIComponent(part).replaceAll(/[-_]+/g, ' ');
    } catch {
        return '';
    }
}

const section = location.hash.slice(1);
const moved = section !== '' && document.getElementById(section) === null ? pageOf(section) : null;
if (moved !== null && /\/docs$/.test(location.pathname)) {
    location.replace(new URL(root + moved, document.baseURI));
} else {
    const search = new Search(root, index);
    document.querySelector('.tools').before(search.element);
    startSamples(root);
    startRequests(root);
    if (document.body.dataset.missing !== undefined) {
        // What was asked for is probably nearly right.
        search.field.value = wordsOf(location.pathname.split('/').at(-1));
        search.field.focus();
    }
}
