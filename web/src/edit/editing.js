// editing.js - editing in the page: the form of an operation, with a dry run before it is sent, the
// tools of the view, and keys.

import * as api from '../wire/api.js';
import { Bend } from '../bend/bend.js';
import { Direct } from './direct.js';
import { byId, enable } from '../kit/dom.js';
import { begin, drag } from './gesture.js';
import { PLURALS } from '../geometry/kinds.js';
import { Lasso } from '../stage/lasso.js';
import { isIn, markOf, readAll } from '../open/selection.js';
import { Tools } from './tools.js';
import { expanded, namesSelection } from './expand.js';
import { Outcomes } from './outcomes.js';
import { Trial, madeOf, wordsOf } from './trial.js';
import { clipMatrixOf } from '../geometry/view.js';
import { Work } from '../kit/work.js';

// An operation on the whole mesh gets no dry run if the mesh has more faces than this.
const MOST_TRIED = 100000;

// If a form's fields contain more elements than this, the view does not mark them.
const MOST_MARKED = 1000;

// If more elements are selected than this, an operation on them gets no dry run.
const MOST_TRIED_IDS = 20000;

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

// The words for one element that the user has to click, by kind.
const NAMES = { vertex: 'a vertex', halfedge: 'a half-edge', edge: 'an edge', face: 'a face' };

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
    #outcomes;
    #isEnabled = false;
    #marking = 0; // number of the last request for the elements that the form's fields name

    // `onPicking()` is called when something begins to wait for a click or a drag in the view.
    // `onKnown(operation)` is called when a dry run has found that the operation in the form is
    // possible, and with null when that is not known any more. `nextAfter(operation, before)` returns
    // what may be done after an operation on a mesh whose revision was `before`: {label, run}, see
    // Toasts.tell(), or null.
    constructor(canvas, session, stage, toasts, { onPicking, onKnown, nextAfter }) {
        [this.#session, this.#stage, this.#toasts] = [session, stage, toasts];
        this.#onPicking = onPicking;
        this.#outcomes = new Outcomes(session, toasts, {
            rowOf: (name) => this.#tools.rowOf(name),
            nextAfter,
        });
        const onError = (error) => toasts.show(error);
        const onRun = (operation) => this.run(operation).catch(onError);
        const onApply = (operation) =>
            this.run(operation).catch((error) => this.#tools.refuse(error) || onError(error));
        this.#work = new Work(
            {
                box: byId('work'),
                label: byId('work-label'),
                progress: byId('work-progress'),
                button: byId('work-cancel'),
            },
            onError,
        );
        this.#trial = new Trial(
            byId('verdict'),
            (...asked) => this.#try(...asked),
            (operation) => onKnown(operation && namesSelection(operation) ? null : operation),
        );
        this.#tools = new Tools(
            {
                select: byId('operation'),
                form: byId('parameters'),
                search: byId('operation-search'),
                all: byId('operation-all'),
                verdict: byId('verdict'),
            },
            {
                onRun: onApply,
                onRefuse: (error, isPlain) => this.#trial.refuse(error, isPlain),
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
                meshes: api.meshesToChoose,
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
                        ? begin(tool, session.selection, session.shown.geometry)
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

    // The server's table of operations.
    get operations() {
        return this.#tools.operations;
    }

    setEnabled(isEnabled) {
        this.#isEnabled = isEnabled;
        this.#tools.setEnabled(isEnabled);
        this.#direct.setEnabled(isEnabled);
        const { kind } = this.#session.selection;
        const isCollapse = REMOVALS[kind] === 'edge_collapse';
        const isPossible = kind !== null && this.#tools.operationOn(REMOVALS[kind]) !== null;
        byId('remove').textContent = isCollapse ? 'Collapse' : 'Delete';
        enable(byId('remove'), isEnabled && isPossible);
    }

    // Called when the selection or the mesh has changed; `what` says what has changed, see the
    // constructor of Session.
    follow(what) {
        this.#tools.setSelection(this.#session.selection);
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
            return { words: null, isKnown: false };
        }
        if (isDear) {
            const words = 'No preview: this operation may take long on a mesh of this size.';
            return { words, isKnown: false };
        }
        if (namesSelection(operation) && this.#session.selection.count > MOST_TRIED_IDS) {
            return { words: 'No preview for so many elements.', isKnown: false };
        }
        try {
            const answer = await api.tryEdit(mesh, await expanded(operation, this.#session), signal);
            return { words: wordsOf(answer), isKnown: answer !== null };
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

    // Runs an operation and says what it has done: in a message or, if `isQuiet` is true or the
    // operation is local, below the form.
    async run(operation, isQuiet = false) {
        this.#trial.clear();
        this.#direct.cancel();
        const { shown, mesh } = this.#session;
        const before = shown.hasFacts ? shown.summary.counts : null;
        const isWhole = this.#tools.isWhole(operation.op);
        if (!isWhole && !namesSelection(operation)) {
            const answer = await this.#session.run(operation);
            if (answer !== null) {
                this.#trial.tell(madeOf(answer));
            }
            return;
        }
        this.#work.start(operation.op, false);
        const { revision } = shown;
        try {
            const answer = await this.#session.run(await expanded(operation, this.#session), this.#work);
            const [result] = answer?.results ?? [];
            if (result?.selected !== undefined) {
                await this.#outcomes.showSelected(operation, result);
            } else if (result?.patches !== undefined) {
                await this.#outcomes.showPatches(operation, result);
            } else if (answer !== null && isQuiet) {
                this.#trial.tell(madeOf(answer));
            } else if (answer !== null) {
                await this.#outcomes.tellDone(operation, { mesh, before, revision, answer });
            }
        } finally {
            this.#work.end();
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

    // Whether a drag or a click in the view does something else than to pick an element.
    get isDragging() {
        return this.#lasso.isArmed || this.#direct.isArmed;
    }

    // Stops what waits for a drag or a click in the view.
    stop() {
        this.stopPicking();
        this.#direct.cancel();
    }

    // Deletes or collapses the selected elements; if the operation takes only one element, the
    // element that was selected last.
    async remove() {
        const { kind } = this.#session.selection;
        const operation = kind === null ? null : this.#tools.operationOn(REMOVALS[kind]);
        if (operation !== null) {
            await this.run(operation);
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

    // Whether a field of the form waits for a click.
    get isPicking() {
        return this.#tools.isArmed;
    }

    // Ends the wait of the form's field that waits for a click, if there is one.
    stopPicking() {
        this.#tools.disarm();
        this.#lasso.cancel();
    }

    async #giveToField(chosen) {
        const { mesh, selection } = this.#session;
        if (chosen?.kind !== this.#tools.wantedKind) {
            return; // the mode in which clicks pick was changed meanwhile
        }
        const id = await selection.idOf(chosen);
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
        if (!this.#isEnabled) {
            return;
        }
        this.#onPicking();
        const isThere = isKey ? this.#direct.arm(tool) : this.#direct.toggle(tool);
        if (!this.#tools.has(name) || !isThere) {
            this.#direct.cancel();
            this.openForm(name);
        } else if (
            this.#direct.isArmed &&
            this.#session.selection.kind === name.split('_')[0]
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
        if (name === 'face_extrude' && this.#session.selection.count > 1) {
            this.#tools.tick('region'); // as in a drag, faces that share an edge move together
        }
        return this.#tools.focus(AMOUNTS[name]);
    }

    // Shows the form of an operation and moves the focus there.
    openForm(name) {
        if (this.#tools.has(name)) {
            this.#tools.open(name);
        } else {
            const detail = `This server does not have the operation ${name}.`;
            this.#toasts.show({ title: 'Unknown operation', detail });
        }
    }

    // Handles the Esc key: cancels the lasso or the selected tool; if there is none, stops waiting for
    // a click that fills a field; if no field waits, clears the selection.
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
