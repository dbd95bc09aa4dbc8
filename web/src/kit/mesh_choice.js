// mesh_choice.js - a form control for a mesh: another mesh, or an earlier revision of the open one. It
// is like the controls of controls.js.

import { Numeral } from './controls.js';
import { make } from './dom.js';
import { seenName } from '../wire/names.js';

// The value of the option for a revision; no mesh has such an id.
const REVISION = ':revision';

export class MeshChoice {
    node;
    #select;
    #revision;

    // `meshes` is a promise of the list of meshes, {id, name} each.
    constructor(name, meshes) {
        this.#select = make(
            'select',
            { 'aria-label': `${name}: mesh` },
            make('option', { value: '' }, 'which mesh'),
            make('option', { value: REVISION }, 'an earlier revision'),
        );
        this.#revision = new Numeral(name, 'revision', '1');
        const { node } = this.#revision;
        node.setAttribute('aria-label', `${name}: revision`);
        node.min = 1;
        this.node = make('div', { className: 'mesh-choice' }, this.#select, node);
        this.#select.addEventListener('input', () => this.#showField());
        this.#showField();
        meshes.then((items) => {
            this.#select.append(
                ...items.map((item) => make('option', { value: item.id }, seenName(item.name || item.id))),
            );
        });
    }

    get #isRevision() {
        return this.#select.value === REVISION;
    }

    #showField() {
        this.#revision.node.hidden = !this.#isRevision;
    }

    get main() {
        return this.#select;
    }

    get isSaid() {
        return this.#isRevision ? this.#revision.isSaid : this.#select.value !== '';
    }

    clear() {
        this.#select.value = '';
        this.#revision.clear();
        this.#showField();
    }

    // Returns the id of a mesh, the number of a revision, or undefined.
    read() {
        return this.#isRevision ? this.#revision.read() : this.#select.value || undefined;
    }
}
