// outcomes.js - says in messages what an operation on the mesh has done, and selects what it has found.

import * as api from '../wire/api.js';
import { PLURALS } from '../geometry/kinds.js';
import { nameInText } from '../wire/names.js';
import { doneOf } from './results.js';
import { madeOf, patchesOf, selectionOf } from './trial.js';

// The kinds of elements by the names of parameters that take one element or a list.
const KINDS = Object.fromEntries(
    Object.entries(PLURALS).flatMap(([one, many]) => [
        [one, one],
        [many, one],
    ]),
);

export class Outcomes {
    #session;
    #toasts;
    #rowOf;
    #nextAfter;

    // `rowOf(name)` returns the row of an operation in the server's table; `nextAfter` is as in
    // Editing.
    constructor(session, toasts, { rowOf, nextAfter }) {
        [this.#session, this.#toasts] = [session, toasts];
        [this.#rowOf, this.#nextAfter] = [rowOf, nextAfter];
    }

    // Says what an operation has done, see results.js; `before` are the counts and `revision` is the
    // revision before it.
    async tellDone(operation, { mesh, before, revision, answer }) {
        const { op: name } = operation;
        const { shown } = this.#session;
        const isKnown = shown.hasFacts && shown.mesh === mesh;
        const summary = isKnown ? shown.summary : await api.getSummary(mesh);
        const isFinal = shown.history.entries[0]?.undoable === false;
        const words = doneOf(this.#rowOf(name), {
            result: answer.results?.[0],
            before,
            after: summary.counts,
        });
        const end = isFinal ? ' This edit cannot be undone.' : '';
        const next = this.#nextAfter(operation, revision);
        this.#toasts.tell(name, `${words ?? madeOf(answer)}${end}`, next);
    }

    // Says what the operation `select` has found, and selects it in the page, so that the forms of
    // other operations are filled with it.
    async showSelected(operation, result) {
        const { into = 'selected', value } = operation;
        const listed = Object.keys(KINDS).find((kind) => kind in operation);
        const isSized = operation.by === 'grow' || operation.by === 'shrink';
        const kind = operation.elements ?? (isSized ? PLURALS[KINDS[listed]] : 'faces');
        const name = value === undefined ? into : `${into}=${value}`;
        const words = selectionOf(result);
        this.#toasts.tell(operation.op, `The set \u201c${nameInText(name)}\u201d of ${kind} has ${words}.`);
        const ids = await api.getSet(this.#session.mesh, kind, into, value);
        const one = Object.entries(PLURALS).find(([, plural]) => plural === kind)[0];
        await this.#session.selection.selectAll(one, ids);
    }

    // Says what the operation `segment` has found, and selects the feature edges in the page, so that
    // the patches can be seen.
    async showPatches(operation, result) {
        const next = this.#nextAfter(operation, this.#session.shown.revision);
        this.#toasts.tell(operation.op, `The faces are divided into ${patchesOf(result)}.`, next);
        if (result.features > 0) {
            const ids = await api.getSet(this.#session.mesh, 'edges', 'feature');
            await this.#session.selection.selectAll('edge', ids);
        }
    }
}
