// editing.js - editing in the page: the form of an operation, with a dry run before it is sent, the
// tools of the view, and keys.

import * as api from '../wire/api.js';
import { Bend } from '../bend/bend.js';
import { Direct } from './direct.js';
import { byId, enable } from '../kit/dom.js';
import { begin, drag } from './gesture.js';
import { Lasso } from '../stage/lasso.js';
import { isIn, markOf, readAll } from '../open/selection.js';
import { Tools } from './tools.js';
import { Trial, patchesOf, selectionOf, wordsOf } from './trial.js';
import { clipMatrixOf } from '../geometry/view.js';
import { Work } from '../kit/work.js';

// An operation on the whole mesh gets no dry run if the mesh has more faces than this.
const MOST_TRIED = 100000;

// If a form's fields contain more elements than this, the view does not mark them. If the operation
// `select` finds more, they are not selected in the page.
const MOST_MARKED = 1000;

// The operation whose form is shown if a tool of the view cannot work on the selected elements, by
// the name of the tool.
const FORMS = { move: 'vertex_move', extrude: 'face_extrude', inset: 'face_inset' };

// The parameter that says how far a tool of the view goes, by the operation that the tool runs.
const AMOUNTS = {
    vertex_move: 'by',
    edge_extrude: 'by',
    face_extrude: 'distance',
    face_inset: 'factor',
};

// The words for the elements that the user has to click, by kind: NAMES for one element, PLURALS
// for several.
const NAMES = { vertex: 'a vertex', halfedge: 'a half-edge', edge: 'an edge', face: 'a face' };
const PLURALS = { vertex: 'vertices', halfedge: 'half-edges', edge: 'edges', face: 'faces' };

// The kinds of elements by the names of parameters that take one element or a list.
const KINDS = Object.fromEntries(
    Object.entries(PLURALS).flatMap(([one, many]) => [
        [one, one],
        [many, one],
    ]),
);

// The operation that the X key runs, by the kind of the selected element.
const REMOVALS = {
    vertex: 'vertex_delete',
    halfedge: 'edge_collapse',
    edge: 'edge_collapse',
    face: 'face_delete',
};

export class Editing {
    #session;
    #stage;
    #toasts;
    #tools;
    #direct;
    #bend;
    #lasso;
    #trial;
    #work;
    #onPicking;
    #nextAfter;
    #marking = 0; // number of the last request for the elements that the form's fields name

