// acts.js - what can be done with a mesh as a whole: renaming, duplicating and deleting. The
// menu with these actions opens at the open mesh and at each mesh of the list.

import * as api from '../wire/api.js';
import { Ask, field } from '../kit/ask.js';
import { Text } from '../kit/controls.js';
import { Deletions } from './deletions.js';
import { Menu } from '../kit/menu.js';
import { nameInText, storableName } from '../wire/names.js';

export class MeshActs {
    #menu = new Menu();
    #toasts;
    #work;
    #list;
    #deletions;
    #onChange;
    #onOpen;

    // `list` is the MeshList. `onChange()` is called when the meshes have changed, and returns a
    // promise; `onOpen(id)` opens a mesh; `onDeleted(id)` is called after a deletion; `work` shows
    // the progress of a copy, see work.js.
    constructor({ toasts, work, list }, { onChange, onOpen, onDeleted }) {
        [this.#toasts, this.#work, this.#list] = [toasts, work, list];
        [this.#onChange, this.#onOpen] = [onChange, onOpen];
        this.#deletions = new Deletions(toasts, {
            onMark: (id, isLeaving) => list.setLeaving(id, isLeaving),
            onDeleted,
        });
    }

    // Opens the menu of a mesh, {id, name}, at a button.
    open(button, mesh) {
        const run = (act) => () => act().catch((error) => this.#toasts.show(error));
        this.#menu.open(button, `Actions for ${titleOf(mesh)}`, [
            { label: 'Rename', run: run(() => this.#rename(mesh)) },
            { label: 'Duplicate', run: run(() => this.#duplicate(mesh)) },
            this.#deletions.isWaiting(mesh.id)
                ? { label: 'Do not delete', run: run(async () => this.#deletions.undo(mesh.id)) }
                : {
                      label: 'Delete',
                      isGrave: true,
                      run: run(() => this.#deletions.begin(mesh.id, titleOf(mesh))),
                  },
        ]);
    }

    async #rename(mesh) {
        const control = new Text();
        control.node.value = mesh.name;
        new Ask(
            {
                title: `Rename ${titleOf(mesh)}`,
                go: 'Rename',
                onGo: async () => {
                    await api.rename(mesh.id, control.read() ?? null);
                    await this.#onChange();
                },
            },
            field('name', 'Name', control, 'A mesh without a name is shown by its id.'),
        );
        control.node.select();
    }

    async #duplicate(mesh) {
        const title = titleOf(mesh);
        this.#work.start(`Duplicating ${title}`, false);
        try {
            const { id } = await api.copy(mesh.id, copyNameOf(storableName(mesh.name || mesh.id), this.#list.names), this.#work);
            await this.#onChange();
            await this.#onOpen(id);
            this.#toasts.tell('Duplicated', `You are looking at the copy of ${title}.`);
        } finally {
            this.#work.end();
        }
    }
}

// Returns the words by which a sentence calls a mesh: its name, or its id if it has none.
function titleOf({ id, name }) {
    return nameInText(name || id);
}

// Returns a name for the copy of a mesh that is none of `names`: "cube copy", then "cube copy 2".
// Pure.
export function copyNameOf(name, names) {
    const stem = name.replace(/ copy( \d+)?$/, '');
    let made = `${stem} copy`;
    for (let count = 2; names.includes(made); count++) {
        made = `${stem} copy ${count}`;
    }
    return made;
}
