// measuring.js - the tool that measures: the user clicks places or elements in the view, or types ids,
// and gets a list of results, which are also drawn in the view.
//
// When the mesh changes, all results are measured again: those between vertices, edges and faces follow
// them, and a place on a face stays where it is.

import { copyText } from '../kit/clipboard.js';
import { enable, make } from '../kit/dom.js';
import { numbersOf } from '../kit/numbers.js';
import { onUnit } from '../kit/units.js';
import { pointAt } from '../geometry/geometry.js';
import { Problem } from '../wire/api.js';
import { KINDS, elementOf, measure } from './kinds.js';
import { Labels } from './labels.js';
import { pickPlace } from './picking.js';
import { distance } from './shapes.js';

// The kind of elements that clicks pick, where it is not what the measurement takes. A wall is measured
// from a place on a face, and not from a vertex, which has several faces.
const PICKED = {
    distance: 'vertex',
    angle: 'vertex',
    radius: 'vertex',
    wall: 'face',
    area: 'face',
};

export class Measuring {
    #elements;
    #session;
    #stage;
    #acts;
    #labels;
    #isOn = false;
    #refs = []; // what has been clicked for the next measurement
    #results = []; // {kind, refs, found, problem}
    #running = null; // promise of the measuring after a change of the mesh
    #isWanted = false;

    // `button` switches the tool on and off, `section` contains the other elements: `kind`, a choice of
    // what to measure, `hint`, `form` with the field `ids`, the list `results`, `said` for messages, and
    // the buttons `done` and `clear`. `labels` covers the view. `onStart()` is called when the tool
    // begins to take clicks.
    constructor(elements, session, stage, { onStart, onError }) {
        [this.#elements, this.#session, this.#stage] = [elements, session, stage];
        this.#acts = { onStart, onError };
        this.#labels = new Labels(elements.labels, stage);
        const { button, kind, form, done, clear } = elements;
        kind.append(
            ...Object.entries(KINDS).map(([value, { title }]) => make('option', { value }, title)),
        );
        button.addEventListener('click', () => this.toggle());
        kind.addEventListener('change', () => this.#begin());
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            this.#take().catch(onError);
        });
        onUnit(() => this.#measureAgain().catch(onError));
        done.addEventListener('click', () => this.stop());
        clear.addEventListener('click', () => this.#forget(this.#results));
    }

    // Whether clicks in the view measure.
    get isOn() {
        return this.#isOn;
    }

    toggle() {
        if (this.#isOn) {
            this.stop();
        } else if (!this.#elements.button.disabled) {
            this.#isOn = true;
            this.#begin();
            this.#elements.section.scrollIntoView({ block: 'nearest' });
            this.#stage.bringIntoSight();
        }
    }

    // Ends the tool; the results stay.
    stop() {
        this.#isOn = false;
        this.#refs = [];
        this.#show();
    }

    // Handles the Esc key: forgets the clicks for the next result or, if there are none, ends the tool.
    giveUp() {
        if (this.#refs.length > 0) {
            this.#refs = [];
            this.#show();
        } else {
            this.stop();
        }
    }

    setEnabled(isEnabled) {
        enable(this.#elements.button, isEnabled);
        if (!isEnabled && this.#isOn) {
            this.stop();
        }
    }

    // Called when the session has changed; `what` is as in the constructor of Session.
    follow(what) {
        if (what === 'mesh') {
            this.#results = [];
            this.stop();
        } else if (what === 'change' || what === 'content' || this.#isBack(what)) {
            this.#measureAgain().catch(this.#acts.onError);
        }
    }

    // Whether the connection is back, during whose loss the results were to be measured again.
    #isBack(what) {
        const isIdle = this.#isWanted && this.#running === null;
        return what === 'state' && isIdle && this.#session.connection === 'on';
    }

    // Called after each frame.
    place() {
        this.#labels.place();
    }

    // --- clicks and ids ---

    get #kind() {
        return this.#elements.kind.value;
    }

    #begin() {
        this.#refs = [];
        const { takes, ids } = KINDS[this.#kind];
        this.#elements.ids.value = '';
        this.#elements.ids.placeholder = ids;
        if (this.#isOn) {
            this.#acts.onStart();
            this.#stage.setPickMode(PICKED[this.#kind] ?? takes);
        }
        this.#show();
    }

    // Takes a click at [x, y] in the window.
    async click(place) {
        const kind = this.#kind;
        const { takes } = KINDS[kind];
        // The mode in which clicks pick may have been changed since, by a key for example.
        const chosen = this.#stage.elementAt(...place, PICKED[kind] ?? takes);
        const content = this.#session.shown;
        const ref =
            takes === 'point'
                ? await pickPlace(content, this.#stage, place, chosen?.kind === 'vertex' ? chosen.id : null)
                : await this.#refOf(chosen, takes);
        if (content !== this.#session.shown || kind !== this.#kind || !this.#isOn) {
            return;
        }
        if (ref === null) {
            this.#say('There is nothing to measure at this place.');
            return;
        }
        this.#refs.push(ref);
        if (this.#refs.length === KINDS[kind].count) {
            const refs = this.#refs;
            this.#refs = [];
            await this.#add(kind, refs);
        } else {
            this.#say('');
            this.#show();
        }
    }

    async #refOf(chosen, takes) {
        const id = chosen === null ? null : await this.#session.selection.idOf(chosen);
        return id === null ? null : { [takes]: id };
    }

    // Measures what the field for ids names or, for an area, the selected faces.
    async #take() {
        const kind = this.#kind;
        const { count, takes, ids: wanted } = KINDS[kind];
        const element = elementOf(kind);
        let ids = numbersOf(this.#elements.ids.value, 'ids');
        if (takes === 'faces' && ids.length === 0) {
            const { selection } = this.#session;
            ids = selection.kind === 'face' ? await selection.ids() : [];
        }
        const isRight = takes === 'faces' ? ids.length > 0 : ids.length === count;
        if (!isRight || !ids.every((id) => Number.isInteger(id) && id >= 0)) {
            const detail =
                takes === 'faces'
                    ? 'Select faces in the view, or give the ids of faces.'
                    : `This needs the ${wanted}.`;
            throw new Problem({ title: KINDS[kind].title, detail });
        }
        await this.#add(kind, ids.map((id) => ({ [element]: id })));
        this.#elements.ids.value = '';
    }

    get #place() {
        const { mesh, summary } = this.#session.shown;
        const { bbox } = summary;
        return { mesh, size: bbox === null ? 1 : distance(bbox.min, bbox.max) };
    }