    // `onPicking()` is called when a field of the form begins to wait for a click in the view.
    // `onKnown(operation)` is called when a dry run has found that the operation in the form is
    // possible, and with null when that is not known any more. `nextAfter(operation, before)` returns
    // what may be done after an operation on a mesh whose revision was `before`: {label, run}, see
    // Toasts.tell(), or null.
    constructor(canvas, session, stage, toasts, { onPicking, onKnown, nextAfter }) {
        [this.#session, this.#stage, this.#toasts] = [session, stage, toasts];
        this.#onPicking = onPicking;
        this.#nextAfter = nextAfter;
        const onError = (error) => toasts.show(error);
        const onRun = (operation) => this.run(operation).catch(onError);
        this.#work = new Work(
            {
                box: byId('work'),
                label: byId('work-label'),
                progress: byId('work-progress'),
                button: byId('work-cancel'),
            },
            onError,
        );
        this.#trial = new Trial(byId('verdict'), (...asked) => this.#try(...asked), onKnown);
        this.#tools = new Tools(
            {
                select: byId('operation'),
                form: byId('parameters'),
                search: byId('operation-search'),
                all: byId('operation-all'),
                verdict: byId('verdict'),
            },
            {
                onRun,
                onTouch: (operation, error) => {
                    this.#markField();
                    if (error === null) {
                        this.#trial.ask(operation);
                    } else {
                        this.#trial.refuse(error);
                    }
                },
                onArm: (wanted) => this.#showPicking(wanted),
                onDraw: () => this.#drawLasso(),
                meshes: async () => (await api.listMeshes()).items,
                onError,
            },
        );
        this.#bend = new Bend(
            {
                box: byId('bend'),
                toggle: byId('bend-on'),
                row: byId('bend-row'),
                radius: byId('bend-radius'),
                reach: byId('bend-reach'),
                said: byId('bend-said'),
            },
            {
                geometry: () => session.shown.geometry,
                ask: (operation, signal) => api.tryDeform(session.mesh, operation, signal),
                show: (ids, places) => stage.bend(ids, places),
            },
        );
        const buttons = Object.keys(FORMS).map((tool) => [tool, byId(`direct-${tool}`)]);
        this.#direct = new Direct(
            canvas,
            {
                note: byId('direct-note'),
                hint: byId('direct-hint'),
                amount: byId('direct-amount'),
                giveUp: byId('direct-cancel'),
                buttons: Object.fromEntries(buttons),
            },
            {
                begin: (tool) => {
                    const gesture = stage.isThere
                        ? begin(tool, session.selection.chosen, session.shown.geometry)
                        : null;
                    this.#bend.offer(gesture?.op === 'vertex_move');
                    return gesture;
                },
                drag: (gesture, moved) => this.#bend.follow(drag(gesture, stage.view, moved)),
                onShow: (lines) => {
                    stage.preview(lines);
                    if (lines === null) {
                        this.#bend.cancel();
                    }
                },
                onRun: async (operation) => {
                    this.#bend.end();
                    await onRun(operation);
                    this.#bend.settle();
                },
            },
        );
        this.#lasso = new Lasso(
            canvas,
            {
                note: byId('lasso-note'),
                giveUp: byId('lasso-cancel'),
                line: byId('lasso-line'),
            },
            { onDraw: (polygon) => this.#takeLasso(polygon) },
        );
        byId('remove').addEventListener('click', () => this.remove().catch(onError));
        byId('pick-done').addEventListener('click', () => this.#tools.disarm());
        for (const [tool, button] of buttons) {
            button.addEventListener('click', () => this.start(tool, false));
        }
    }

    // Takes the server's table of operations, from which the forms are made.
    setOperations(operations) {
        this.#tools.setOperations(operations);
    }

    setEnabled(isEnabled) {
        this.#tools.setEnabled(isEnabled);
        this.#direct.setEnabled(isEnabled);
        const { last } = this.#session.selection;
        const isCollapse = REMOVALS[last?.kind] === 'edge_collapse';
        byId('remove').textContent = isCollapse ? 'Collapse' : 'Delete';
        enable(byId('remove'), isEnabled && last !== undefined);
    }

    // Called when the selection or the mesh has changed; `what` says what has changed, see the
    // constructor of Session.
    follow(what) {
        this.#tools.setSelection(this.#session.selection.chosen);
        if (what === 'mesh') {
            this.#lasso.cancel();
        }
        if (what === 'mesh' || what === 'selection') {
            this.#direct.cancel();
        } else {
            this.#bend.cancel();
            this.#direct.refresh();
        }
        if (what === 'mesh') {
            this.#trial.clear();
        } else if (what !== 'selection') {
            this.#trial.askAgain();
            this.#markField();
        }
    }

    // --- operations ---

    async #try(operation, signal) {
        const { mesh, shown: content, busy } = this.#session;
        const isDear =
            this.#tools.isWhole(operation.op) && content?.summary.counts.faces > MOST_TRIED;
        if (mesh === null || busy) {
            return null;
        }
        if (isDear) {
            return 'No preview: this operation may take long on a mesh of this size.';
        }
        try {
            return wordsOf(await api.tryEdit(mesh, operation, signal));
        } catch (error) {
            if (!signal.aborted) {
                this.#tools.mark(error.pointer ?? '');
            }
            throw error;
        }
    }

    // Shows the progress of other work on the open mesh. `begin(work)` begins the work and
    // returns a promise of its result.
    async watch(title, begin) {
        this.#work.start(title, false);
        try {
            return await begin(this.#work);
        } finally {
            this.#work.end();
        }
    }

    async run(operation) {
        this.#trial.clear();
        this.#direct.cancel();
        if (!this.#tools.isWhole(operation.op)) {
            await this.#session.run(operation);
            return;
        }
        this.#work.start(operation.op, false);
        const before = this.#session.shown.revision;
        try {
            const answer = await this.#session.run(operation, this.#work);
            const [result] = answer?.results ?? [];
            if (result?.selected !== undefined) {
                await this.#showSelected(operation, result);
                return;
            }
            if (result?.patches !== undefined) {
                await this.#showPatches(operation, result);
                return;
            }
            const { revision, history } = this.#session.shown;
            const isFinal = history.entries[0]?.undoable === false;
            const end = isFinal ? ' This edit cannot be undone.' : '';
            const next = answer === null ? null : this.#nextAfter(operation, before);
            this.#toasts.tell(operation.op, `Done: the mesh is now at revision ${revision}.${end}`, next);
        } finally {
            this.#work.end();
        }
    }

    // Says what the operation `select` has found, and selects it in the page, so that the forms of
    // other operations are filled with it. If it is too much, says how forms can name it instead.
    async #showSelected(operation, result) {
        const { into = 'selected', value } = operation;
        const listed = Object.keys(KINDS).find((kind) => kind in operation);
        const isSized = operation.by === 'grow' || operation.by === 'shrink';
        const kind = operation.elements ?? (isSized ? PLURALS[KINDS[listed]] : 'faces');
        const name = value === undefined ? into : `${into}=${value}`;
        const words = selectionOf(result);
        if (result.selected > MOST_MARKED) {
            const how = `Write \u201c${name}\u201d into a field for ${kind} to use them.`;
            this.#toasts.tell(operation.op, `The set has ${words}. ${how}`);
            return;
        }
        this.#toasts.tell(operation.op, `The set \u201c${name}\u201d of ${kind} has ${words}.`);
        const ids = await api.getSet(this.#session.mesh, kind, into, value);
        const one = Object.entries(PLURALS).find(([, plural]) => plural === kind)[0];
        await this.#session.selection.selectAll(one, ids);
    }

    // Says what the operation `segment` has found, and selects the feature edges in the page, so that
    // the patches can be seen.
    async #showPatches(operation, result) {
        const next = this.#nextAfter(operation, this.#session.shown.revision);
        this.#toasts.tell(operation.op, `The faces are divided into ${patchesOf(result)}.`, next);
        if (result.features > 0 && result.features <= MOST_MARKED) {
            const ids = await api.getSet(this.#session.mesh, 'edges', 'feature');
            await this.#session.selection.selectAll('edge', ids);
        }
    }

    // --- the lasso ---

    #drawLasso() {
        if (this.#stage.isThere) {
            this.#tools.disarm();
            this.#direct.cancel();
            this.#onPicking();
            this.#stage.bringIntoSight();
            this.#lasso.arm();
        }
    }

    #takeLasso(polygon) {
        const { shown } = this.#session;
        if (shown !== null) {
            const matrix = clipMatrixOf(this.#stage.matrix, shown.geometry.frame);
            this.#tools.takeLasso({ matrix, polygon });
        }
    }

    // Deletes or collapses the selected elements; if the operation takes only one element, the
    // element that was selected last.
    async remove() {
        const { chosen, last } = this.#session.selection;
        if (last !== undefined) {
            await this.run(this.#tools.operationOn(REMOVALS[last.kind], chosen));
        }
    }

    // --- clicks and tools of the view ---

    // Handles a click in the view; `chosen` is the element that it hit, see choose(). Fills the
    // form's field that waits for a click, or selects the element if no field waits.
    async pick(chosen, also) {
        if (this.#tools.isArmed) {
            await this.#giveToField(chosen);
        } else {
            await this.#session.selection.pick(chosen, also);
        }
    }

    // Tells the user which field of the form waits for a click; `wanted` describes this field
    // ({name, kind, isList}, see tools.js) and is undefined if no field waits.
    #showPicking(wanted) {
        byId('pick-note').hidden = wanted === undefined;
        if (wanted !== undefined) {
            this.#onPicking();
            const { name, kind, isList } = wanted;
            const what = isList ? PLURALS[kind] : NAMES[kind];
            byId('pick-hint').textContent = `Click ${what} for ${name}.`;
            byId('pick-done').textContent = isList ? 'Done' : 'Cancel';
            this.#direct.cancel();
            this.#stage.setPickMode(kind);
            this.#stage.bringIntoSight();
        }
    }

    // Ends the wait of the form's field that waits for a click, if there is one.
    stopPicking() {
        this.#tools.disarm();
        this.#lasso.cancel();
    }

    async #giveToField(chosen) {
        const { mesh, selection } = this.#session;
        const id = chosen === null ? null : await selection.idOf(chosen);
        if (id !== null) {
            const isVertex = chosen.kind === 'vertex';
            const place = isVertex
                ? (await api.getElement(mesh, 'vertex', id)).position
                : undefined;
            if (this.#tools.isArmed) {
                this.#tools.take(id, place);
            }
        }
    }

    // Marks in the view the elements that the form's fields name and that are not selected.
    async #markField() {
        const { mesh, shown: content, selection } = this.#session;
        const isSelected = ({ kind, id }) =>
            selection.chosen.some((one) => one.kind === kind && one.id === id);
        const wanted = this.#tools.elements.filter((element) => !isSelected(element));
        const marking = ++this.#marking;
        if (mesh === null) {
            return;
        }
        const [found] = await readAll(mesh, wanted.slice(0, MOST_MARKED)).catch(() => [[]]);
        if (marking === this.#marking && content === this.#session.shown && content !== null) {
            const { geometry } = content;
            this.#stage.markField(found.map(markOf).filter((mark) => isIn(geometry, mark)));
        }
    }

    // Starts a tool of the view, or opens the form of its operation if the tool cannot work on the
    // selected elements. While the tool is in use, the form is shown, too, so that the user can
    // give exact numbers. `isKey` says that the user pressed the tool's key and not its button.
    start(tool, isKey) {
        const name = FORMS[tool];
        const isThere = isKey ? this.#direct.arm(tool) : this.#direct.toggle(tool);
        if (!this.#tools.has(name) || !isThere) {
            this.#direct.cancel();
            this.#open(name);
        } else if (
            this.#direct.isArmed &&
            this.#session.selection.last.kind === name.split('_')[0]
        ) {
            this.#tools.show(name);
        }
    }

    // Called when a key was pressed in the view. If the key begins a number and a tool is selected,
    // moves the focus to the form's field for the tool's amount, where the browser then enters the
    // key, and returns true.
    typeAmount(key) {
        const name = this.#direct.operation;
        if (name === null || !/^[-.\d]$/.test(key) || !this.#tools.has(name)) {
            return false;
        }
        this.#direct.cancel();
        this.#tools.show(name);
        if (name === 'face_extrude' && this.#session.selection.chosen.length > 1) {
            this.#tools.tick('region'); // as in a drag, faces that share an edge move together
        }
        return this.#tools.focus(AMOUNTS[name]);
    }

    #open(name) {
        if (this.#tools.has(name)) {
            this.#tools.open(name);
        } else {
            const detail = `This server does not have the operation ${name}.`;
            this.#toasts.show({ title: 'Unknown operation', detail });
        }
    }

    // Handles the Esc key: cancels the lasso or the selected tool; if there is none, stops waiting for a click
    // that fills a field; if no field waits, clears the selection.
    giveUp() {
        if (this.#lasso.isArmed) {
            this.#lasso.cancel();
        } else if (this.#direct.isArmed) {
            this.#direct.cancel();
        } else if (this.#tools.isArmed) {
            this.#tools.disarm();
        } else {
            this.#session.selection.clear();
        }
    }
}
