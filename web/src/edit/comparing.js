// comparing.js - the form that compares the open mesh with another mesh, or with one of its own
// earlier revisions, and shows how far they are apart and where.

import { make } from '../kit/dom.js';
import { formatSize, onUnit } from '../kit/units.js';
import { seenName } from '../wire/names.js';

export class Comparing {
    #elements;
    #callbacks;
    #mesh = null;
    #rows = null; // makes the rows of the result again, or null if there is no result
    #isKept = false; // an edit is running that does not move the faces

    // `form` contains `kind`, a choice of mesh or revision, with the fields `other` and `revision`,
    // and `result`, a list that gets the numbers. `compare(other)` returns a promise of the server's
    // answer, `meshes()` one of the list of meshes; `onPlace(face)` is called when the user wants to
    // see a face of the open mesh, and `color(other)` when the mesh is to be coloured by its distance
    // from the other mesh or revision; it returns a promise.
    constructor(elements, callbacks) {
        const { form, kind, other } = elements;
        this.#elements = elements;
        this.#callbacks = callbacks;
        kind.addEventListener('change', () => this.#showFields());
        other.addEventListener('focus', () => this.#readMeshes().catch(callbacks.onError));
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            this.#run().catch(callbacks.onError);
        });
        onUnit(() => this.#show(this.#rows));
        this.#showFields();
    }

    #show(rows) {
        this.#rows = rows;
        this.#elements.result.replaceChildren(...(rows === null ? [] : rows()));
    }

    // Called when another mesh is opened.
    setMesh(mesh) {
        const { revision } = this.#elements;
        this.#mesh = mesh;
        revision.value = '';
        this.#show(null);
    }

    // Called when the open mesh has changed, so that its faces may be others.
    forget() {
        if (!this.#isKept) {
            this.#show(null);
        }
    }

    #showFields() {
        const { kind, other, revision } = this.#elements;
        const isMesh = kind.value === 'mesh';
        other.hidden = !isMesh;
        other.disabled = !isMesh;
        revision.hidden = isMesh;
        revision.disabled = isMesh;
    }

    async #readMeshes() {
        const { other } = this.#elements;
        const chosen = other.value;
        const items = (await this.#callbacks.meshes()).filter(({ id }) => id !== this.#mesh);
        const options = items.map(({ id, name }) => make('option', { value: id }, seenName(name || id)));
        other.replaceChildren(make('option', { value: '' }, 'which mesh'), ...options);
        other.value = items.some(({ id }) => id === chosen) ? chosen : '';
    }

    async #run() {
        const { kind, other, revision, button } = this.#elements;
        const mesh = this.#mesh;
        button.disabled = true;
        try {
            const asked = kind.value === 'mesh' ? other.value : Number(revision.value);
            const found = await this.#callbacks.compare(asked);
            if (mesh === this.#mesh) {
                const button = this.#colorButton(asked);
                this.#show(() => [...this.#rowsOf(found), button]);
            }
        } finally {
            button.disabled = false;
        }
    }

    // Returns a button that colours the mesh by its distance from what it was compared with. The edit
    // that writes the distances does not change the surface, so the comparison stays.
    #colorButton(other) {
        const button = make('button', { type: 'button', className: 'edits' }, 'Colour by the deviation');
        button.addEventListener('click', async () => {
            button.disabled = true;
            this.#isKept = true;
            try {
                await this.#callbacks.color(other);
            } catch (error) {
                this.#callbacks.onError(error);
            } finally {
                this.#isKept = false;
                button.disabled = false;
            }
        });
        return make('div', {}, make('dt', { className: 'unseen' }, 'Colours'), make('dd', {}, button));
    }

    #rowsOf({ lower, upper, forward, backward }) {
        return [
            row('Largest distance', rangeOf({ lower, upper })),
            row('Mean', formatSize(Math.max(forward.mean, backward.mean))),
            row('Root mean square', formatSize(Math.max(forward.rms, backward.rms))),
            this.#placeRow('From this mesh', forward, forward.place.face),
            this.#placeRow('From the other', backward, backward.place.near_face),
        ];
    }

    // `face` is the face of the open mesh at the place of the largest distance.
    #placeRow(title, side, face) {
        const onclick = () => this.#callbacks.onPlace(face);
        const button = make('button', { type: 'button', className: 'link', onclick }, `face ${face}`);
        return row(title, `${rangeOf(side)} at `, button);
    }
}

// Returns a distance between its two bounds as text, as one number if they look the same.
function rangeOf({ lower, upper }) {
    const [low, high] = [formatSize(lower), formatSize(upper)];
    return low === high ? low : `${low} to ${high}`;
}

function row(title, ...values) {
    return make('div', {}, make('dt', {}, title), make('dd', {}, ...values));
}
