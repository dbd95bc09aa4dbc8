// look.js - the look of the view: keeps its state, draws it, and computes what it needs from the mesh.
// If something cannot be computed or drawn, the mesh is drawn without it, and a message says so.

import { boxOf, edgesAlong, gridBelow } from '../geometry/extent.js';
import { cornerNormals } from '../geometry/normals.js';
import { recall, remember } from '../kit/storage.js';
import { formatSize, setUnit } from '../kit/units.js';
import { Task, proxyFor } from './background.js';
import { Cutting } from './cutting.js';
import { Labels } from './labels.js';
import { ViewPanel } from './panel.js';
import { SectionForm } from './section.js';
import { FIRST, WAYS, planeOf, rangeOf, toState } from './state.js';
import { onTheme, theme } from './theme.js';

const NAME = 'hedge-look';

// Axes are drawn at the origin of the mesh if it is at most this far from the middle of the view, in
// view coordinates.
const FARTHEST = 4;

// The box and the grid of a view without a mesh.
const NOTHING = { low: [-1, -1, -1], high: [1, 1, 1] };
const NO_FRAME = { origin: [0, 0, 0], scale: 1 };

const narrow = window.matchMedia('(max-width: 860px)'); // as in style/look.css

export class Look {
    #stage;
    #contentNow;
    #onError;
    #state;
    #panel;
    #section;
    #labels;
    #needs; // the controls of what a browser may be unable to draw
    #cutting;
    #normals;
    #proxy;
    #box = null; // of the mesh; null if it is not known
    #cut = null; // {plane, outline} that is drawn
    #normalsOf = null; // what the normals belong to: {geometry, revision, crease}
    #proxyOf = null; // what the simpler mesh belongs to: {geometry, revision}
    #isSuspended = false;

