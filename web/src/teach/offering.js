// offering.js - the button that shows the operation in the form step by step. It can be pressed when
// a dry run has found that the operation is possible.

import { enable } from '../kit/dom.js';
import { Problem } from '../wire/api.js';
import { showLesson } from './lesson.js';
import { readRegion } from './region.js';

export class Offering {
    #button;
    #session;
    #actions;
    #operation = null;
    #docs = new Map(); // name of an operation -> what it does, in a sentence

    // `actions` has onApply(operation), which applies the operation to the mesh, and onError(error).
    constructor(button, session, actions) {
        [this.#button, this.#session, this.#actions] = [button, session, actions];
        button.addEventListener('click', () => this.#show().catch(actions.onError));
    }

    // Takes the server's table of operations.
    setOperations(operations) {
        this.#docs = new Map(operations.map(({ name, doc }) => [name, doc]));
    }

    // Says which operation is in the form, if it is possible, or null.
    offer(operation) {
        this.#operation = operation;
        enable(this.#button, operation !== null);
        this.#button.title =
            operation === null ? 'First choose an operation, and the elements that it takes' : '';
    }

    async #show() {
        const operation = this.#operation;
        const { mesh, shown } = this.#session;
        if (operation === null || mesh === null) {
            return;
        }
        const { revision } = shown;
        const region = await readRegion(mesh, operation, shown.summary.counts.faces);
        if (this.#session.mesh === mesh) {
            showLesson({
                operation,
                doc: this.#docs.get(operation.op) ?? '',
                region,
                onApply: () => this.#apply(operation, mesh, revision),
            });
        }
    }

    // Applies the operation, unless another mesh or another revision is shown than the steps are about.
    #apply(operation, mesh, revision) {
        if (this.#session.mesh === mesh && this.#session.shown.revision === revision) {
            this.#actions.onApply(operation);
            return;
        }
        const detail =
            this.#session.mesh === mesh
                ? 'The mesh has changed since its steps were shown. Show them again.'
                : 'Another mesh is open now than the one whose steps were shown.';
        this.#actions.onError(new Problem({ title: 'Not applied', detail }));
    }
}
