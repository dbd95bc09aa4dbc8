// named.js - the named sets of the open mesh: bool attributes, which operations take in place of ids.
// They are listed in the panel, and offered in the fields of forms.

import * as api from '../wire/api.js';
import { make } from '../kit/dom.js';
import { nameInText, seenName } from '../wire/names.js';

const DOMAINS = { vertices: 'vertex', edges: 'edge', faces: 'face' };

// Sets are listed again after these operations, which write attributes.
const WRITERS = /attribute|select|segment|append|compact/;

export class NamedSets {
    #elements;
    #acts;
    #sets = []; // {domain, name}
    #reading = 0; // number of the last reading
    #mesh = null;
    #seen = 0; // the revision up to which the history was looked at

    // `form` contains the field `name`; `list` gets the sets. `offers` has a datalist for each
    // domain, which gets their names. `onSave(name)` saves the selection, `onTake({domain, name},
    // also)` selects a set, `onDelete({domain, name})` deletes it; all return promises.
    constructor({ form, name, list, offers }, { onSave, onTake, onDelete, onError }) {
        this.#elements = { form, name, list, offers };
        this.#acts = { onTake, onDelete, onError };
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            const text = name.value.trim();
            onSave(text)
                .then(() => {
                    name.value = '';
                })
                .catch(onError);
        });
    }

    // Called when the mesh `mesh` has changed; `what` is as in the constructor of Session, and
    // `history` is the newest page of the history.
    follow(mesh, what, { revision, entries, next }) {
        if (mesh !== this.#mesh) {
            this.#sets = [];
            this.#show();
        }
        const isNew = mesh !== this.#mesh || what === 'content';
        const unseen = entries.filter((entry) => entry.revision > this.#seen);
        const isLong = next !== null && unseen.length === entries.length;
        const isWritten = unseen.some(({ ops }) => ops.some((op) => WRITERS.test(op)));
        [this.#mesh, this.#seen] = [mesh, revision];
        if (isNew || isLong || isWritten) {
            this.#read().catch((error) => error.status !== 0 && this.#acts.onError(error));
        }
    }

    async #read() {
        const reading = ++this.#reading;
        const { attributes } = await api.getAttributes(this.#mesh);
        if (reading === this.#reading) {
            const isSet = ({ domain, type, components }) =>
                domain in DOMAINS && type === 'bool' && components === 1;
            this.#sets = attributes.filter(isSet).map(({ domain, name }) => ({ domain, name }));
            this.#show();
        }
    }

    #show() {
        const { list, offers } = this.#elements;
        list.replaceChildren(...this.#sets.map((set) => this.#row(set)));
        for (const [domain, offer] of Object.entries(offers)) {
            const names = this.#sets.filter((set) => set.domain === domain).map(({ name }) => name);
            offer.replaceChildren(
                ...['the selection', ...names].map((value) => make('option', { value })),
            );
        }
    }

    #row(set) {
        const { domain, name } = set;
        const { onTake, onDelete, onError } = this.#acts;
        const take = make(
            'button',
            {
                type: 'button',
                className: 'set',
                title: 'Select; with Shift: add to the selection',
                onclick: (event) => onTake(set, event.shiftKey).catch(onError),
            },
            make('span', { dir: 'auto' }, seenName(name)),
            make('span', { className: 'small' }, domain),
        );
        const remove = make(
            'button',
            {
                type: 'button',
                className: 'quiet edits',
                'aria-label': `Delete the set ${nameInText(name)} of ${domain}`,
                onclick: () => onDelete(set).catch(onError),
            },
            '\u00d7',
        );
        return make('li', {}, take, remove);
    }
}

// Returns the kind of element of a set's domain: 'face' for 'faces'.
export function kindOf({ domain }) {
    return DOMAINS[domain];
}
