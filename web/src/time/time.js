// time.js - looks at earlier revisions of the open mesh without changing it: a slider over all
// revisions that can be read, and a curtain with the earlier revision over the present mesh.
//
//            slide, look            compare
//   present -------------> earlier <---------> earlier beside the present, divided by a line
//      ^                      |
//      +----------------------+  back to the present; another mesh is opened

import { changedFaces, placementOf, shapeOfFaces } from '../geometry/changed.js';
import { COLORS } from '../gl/colors.js';
import { formatNumberOf } from '../kit/dom.js';
import { wordsOfTime } from '../kit/when.js';
import { nameInText } from '../wire/names.js';
import { onTheme, theme } from '../look/theme.js';
import { Wiper } from './wiper.js';

// How many of the revisions that were looked at last are kept.
const MOST_KEPT = 6;

export class Time {
    #elements;
    #stage;
    #acts;
    #wiper;
    #content = null; // the Content of the open mesh
    #past = null; // the arrays of the revision that is looked at; null: the present is shown
    #wanted = null; // the revision that is being read
    #reading = null;
    #kept = new Map(); // by revision: arrays, those looked at last at the end

    // `slider`, `at` and `box` are in the history; `note` is over the view, with `said`, `compare`,
    // `wipe`, `line`, `undo` and `done`. `read(mesh, revision, signal)` returns a promise of the
    // arrays of a revision; `label()` returns what the next frame shows, see Stage.show();
    // `onChange()` is called when the page begins or ends to look at an earlier revision, and
    // `onUndo(revision)` when the user wants to go back to it.
    constructor(elements, stage, acts) {
        const { slider, compare, wipe, line, undo, done } = elements;
        this.#elements = elements;
        this.#stage = stage;
        this.#acts = acts;
        this.#wiper = new Wiper({ slider: wipe, line }, (part) => stage.wipe(part));
        slider.addEventListener('input', () => this.look(slider.valueAsNumber));
        compare.addEventListener('change', () => this.#draw());
        onTheme(() => this.#past !== null && this.#draw());
        undo.addEventListener('click', () => {
            const { revision } = this;
            this.end();
            acts.onUndo(revision);
        });
        done.addEventListener('click', () => this.end());
    }

    // The revision that is looked at, or null if the present one is shown.
    get revision() {
        return this.#past?.revision ?? null;
    }

    get isOn() {
        return this.#past !== null || this.#wanted !== null;
    }

    // Called when the session has changed, see Session. `content` is the mesh that is shown.
    follow(what, content) {
        if (what === 'mesh') {
            this.#kept.clear();
            this.end();
        }
        this.#content = content;
        if (content === null) {
            return;
        }
        if (what === 'content' || what === 'change') {
            // After a replacement, earlier revisions cannot be read any more, or are others.
            if (content.history.oldest > (this.#past?.revision ?? Infinity)) {
                this.end();
            }
            if (this.#past !== null) {
                this.#draw();
            }
        }
        this.#showSlider();
    }

    // Looks at a revision; at the present one, shows the mesh as it is.
    look(revision) {
        this.#reading?.abort();
        this.#reading = null;
        if (revision >= this.#content.revision) {
            this.end();
            return;
        }
        this.#wanted = revision;
        this.#showSlider();
        this.#read(revision).catch((error) => {
            if (error.name !== 'AbortError') {
                this.end();
                this.#acts.onError(error);
            }
        });
    }

    async #read(revision) {
        const content = this.#content;
        let arrays = this.#kept.get(revision);
        if (arrays === undefined) {
            this.#reading = new AbortController();
            const { signal } = this.#reading;
            arrays = await this.#acts.read(content.mesh, revision, signal);
            signal.throwIfAborted();
        }
        this.#keep(arrays);
        if (content === this.#content && this.#wanted === revision) {
            this.#wanted = null;
            this.#past = arrays;
            this.#draw();
            this.#acts.onChange();
        }
    }

    #keep(arrays) {
        this.#kept.delete(arrays.revision);
        this.#kept.set(arrays.revision, arrays);
        if (this.#kept.size > MOST_KEPT) {
            this.#kept.delete(this.#kept.keys().next().value);
        }
    }

    // Shows the present mesh again.
    end() {
        this.#reading?.abort();
        this.#reading = null;
        const wasOn = this.isOn;
        this.#wanted = null;
        this.#past = null;
        if (wasOn) {
            this.#elements.compare.checked = false;
            this.#draw();
            this.#acts.onChange();
        }
        this.#showSlider();
    }

    #showSlider() {
        const { box, slider, at } = this.#elements;
        const { revision: present, history } = this.#content ?? { revision: 1, history: null };
        const oldest = Math.min(history?.oldest ?? present, present);
        const focus = this.#wanted ?? this.revision ?? present;
        box.hidden = oldest === present;
        slider.min = oldest;
        slider.max = present;
        slider.value = focus;
        slider.setAttribute('aria-valuetext', `revision ${focus} of ${present}`);
        at.textContent = `${focus} of ${present}`;
    }

    // Draws what is looked at, and says what that is.
    #draw() {
        const { note, said, compare, line } = this.#elements;
        const past = this.#past;
        const isBeside = past !== null && compare.checked;
        note.hidden = past === null;
        this.#wiper.show(isBeside);
        if (past === null) {
            line.hidden = true;
            this.#stage.tint('changed', []);
            this.#stage.showPast(null, null, [], this.#acts.label());
            return;
        }
        const present = this.#content.geometry;
        const changed = isBeside ? changedFaces(past, present) : null;
        const { gone, made, moved } = COLORS[theme()].changes;
        this.#stage.showPast(
            past,
            placementOf(past, present),
            isBeside ? tintsOf(past, [gone, changed.gone], [moved, changed.moved]) : [],
            this.#acts.label(),
        );
        this.#stage.tint(
            'changed',
            isBeside ? tintsOf(present, [made, changed.made], [moved, changed.moved]) : [],
        );
        this.#stage.wipe(isBeside ? this.#wiper.part : 1);
        said.replaceChildren(
            `You are looking at revision ${past.revision} of ${present.revision}.`,
            this.#momentOf(past.revision),
            isBeside ? ` ${sumOf(changed)}` : '',
        );
    }

    // Returns which moment a revision is, as far as the history that was read tells.
    #momentOf(revision) {
        const entry = this.#content.history.entries.find((one) => one.revision === revision);
        if (entry === undefined) {
            return '';
        }
        const name = entry.name === undefined ? '' : `\u201c${nameInText(entry.name)}\u201d, `;
        return ` It is ${name}from ${wordsOfTime(new Date(entry.time), new Date())}.`;
    }
}

function tintsOf(geometry, ...groups) {
    return groups
        .filter(([, faces]) => faces.length > 0)
        .map(([color, faces]) => ({ color, ...shapeOfFaces(geometry, faces) }));
}

function sumOf({ gone, made, moved }) {
    const parts = [
        [gone, 'gone'],
        [made, 'new'],
        [moved, 'changed'],
    ]
        .filter(([faces]) => faces.length > 0)
        .map(([faces, word]) => `${formatNumberOf(faces.length, 'face')} ${word}`);
    return parts.length === 0 ? 'No face differs.' : `Until now: ${parts.join(', ')}.`;
}