    // `elements` are those of ViewPanel, of SectionForm and of Labels, and `needs`, a fieldset.
    // `content()` returns the Content that is shown, or null.
    constructor(stage, { panel, section, labels, needs }, { content, onError }) {
        [this.#stage, this.#contentNow, this.#onError] = [stage, content, onError];
        this.#needs = needs;
        this.#panel = new ViewPanel(panel, {
            onChange: (part) => this.#change(part),
            onReset: () => this.#set({ ...FIRST, unit: this.#state.unit }),
            // Where the panel covers the lower part of the window, the view moves to the upper part.
            onOpen: () => narrow.matches && stage.bringIntoSight('start'),
        });
        this.#section = new SectionForm(section, {
            onChange: (plane) => this.#change({ section: plane }),
            rangeOf: (normal) => rangeOf(normal, this.#boxNow, this.#frame),
            direction: () => stage.view.back,
        });
        this.#labels = new Labels(labels);
        this.#normals = new Task((error) => this.#giveUp({ isSmooth: false }, error));
        this.#proxy = new Task((error) => this.#giveUp({ hurry: 'never' }, error));
        this.#cutting = new Cutting({
            onCut: (plane, outline) => this.#showCut(plane, outline),
            onError: (error) => this.#giveUp({ section: null }, error),
        });
        onTheme(() => this.#showTheme());
        this.#showTheme();
        this.#set(toState({ ...recall(NAME), section: null }));
    }

    // The look as a plain object, see state.js. Any value may be set; what is wrong in it is ignored.
    get state() {
        return structuredClone(this.#state);
    }

    set state(value) {
        this.#set(toState(value));
    }

    // Shows a look that somebody else has shared. It is not remembered as that of the visitor.
    visit(value) {
        this.#show(toState(value));
    }

    // Whether something that the look needs is being computed.
    get isBusy() {
        return this.#normals.isRunning || this.#proxy.isRunning || this.#cutting.isRunning;
    }

    // Goes on to the next way of drawing faces.
    nextWay() {
        if (!this.#needs.disabled) {
            const at = WAYS.indexOf(this.#state.way);
            this.#change({ way: WAYS[(at + 1) % WAYS.length] });
        }
    }

    // Opens or closes the panel.
    toggle() {
        this.#panel.toggle();
    }

    // Follows the session, see Session.
    follow(what) {
        const isNew = what === 'mesh' || what === 'content';
        if (!isNew && what !== 'change') {
            return;
        }
        this.#isSuspended = false;
        this.#box = null;
        if (isNew) {
            this.#forget();
        }
        if (what === 'mesh') {
            // A section is at a place of one mesh.
            this.#cut = null;
            this.#state.section = null;
        }
        this.#showSection(true);
        this.#showNormals();
        this.#showGuides();
        this.#showProxy();
    }

    // Called while something else than the mesh is drawn, to which normals and cuts do not belong,
    // until follow() is called.
    suspend() {
        this.#isSuspended = true;
        this.#cutting.cancel();
        this.#forget();
        this.#renderer?.setCut(null, null);
        this.#cut = null;
    }

    // Called when the renderer has forgotten the normals and the simpler mesh, because it shows other
    // arrays.
    #forget() {
        this.#normals.cancel();
        this.#proxy.cancel();
        [this.#normalsOf, this.#proxyOf] = [null, null];
    }

    // Called after each frame: moves the labels.
    frameDrawn() {
        const { hasAxes, hasBox } = this.#state;
        if (hasAxes || hasBox) {
            const { matrix, size, view } = this.#stage;
            this.#labels.place({ matrix, ...size }, view);
        }
    }

    // Called when frames are slow while the camera moves.
    slow() {
        if (this.#state.hurry === 'auto') {
            this.#makeProxy();
        }
    }

    // Called when the browser cannot draw the look, so that the renderer draws the mesh plainly.
    broken(reason) {
        this.#needs.disabled = true;
        const { hasAxes, hasGrid, hasBox, unit } = this.#state;
        this.#giveUp({ ...FIRST, hasAxes, hasGrid, hasBox, unit }, new Error(reason));
    }

    // --- the state ---

    #change(part) {
        this.#set({ ...this.#state, ...part });
    }

    #set(state) {
        remember(NAME, { ...state, section: null });
        this.#show(state);
    }

    #show(state) {
        this.#state = state;
        setUnit(state.unit);
        try {
            this.#renderer?.setLook(state);
            this.#renderer?.setHurry(state.hurry);
        } catch (error) {
            this.#onError(error);
        }
        this.#panel.show(state);
        this.#showSection(false);
        this.#showNormals();
        this.#showGuides();
        this.#showProxy();
    }

    // Gives up a part of the look that could not be computed or drawn.
    #giveUp(part, error) {
        this.#change(part);
        this.#onError({
            title: 'This look cannot be drawn',
            detail: `The mesh is drawn without it. ${error.message}`,
        });
    }

    get #renderer() {
        return this.#stage.renderer;
    }

    get #geometry() {
        return this.#isSuspended ? null : (this.#contentNow()?.geometry ?? null);
    }

    get #frame() {
        return this.#contentNow()?.geometry.frame ?? NO_FRAME;
    }

    // The bounding box in view coordinates.
    get #boxNow() {
        const geometry = this.#contentNow()?.geometry ?? null;
        this.#box ??= geometry && boxOf(geometry);
        return this.#box ?? NOTHING;
    }

    #showTheme() {
        this.#renderer?.setColors(theme());
    }

    // --- smooth shading ---

    #showNormals() {
        const geometry = this.#geometry;
        if (geometry === null || !this.#state.isSmooth) {
            this.#normals.cancel();
            this.#normalsOf = null;
            this.#renderer?.setNormals(null);
            return;
        }
        const { crease } = this.#state;
        const wanted = { geometry, revision: geometry.revision, crease };
        if (Object.entries(wanted).every(([name, value]) => this.#normalsOf?.[name] === value)) {
            return;
        }
        this.#normalsOf = wanted;
        this.#normals.begin(cornerNormals(geometry, crease), (normals) =>
            this.#renderer?.setNormals(normals),
        );
    }

    // --- the section ---

    // Shows the section; `isChanged` says that the mesh may have changed.
    #showSection(isChanged) {
        const { section } = this.#state;
        const geometry = this.#geometry;
        this.#section.show(section);
        if (section === null || geometry === null || this.#needs.disabled) {
            this.#cutting.cancel();
            if (this.#cut !== null || isChanged) {
                this.#cut = null;
                this.#renderer?.setCut(null, null);
            }
            return;
        }
        const plane = planeOf(section, this.#frame);
        if (!isChanged && JSON.stringify(plane) === JSON.stringify(this.#cut?.plane)) {
            this.#measureCut();
        } else {
            this.#cutting.want(geometry, plane, isChanged);
        }
    }

    #showCut(plane, outline) {
        this.#cut = { plane, outline };
        this.#renderer?.setCut(plane, outline);
        this.#measureCut();
    }

    #measureCut() {
        const { outline } = this.#cut;
        const { scale } = this.#frame;
        this.#section.measure({
            ...outline,
            length: outline.length / scale,
            area: outline.area / scale ** 2,
        });
    }

    // --- guides ---

    #showGuides() {
        const { hasAxes, hasGrid, hasBox } = this.#state;
        const isEmpty = this.#contentNow() === null || !(hasAxes || hasGrid || hasBox);
        const box = isEmpty ? NOTHING : this.#boxNow;
        const frame = this.#frame;
        const grid = isEmpty || !hasGrid ? null : gridBelow(box, frame);
        const sizes = isEmpty || !hasBox ? [] : [0, 1, 2].map((axis) => sizeOf(box, axis, frame));
        this.#renderer?.setGuides({
            grid: grid?.lines ?? [],
            axes: isEmpty || !hasAxes ? [] : axesOf(box, frame),
            box: sizes.flatMap(({ edges }) => edges),
        });
        this.#labels.show({
            sizes,
            grid: grid === null ? '' : `Grid ${formatSize(grid.step)}`,
            hasCross: !isEmpty && hasAxes,
        });
    }

    // --- the simpler mesh ---

    #showProxy() {
        if (this.#state.hurry === 'always') {
            this.#makeProxy();
        } else {
            this.#proxy.cancel();
        }
    }

    #makeProxy() {
        const geometry = this.#geometry;
        const isMade =
            this.#proxyOf?.geometry === geometry && this.#proxyOf.revision === geometry?.revision;
        if (geometry === null || isMade || this.#needs.disabled) {
            return;
        }
        this.#proxyOf = { geometry, revision: geometry.revision };
        this.#proxy.begin(proxyFor(geometry), (proxy) => this.#renderer?.setProxy(proxy));
    }
}

// Returns the size of a box along an axis for Labels.show().
function sizeOf(box, axis, { scale }) {
    const size = (box.high[axis] - box.low[axis]) / scale;
    return { axis, text: formatSize(size, 1, 5), edges: edgesAlong(box, axis) };
}

// Returns the three axes as lines from the origin of the mesh, or none if it is far away.
function axesOf({ low, high }, { origin, scale }) {
    const from = origin.map((value) => -value * scale);
    if (Math.hypot(...from) > FARTHEST) {
        return [];
    }
    return [0, 1, 2].map((axis) => {
        const reach = Math.max(high[axis] - from[axis], 0.15 * (high[axis] - low[axis]), 0.1);
        const to = from.map((value, other) => value + (other === axis ? 1.15 * reach : 0));
        return [from, to];
    });
}
