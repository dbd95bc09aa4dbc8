// guide.js - the examples with a guide: a dialog to choose one, and a note in the view that says what
// each step does and leads to the next one. An example works on a mesh of its own, which stays in the
// list when the guide ends.

import * as api from '../wire/api.js';
import { enable, make } from '../kit/dom.js';
import { EXAMPLES } from './examples.js';

export class Guide {
    #nodes;
    #session;
    #actions;
    #example = null;
    #mesh = null;
    #at = 0;
    #busy = false;

    // `nodes` are {box, title, text, next, end}: the note and what is in it. `actions` has
    // onMade(summary), which opens a new mesh, onRun(operations), which applies operations to the
    // open mesh in one step, and onError(error).
    constructor(nodes, session, actions) {
        [this.#nodes, this.#session, this.#actions] = [nodes, session, actions];
        nodes.next.addEventListener('click', () => this.#next().catch(actions.onError));
        nodes.end.addEventListener('click', () => this.end());
    }

    // Opens the dialog with the list of examples.
    choose() {
        const dialog = make(
            'dialog',
            { className: 'examples', 'aria-labelledby': 'examples-title' },
            make(
                'div',
                { className: 'panel-head' },
                make('h2', { id: 'examples-title' }, 'Examples with a guide'),
                make('button', { type: 'button', className: 'quiet', onclick: () => dialog.close() }, 'Close'),
            ),
            make(
                'p',
                { className: 'small' },
                'Each example makes a mesh of its own and explains what happens to it, step by step. Every ' +
                    'operation can be shown step by step on your own mesh, too: choose it in the panel Edit, ' +
                    'fill its form, and press \u201cShow step by step\u201d.',
            ),
            make('ul', {}, ...EXAMPLES.map((example) => this.#row(example, () => dialog.close()))),
        );
        dialog.addEventListener('close', () => dialog.remove());
        document.body.append(dialog);
        dialog.showModal();
    }

    #row(example, close) {
        const onclick = () => {
            close();
            this.#begin(example).catch(this.#actions.onError);
        };
        return make(
            'li',
            {},
            make(
                'button',
                { type: 'button', className: 'example', onclick },
                make('strong', {}, example.title),
                make('span', {}, example.about),
            ),
        );
    }

    // Called when another mesh is opened. The guide ends if it is not that of its example.
    follow(mesh) {
        if (this.#mesh !== null && mesh !== this.#mesh) {
            this.end();
        }
    }

    end() {
        [this.#example, this.#mesh] = [null, null];
        this.#nodes.box.hidden = true;
    }

    async #begin(example) {
        this.end();
        const summary = await api.create(example.document, null);
        [this.#example, this.#mesh, this.#at] = [example, summary.id, 0];
        await this.#actions.onMade(summary);
        if (this.#mesh !== summary.id) {
            return; // the guide was ended, or another example begun
        }
        this.#show();
        this.#nodes.next.focus({ preventScroll: true });
    }

    #show() {
        const { box, title, text, next } = this.#nodes;
        const { title: name, steps } = this.#example;
        box.hidden = false;
        title.textContent = `${name}: ${this.#at + 1} of ${steps.length}`;
        text.textContent = steps[this.#at].text;
        const isLast = this.#at === steps.length - 1;
        next.textContent = steps[this.#at].while === undefined ? 'Next' : 'Next flip';
        next.hidden = isLast;
    }

    async #next() {
        if (this.#busy || this.#example === null) {
            return;
        }
        this.#busy = true;
        enable(this.#nodes.next, false);
        try {
            const { steps } = this.#example;
            const again = await steps[this.#at].while?.(await readTriangles(this.#mesh));
            const mesh = this.#mesh;
            const at = again ? this.#at : this.#at + 1;
            await this.#act(steps[at].act);
            // If the step has failed, the guide stays where it was.
            if (mesh !== null && mesh === this.#mesh) {
                this.#at = at;
                this.#show();
            }
        } finally {
            this.#busy = false;
            enable(this.#nodes.next, true);
        }
    }

    async #act(act) {
        if (act?.edit !== undefined) {
            const { edit } = act;
            const operations = typeof edit === 'function' ? edit(await readTriangles(this.#mesh)) : edit;
            if (operations !== null) {
                await this.#actions.onRun(operations);
                const [{ edge }] = operations;
                await (edge === undefined
                    ? this.#session.selection.clear()
                    : this.#session.selection.select('edge', edge));
            }
        } else if (act?.select !== undefined) {
            await this.#session.selection.selectAll(act.select.kind, act.select.ids);
        } else if (act?.press !== undefined) {
            document.getElementById(act.press).click();
        }
    }
}

// Reads a small mesh as flips.js needs it.
async function readTriangles(mesh) {
    const [vertices, edges, faces] = await Promise.all(
        ['vertices', 'edges', 'faces'].map((kind) => api.getElements(mesh, kind)),
    );
    return {
        points: new Map(vertices.map(({ id, position }) => [id, position])),
        faces: new Map(faces.map(({ id, vertices: corners }) => [id, corners])),
        edges: new Map(edges.map((edge) => [edge.id, edge])),
    };
}
