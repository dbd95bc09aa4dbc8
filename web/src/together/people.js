// people.js - the list of the clients that are at the open mesh, with their colours and what they
// have selected, and the name that this page shows to them.

import { PLURALS, SINGULARS } from '../geometry/kinds.js';
import { formatNumberOf, keepFocusIn, make } from '../kit/dom.js';
import { recall, remember } from '../kit/storage.js';

const STORED = 'hedge-name';
const MOST_BYTES = 64; // of a name, as the server allows

export class People {
    #elements;
    #onLook;

    // `list` gets a row for each client, `said` a sentence, `name` is the field with the own name.
    // `onLook(presence)` is called when the user wants to see what a client looks at, and
    // `onName(name)` when the user has changed the own name.
    constructor(elements, { onLook, onName }) {
        const { name } = elements;
        this.#elements = elements;
        this.#onLook = onLook;
        name.value = recall(STORED) ?? '';
        name.addEventListener('change', () => {
            name.value = cut(name.value.trim());
            remember(STORED, name.value);
            onName(name.value);
        });
    }

    get name() {
        return this.#elements.name.value;
    }

    // Shows the clients of Others.besides(). `byToken` is the name of the page's token, which the
    // server shows to others, or null; `isRefused` says that this page is not shown to others.
    show(others, byToken, isRefused) {
        const { section, list, said, label } = this.#elements;
        section.hidden = false;
        label.hidden = byToken !== null;
        said.textContent = isRefused
            ? 'The server does not show you to others now.'
            : others.length === 0
              ? 'Nobody else is at this mesh.'
              : `${formatNumberOf(others.length, 'other')} at this mesh.`;
        keepFocusIn(list, (row) => row.dataset.client, () => {
            list.replaceChildren(...others.map((one) => this.#row(one)));
        });
    }

    #row(presence) {
        const { camera, color } = presence;
        const sample = make('span', { className: 'sample', 'aria-hidden': 'true' });
        sample.style.background = color;
        const button = make(
            'button',
            {
                type: 'button',
                className: 'link',
                title: 'See what they see',
                disabled: camera === undefined,
                onclick: () => this.#onLook(presence),
            },
            make('bdi', {}, nameOf(presence)),
        );
        const row = make('li', {}, sample, button, make('span', { className: 'small' }, wordsOf(presence)));
        row.dataset.client = presence.client;
        return row;
    }
}

// Returns the name under which a client is shown.
export function nameOf({ name, client }) {
    return name || `Guest ${client.slice(0, 4)}`;
}

function wordsOf({ selection }) {
    if (selection === undefined || selection.ids.length === 0) {
        return 'nothing selected';
    }
    const { kind, ids, count } = selection;
    return count === 1
        ? `${SINGULARS[kind]} ${ids[0]}`
        : formatNumberOf(count, SINGULARS[kind], PLURALS[kind]);
}

// Cuts a name to the bytes that the server allows, never inside a character.
function cut(name) {
    let text = name;
    while (new TextEncoder().encode(text).length > MOST_BYTES) {
        text = [...text].slice(0, -1).join('');
    }
    return text;
}