    // Adds a result to the list.
    async #add(kind, refs) {
        const { shown } = this.#session;
        const found = await measure({ kind, refs }, this.#place);
        if (shown === this.#session.shown) {
            const result = { kind, refs, found, problem: null };
            this.#results.push(result);
            this.#say(`${KINDS[kind].title}: ${textOf(result)}`);
            this.#show();
        }
    }

    #forget(results) {
        this.#results = this.#results.filter((result) => !results.includes(result));
        this.#show();
        const { button, results: list } = this.#elements;
        (list.querySelector('button') ?? button).focus({ preventScroll: true });
    }

    // --- after a change of the mesh ---

    // Measures all results again, and writes them in the present unit. A call during that only asks for one more pass.
    #measureAgain() {
        this.#isWanted = this.#results.length > 0;
        this.#running ??= this.#measureAll().finally(() => {
            this.#running = null;
        });
        return this.#running;
    }

    async #measureAll() {
        while (this.#isWanted) {
            this.#isWanted = false;
            for (const result of [...this.#results]) {
                try {
                    result.found = await measure(result, this.#place);
                    result.problem = null;
                } catch (error) {
                    // Status 0 means a lost connection, which the page shows in its bar. The results
                    // stay, and are measured again when it is back.
                    if (error.status === 0) {
                        this.#isWanted = true;
                        return;
                    }
                    if (!(error instanceof Problem)) {
                        throw error;
                    }
                    result.problem = error.detail;
                }
            }
            this.#show();
        }
    }

    // --- showing ---

    #say(text) {
        this.#elements.said.textContent = text;
    }

    #show() {
        const { section, button, hint, done, clear, results } = this.#elements;
        const isOn = this.#isOn;
        section.hidden = !isOn && this.#results.length === 0;
        button.setAttribute('aria-pressed', `${isOn}`);
        done.hidden = !isOn;
        clear.hidden = this.#results.length < 2;
        hint.textContent = isOn ? KINDS[this.#kind].hint(this.#refs.length) : '';
        results.replaceChildren(...this.#results.map((result) => this.#row(result)));
        this.#draw();
    }

    #row(result) {
        const { title } = KINDS[result.kind];
        const text = textOf(result);
        const act = (label, onclick) =>
            make(
                'button',
                {
                    type: 'button',
                    className: 'quiet',
                    'aria-label': `${label}: ${title}, ${text}`,
                    onclick,
                },
                label,
            );
        const copy = act('Copy', () => {
            copyText(text).then(() => this.#say(`Copied: ${text}`), this.#acts.onError);
        });
        const note = result.problem ?? result.found.note;
        const row = make(
            'li',
            {},
            make('span', { className: 'measure-title' }, title),
            make('strong', {}, text),
            make('span', { className: 'measure-note small' }, note),
            make(
                'span',
                { className: 'measure-acts' },
                ...(result.found.value === null || result.problem !== null ? [] : [copy]),
                act('Remove', () => this.#forget([result])),
            ),
        );
        row.dataset.kind = result.kind;
        row.classList.toggle('gone', result.problem !== null);
        return row;
    }

    // Returns the places of the clicks for the next result, in view coordinates.
    #clicked(toView) {
        const { geometry } = this.#session.shown;
        return this.#refs.flatMap(({ vertex, point }) => {
            if (point !== undefined) {
                return [toView(point)];
            }
            return vertex === undefined ? [] : [pointAt(geometry, vertex)];
        });
    }

    #draw() {
        const { shown } = this.#session;
        if (shown === null) {
            return;
        }
        const { origin, scale } = shown.geometry.frame;
        const toView = (point) => point.map((value, i) => (value - origin[i]) * scale);
        const live = this.#results.filter(({ problem }) => problem === null);
        this.#stage.rule(
            live.flatMap(({ found }) => found.lines.map(toView)),
            [...live.flatMap(({ found }) => found.points.map(toView)), ...this.#clicked(toView)],
        );
        this.#labels.show(
            live
                .filter(({ found }) => found.value !== null)
                .map((result) => ({ text: textOf(result), point: toView(result.found.at) })),
        );
    }
}

// Returns the value of a result as text.
function textOf({ found, problem }) {
    if (problem !== null) {
        return 'gone';
    }
    return found.value === null ? 'none' : found.format(found.value);
}
