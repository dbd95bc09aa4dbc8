// inspector.js - all that the server says of one element, its links to follow.

import { make } from './dom.js';

// Members whose values are ids, and of what.
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

const TITLES = { vertex: 'Vertex', halfedge: 'Half-edge', edge: 'Edge', face: 'Face' };

// Ids of one member shown before a button offers the others.
const MOST = 16;

export class Inspector {
    #title;
    #hint;
    #members;
    #onFollow;

    // `onFollow(kind, id)` is called when a link is clicked.
    constructor({ title, hint, members }, { onFollow }) {
        this.#title = title;
        this.#hint = hint;
        this.#members = members;
        this.#onFollow = onFollow;
    }

    // Show the last of the selected elements.
    show(selection) {
        const last = selection.at(-1);
        this.#title.textContent = last ? `${TITLES[last.kind]} ${last.id}` : 'Nothing selected';
        this.#hint.textContent = hintFor(selection);
        this.#hint.hidden = this.#hint.textContent === '';
        this.#members.hidden = last === undefined;
        this.#members.replaceChildren(
            ...Object.entries(last?.element ?? {}).flatMap(([name, value]) => [
                make('dt', {}, name),
                this.#description(name, value),
            ]),
        );
    }

    #description(name, value) {
        const description = make('dd', { className: Array.isArray(value) ? 'many' : 'one' });
        description.dataset.member = name;
        if (Array.isArray(value)) {
            description.classList.toggle('vector', !(name in LINKS));
            description.append(...value.slice(0, MOST).map((item) => this.#value(name, item)));
            this.#offerRest(description, name, value.slice(MOST));
        } else {
            description.append(this.#value(name, value));
        }
        return description;
    }

    #offerRest(description, name, rest) {
        if (rest.length === 0) {
            return;
        }
        const button = make(
            'button',
            {
                type: 'button',
                className: 'rest',
                onclick: () => button.replaceWith(...rest.map((item) => this.#value(name, item))),
            },
            `${rest.length} more`,
        );
        description.append(button);
    }

    #value(name, value) {
        const kind = LINKS[name];
        if (value === null) {
            return make('span', { className: 'none' }, 'none');
        }
        if (kind === undefined) {
            return make('span', {}, typeof value === 'object' ? JSON.stringify(value) : `${value}`);
        }
        return make(
            'button',
            {
                type: 'button',
                className: 'link',
                'aria-label': `${TITLES[kind]} ${value}`,
                onclick: () => this.#onFollow(kind, value),
            },
            `${value}`,
        );
    }
}

function hintFor(selection) {
    if (selection.length === 0) {
        return 'Click the mesh to pick a face, an edge or a vertex. Shift picks a second one.';
    }
    return selection.length === 1
        ? ''
        : `with ${TITLES[selection[0].kind].toLowerCase()} ${selection[0].id}`;
}
