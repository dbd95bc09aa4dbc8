// select.js - the tools that select many elements: by drawing in the view, by the selection's
// neighbours, along loops and rings, and as named sets.

import * as api from '../wire/api.js';
import { byId, enable, formatCount, formatNumberOf } from '../kit/dom.js';
import { allOf, noneOf, sizeOf } from '../geometry/sets.js';
import { inside, polygonMask } from '../geometry/region.js';
import { Lasso } from '../stage/lasso.js';
import { formatSize, onUnit } from '../kit/units.js';
import { nameInText } from '../wire/names.js';
import { Crowd } from '../open/crowd.js';
import { PLURALS, SINGULARS } from '../geometry/kinds.js';
import { Brush, Stroke } from './paint.js';
import { CHANGES, around, combined } from './changes.js';
import { Hover } from './hover.js';
import { NamedSets, kindOf } from './named.js';

const DRAWN = ['box', 'lasso', 'paint'];

// Loops and rings of at most this many selected edges are found at once.
const MOST_LINES = 50;

export class Select {
    #session;
    #stage;
    #acts;
    #lasso;
    #brush;
    #sets;
    #tool = null; // 'box', 'lasso' or 'paint'
    #isReady = false;

    // `isFree()` returns whether clicks in the view pick elements; `onArm()` is called before a tool
    // that draws is armed.
    constructor(canvas, session, stage, { isFree, onArm, onTell, onError }) {
        [this.#session, this.#stage] = [session, stage];
        this.#acts = { onArm, onTell, onError };
        this.#lasso = new Lasso(
            canvas,
            { note: byId('select-note'), giveUp: byId('select-done'), line: byId('select-line') },
            { onDraw: (corners, event) => this.#takeArea(corners, event) },
        );
        this.#brush = new Brush(canvas, byId('brush-ring'), {
            begin: (event) => this.#beginStroke(howOf(event)),
            show: (stroke) => this.#showStroke(stroke),
            end: (stroke) => this.#choose(stroke.kind, stroke.read(true), stroke.how),
            radius: () => Number(byId('brush-size').value),
        });
        new Hover(canvas, byId('hover-line'), stage, {
            content: () => session.shown,
            isFree: () => this.#tool === null && isFree(),
        });
        this.#sets = new NamedSets(
            {
                form: byId('set-form'),
                name: byId('set-name'),
                list: byId('sets'),
                offers: {
                    vertices: byId('sets-vertices'),
                    edges: byId('sets-edges'),
                    faces: byId('sets-faces'),
                },
            },
            {
                onSave: (name) => this.#save(name),
                onTake: (set, also) => this.#take(set, also),
                onDelete: (set) => session.deleteSet(set),
                onError,
            },
        );
        this.#listen();
    }

    #listen() {
        for (const tool of DRAWN) {
            byId(`select-${tool}`).addEventListener('click', () => this.draw(tool));
        }
        for (const change of ['all', 'around', ...Object.keys(CHANGES)]) {
            byId(`select-${change}`).addEventListener('click', () => this.change(change));
        }
        for (const line of ['loop', 'ring']) {
            byId(`select-${line}`).addEventListener('click', () => this.line(line));
        }
        byId('select-done').addEventListener('click', () => this.cancel());
        onUnit(() => this.#say());
        byId('select-angle').addEventListener('keydown', (event) => {
            if (event.key === 'Enter' && this.#isReady) {
                this.change('around');
            }
        });
    }

    // Called when the session has changed; `what` is as in the constructor of Session.
    follow(what) {
        const { shown, mesh } = this.#session;
        if (what === 'mesh') {
            this.cancel();
        }
        if (shown !== null && ['mesh', 'content', 'change'].includes(what)) {
            this.#sets.follow(mesh, what, shown.history);
        }
        if (['mesh', 'content', 'change', 'selection'].includes(what)) {
            this.#say();
            this.#showPossible();
        }
    }

    // Says how much is selected.
    #say() {
        const { shown, selection } = this.#session;
        byId('select-said').textContent = shown === null ? '' : saidOf(selection, shown);
    }

    // Sets whether there is a mesh to select in, and whether it may be edited.
    setEnabled(isReady, mayEdit) {
        this.#isReady = isReady;
        this.#showPossible();
        enable(byId('set-save'), mayEdit && this.#session.selection.asCrowd !== null);
    }

    #showPossible() {
        const { kind } = this.#session.selection;
        const isSet = kind !== null && kind !== 'halfedge';
        const drawn = DRAWN.map((tool) => [tool, this.#stage.isThere]);
        const possible = {
            ...Object.fromEntries(drawn),
            all: true,
            boundary: true,
            invert: isSet,
            grow: isSet,
            shrink: isSet,
            connected: isSet,
            around: kind === 'face',
            loop: kind === 'edge' || kind === 'halfedge',
            ring: kind === 'edge' || kind === 'halfedge',
        };
        for (const [name, isPossible] of Object.entries(possible)) {
            enable(byId(`select-${name}`), this.#isReady && isPossible);
        }
    }

    // --- drawing ---

    // Arms a tool that draws, or disarms it if it is armed.
    draw(tool) {
        const isOn = this.#tool === tool;
        this.cancel();
        if (isOn || !this.#isReady || !this.#stage.isThere) {
            return;
        }
        this.#acts.onArm();
        if (this.#stage.pickMode === 'halfedge') {
            this.#stage.setPickMode('edge');
        }
        this.#tool = tool;
        byId(`select-${tool}`).setAttribute('aria-pressed', 'true');
        const what = PLURALS[this.#stage.pickMode];
        byId('select-hint').textContent =
            `Drag to select ${what}. Shift adds, Ctrl removes. Press Esc to end.`;
        byId('brush-row').hidden = tool !== 'paint';
        byId('select-note').hidden = false;
        this.#stage.bringIntoSight();
        if (tool === 'paint') {
            this.#brush.arm();
        } else {
            this.#lasso.arm({ isBox: tool === 'box', isKept: true });
        }
    }

    // Whether a tool that draws is armed.
    get isArmed() {
        return this.#tool !== null;
    }

    cancel() {
        if (this.#tool !== null) {
            byId(`select-${this.#tool}`).setAttribute('aria-pressed', 'false');
            this.#tool = null;
        }
        byId('brush-row').hidden = true;
        byId('select-note').hidden = true;
        this.#lasso.cancel();
        this.#brush.cancel();
    }

    // The kind of elements that drawing selects.
    get #kind() {
        return this.#stage.pickMode === 'halfedge' ? 'edge' : this.#stage.pickMode;
    }

    #takeArea(corners, event) {
        const view = this.#stage.shownTriangles;
        if (view !== null && this.#session.shown !== null) {
            const { width, height, shown } = view;
            const places = corners.map(([x, y]) => [((x + 1) / 2) * width, ((1 - y) / 2) * height]);
            const set = inside(this.#kind, this.#session.shown.geometry, {
                matrix: this.#stage.matrix,
                mask: polygonMask(places, width, height),
                shown: isThrough() ? null : shown,
            });
            this.#choose(this.#kind, set, howOf(event));
        }
    }

    #beginStroke(how) {
        const view = this.#stage.shownTriangles;
        const { shown } = this.#session;
        if (view === null || shown === null) {
            return null;
        }
        const radius = (Number(byId('brush-size').value) * view.width) / byId('canvas').clientWidth;
        return new Stroke(
            this.#kind,
            shown.geometry,
            { ...view, matrix: this.#stage.matrix },
            { radius, how, isThrough: isThrough() },
        );
    }

    // Shows what the selection will be, or, if `stroke` is null, what it is.
    #showStroke(stroke) {
        const { selection, shown } = this.#session;
        if (stroke === null || shown === null) {
            this.#stage.selectMany(selection.crowd);
            return;
        }
        const set = this.#combine(stroke.kind, stroke.read(false), stroke.how);
        this.#stage.selectMany(Crowd.of(stroke.kind, set, shown.geometry));
    }

    // --- what is selected ---

    // The selected elements as a set of this kind, see sets.js; empty if others are selected.
    #setOf(kind) {
        const { geometry } = this.#session.shown;
        const crowd = this.#session.selection.asCrowd;
        return crowd?.kind === kind ? crowd.setIn(geometry) : noneOf(kind, geometry);
    }

    #combine(kind, found, how) {
        return how === 'only' ? found : combined(this.#setOf(kind), found, how);
    }

    #choose(kind, found, how = 'only') {
        const set = this.#combine(kind, found, how);
        const crowd = Crowd.of(kind, set, this.#session.shown.geometry);
        this.#session.selection.choose(crowd).catch(this.#acts.onError);
    }

    // Changes the selection, see changes.js; 'all' selects all elements of the kind that clicks pick,
    // and 'around' the faces around the selected ones.
    change(name) {
        const { selection, shown } = this.#session;
        if (shown === null || byId(`select-${name}`).disabled) {
            return;
        }
        const { geometry } = shown;
        const { kind } = selection;
        if (name === 'all') {
            this.#choose(this.#kind, allOf(this.#kind, geometry));
            return;
        }
        const before = kind === null || kind === 'halfedge' ? null : this.#setOf(kind);
        const after =
            name === 'around'
                ? around(before, Number(byId('select-angle').value), geometry)
                : CHANGES[name](kind, before, geometry);
        if (after.kind !== kind) {
            this.#stage.setPickMode(after.kind);
        }
        this.#choose(after.kind, after.set);
    }

    // Selects the edge loops or rings of the selected edges: `line` is 'loop' or 'ring'.
    line(line) {
        const { chosen } = this.#session.selection;
        const edges = chosen.map(({ kind, id, element }) => (kind === 'edge' ? id : element.edge));
        if (edges.length > 0 && !byId(`select-${line}`).disabled) {
            this.#selectLines(line, edges, []).catch(this.#acts.onError);
        }
    }

    async #selectLines(line, edges, others) {
        const { mesh, selection } = this.#session;
        const found = new Set(others);
        for (const edge of edges.slice(-MOST_LINES)) {
            const isKnown = edges.length > 1 && found.has(edge);
            const ids = isKnown ? [] : await api.getLine(mesh, `edge_${line}`, edge);
            ids.forEach((id) => found.add(id));
        }
        if (mesh === this.#session.mesh) {
            this.#stage.setPickMode('edge');
            await selection.selectAll('edge', [...found]);
        }
    }

    // Called after a click with the Alt key: selects the loop of the edge nearest to the pointer, or
    // its ring if Ctrl is held; if clicks pick faces, the strip of faces that the ring crosses.
    async pickLine({ clientX, clientY, ctrlKey, metaKey, shiftKey }) {
        const { selection, mesh } = this.#session;
        const near = this.#stage.edgeAt(clientX, clientY);
        const edge = near && (await selection.idOf(near));
        if (edge === null || mesh !== this.#session.mesh) {
            return;
        }
        const also = (kind) => (shiftKey && selection.kind === kind ? selection.ids() : []);
        if (this.#stage.pickMode === 'face') {
            const ring = await api.getLine(mesh, 'edge_ring', edge);
            const answers = await Crowd.readEdges(mesh, ring);
            const faces = answers.flatMap((one) => one.faces).filter((face) => face !== null);
            await selection.selectAll('face', [...new Set([...(await also('face')), ...faces])]);
            return;
        }
        const line = ctrlKey || metaKey ? 'ring' : 'loop';
        await this.#selectLines(line, [edge], await also('edge'));
    }

    // --- named sets ---

    async #save(name) {
        const { selection } = this.#session;
        const domain = PLURALS[selection.kind];
        const { count } = selection;
        const answer = await this.#session.saveSet({ domain, name }, await selection.ids());
        if (answer !== null) {
            const what = formatNumberOf(count, selection.kind ?? 'element', domain);
            this.#acts.onTell('Set saved', `\u201c${nameInText(name)}\u201d has ${what}.`);
        }
    }

    async #take(set, also) {
        const { mesh, selection } = this.#session;
        const kind = kindOf(set);
        const ids = await api.getSet(mesh, set.domain, set.name);
        if (mesh === this.#session.mesh) {
            const others = also && selection.kind === kind ? await selection.ids() : [];
            this.#stage.setPickMode(kind);
            await selection.selectAll(kind, [...new Set([...others, ...ids])]);
        }
    }
}

const isThrough = () => byId('select-through').checked;

// Returns what drawing does to the selection: the keys that were held, else the choice in the panel.
function howOf({ shiftKey, ctrlKey, metaKey }) {
    if (ctrlKey || metaKey) {
        return 'remove';
    }
    return shiftKey ? 'add' : byId('select-how').value;
}

// Returns the number and the size of what is selected in words.
function saidOf(selection, { geometry, summary }) {
    const { kind, count, crowd, chosen } = selection;
    if (kind === null) {
        return '';
    }
    const total = summary.counts[kind === 'halfedge' ? 'halfedges' : PLURALS[kind]];
    const what = formatNumberOf(count, SINGULARS[kind], PLURALS[kind]);
    const sum = (member) => chosen.reduce((size, { element }) => size + element[member], 0);
    const sizeIn = (member) =>
        crowd === null ? sum(member) : sizeOf(kind, crowd.setIn(geometry), geometry);
    const size = {
        face: () => `, area ${formatSize(sizeIn('area'), 2, 5)}`,
        edge: () => `, length ${formatSize(sizeIn('length'), 1, 5)}`,
    }[kind];
    return `${what} of ${formatCount(total)}${size?.() ?? ''}`;
}
