// statistics.js - shows the server's summary of the open mesh. Nothing is computed here.

import { formatCount, formatNumberOf, make } from '../kit/dom.js';
import { formatSize } from '../kit/units.js';

export class Statistics {
    #sizes;
    #facts;

    constructor({ sizes, facts }) {
        this.#sizes = sizes;
        this.#facts = facts;
    }

    // Shows a summary; `isCurrent` is false if the summary is of an earlier revision than the mesh
    // that is shown.
    show(summary, isCurrent) {
        this.#sizes.replaceChildren(...sizesOf(summary));
        this.#facts.replaceChildren(...factsOf(summary));
        this.#facts.parentElement.setAttribute('aria-busy', `${!isCurrent}`);
    }
}

function sizesOf({ counts }) {
    return ['vertices', 'edges', 'faces'].map((kind) =>
        pair('div', kind, kind, formatCount(counts[kind])),
    );
}

function factsOf(summary) {
    const { counts, euler, closed, manifold, degrees, area, volume, revision } = summary;
    const rows = [
        ['euler', 'Euler characteristic', `${euler}`],
        ['genus', 'Genus', genusOf(summary)],
        ['components', 'Components', formatCount(counts.components)],
        ['boundary_loops', 'Boundary loops', formatCount(counts.boundary_loops)],
        ['isolated_vertices', 'Isolated vertices', formatCount(counts.isolated_vertices)],
        ['closed', 'Closed', closed ? 'yes' : 'no'],
        ['manifold', 'Manifold', manifold ? 'yes' : 'no'],
        ['degrees', 'Face degrees', degreesOf(degrees)],
        ['area', 'Area', formatSize(area, 2)],
        ['volume', 'Volume', closed ? formatSize(volume, 3) : 'not closed'],
        ['revision', 'Revision', `${revision}`],
    ];
    return rows.map(([name, title, value]) => pair('div', name, title, value));
}

// Returns the genus, the number of handles, with what must be known to understand it; or why there is
// none.
function genusOf({ counts, genus, closed }) {
    if (genus === null) {
        return 'none, because parts of the mesh touch only at a vertex (a bow-tie)';
    }
    const { components, boundary_loops: loops } = counts;
    const notes = [
        ...(components > 1 ? [`the sum of ${formatCount(components)} components`] : []),
        ...(closed || loops === 0
            ? []
            : [`as if the ${formatNumberOf(loops, 'hole')} were filled`]),
    ];
    return notes.length === 0 ? `${genus}` : `${genus}, ${notes.join(', ')}`;
}

// Returns the numbers of faces by number of corners, as in "12 × 3, 6 × 4": 12 triangles and 6
// faces with 4 corners.
function degreesOf(degrees) {
    const parts = Object.entries(degrees).map(
        ([degree, count]) => `${formatCount(count)} \u00d7 ${degree}`,
    );
    const more = parts.length > 5 ? ', \u2026' : '';
    return parts.length === 0 ? 'none' : parts.slice(0, 5).join(', ') + more;
}

function pair(tag, name, title, value) {
    const description = make('dd', {}, value);
    description.dataset.statistic = name;
    return make(tag, {}, make('dt', {}, title), description);
}
