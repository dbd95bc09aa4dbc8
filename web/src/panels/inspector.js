// inspector.js - shows everything the server says about the selected element, with links to other
// elements.

import { formatMeasure, formatNumberOf, make } from '../kit/dom.js';
import { unitText } from '../kit/units.js';
import { PLURALS } from '../geometry/kinds.js';
import { TITLES, linkTo, shortened } from '../kit/element_links.js';
import { explained } from '../kit/words.js';

// The members of an element that are ids of other elements, and the kind of these other elements.
const LINKS = {
    vertex: 'vertex',
    vertices: 'vertex',
    origin: 'vertex',
    target: 'vertex',
    halfedge: 'halfedge',
    halfedges: 'halfedge',
    twin: 'halfedge',
    next: 'halfedge',
    prev: 'halfedge',
    edge: 'edge',
    edges: 'edge',
    face: 'face',
    faces: 'face',
};

// If more elements are selected than this, the hint counts them.
const MOST_NAMED = 24;

// The number of digits with which a measure is shown: so few that three measures fit into a line.
const DIGITS = 5;

export class Inspector {
    #title;
    #hint;
    #gone;
    #members;
    #around;
    #onFollow;
    #heirOf;

    // `onFollow(kind, id)` is called when the link to an element is clicked; `heirOf({kind, id})`
    // returns the element that replaced a deleted element, or null.
    constructor({ title, hint, gone, members, around }, { onFollow, heirOf }) {
        this.#title = title;
        this.#hint = hint;
        this.#gone = gone;
        this.#members = members;
        this.#around = around;
        this.#onFollow = onFollow;
        this.#heirOf = heirOf;
    }

    // Shows the element that was selected last, its neighbours, and those selected elements that
    // were deleted by edits of the mesh, see selection.js.
    show({ chosen: selection, around, gone, crowd }) {
        const last = selection.at(-1);
        this.#gone.hidden = gone.length === 0;
        this.#gone.replaceChildren(...gone.map((element) => this.#farewell(element)));
        this.#title.textContent = last ? `${TITLES[last.kind]} ${last.id}` : titleOf(crowd);
        this.#hint.textContent = crowd === null ? hintFor(selection) : '';
        this.#hint.hidden = this.#hint.textContent === '';
        this.#members.hidden = last === undefined;
        this.#members.replaceChildren(
            ...Object.entries(last?.element ?? {}).flatMap(([name, value]) => [
                make('dt', {}, explained(name)),
                this.#description(name, value, LINKS[name]),
            ]),
        );
        this.#showAround(around ?? { rings: [], measures: [] });
    }

    #farewell({ kind, id, detail }) {
        const line = make('li', {}, `${TITLES[kind]} ${id} is gone: ${detail}.`);
        const heir = this.#heirOf({ kind, id });
        if (heir !== null) {
            const link = this.#value(heir.kind, heir.id);
            link.textContent = `${TITLES[heir.kind]} ${heir.id}`;
            line.append(' Instead: ', link);
        }
        return line;
    }

    #showAround({ rings, measures }) {
        this.#around.parentElement.hidden = rings.length + measures.length === 0;
        this.#around.replaceChildren(
            ...measures.flatMap(({ name, value, power }) => {
                const unit = power === undefined ? '' : unitText(power);
                const description = make('dd', {}, value + unit);
                description.dataset.measure = name;
                return [make('dt', {}, name), description];
            }),
            ...rings.flatMap(({ name, kind, ids }) => {
                const description = this.#description(name, ids, kind);
                delete description.dataset.member;
                description.dataset.ring = name;
                return [make('dt', {}, explained(name)), description];
            }),
        );
    }

    // Returns an element that shows the value of a member; `kind` is the kind of the elements whose
    // ids the value consists of, or undefined if it has no ids.
    #description(name, value, kind) {
        const description = make('dd', { className: Array.isArray(value) ? 'many' : 'one' });
        description.dataset.member = name;
        if (Array.isArray(value)) {
            description.classList.toggle('vector', kind === undefined);
            description.append(...shortened(value, (item) => this.#value(kind, item)));
        } else {
            description.append(this.#value(kind, value));
        }
        return description;
    }

    #value(kind, value) {
        if (value === null) {
            return make('span', { className: 'none' }, 'none');
        }
        if (kind === undefined) {
            return plainValue(value);
        }
        return linkTo(kind, value, this.#onFollow);
    }
}

// Returns an element that shows a value that is no id. Measures are rounded; their title, which is
// shown when the pointer rests on them, has all digits.
function plainValue(value) {
    if (typeof value === 'number' && !Number.isInteger(value)) {
        return make('span', { title: `${value}` }, formatMeasure(value, DIGITS));
    }
    return make('span', {}, typeof value === 'object' ? JSON.stringify(value) : `${value}`);
}

// Returns the title for a selection that has no element to describe; `crowd` is a Crowd or null.
function titleOf(crowd) {
    return crowd === null
        ? 'Nothing selected'
        : formatNumberOf(crowd.count, crowd.kind, PLURALS[crowd.kind]);
}

function hintFor(selection) {
    if (selection.length === 0) {
        return 'Click the mesh to pick an element. Shift and click picks several.';
    }
    const others = selection.slice(0, -1);
    if (others.length === 0) {
        return '';
    }
    const [{ kind }] = others;
    return others.length > MOST_NAMED
        ? `with ${formatNumberOf(others.length, `other ${kind}`, `other ${PLURALS[kind]}`)}`
        : `with ${TITLES[kind].toLowerCase()} ${others.map(({ id }) => id).join(', ')}`;
}
