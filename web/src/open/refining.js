// refining.js - shows levels of detail of the open mesh: plays them from coarse to fine as they
// arrive, and has a slider to choose one. While a level is shown nothing can be picked or edited,
// because the elements of a level are not elements of the mesh.

import * as api from '../wire/api.js';
import { formatCount } from '../kit/dom.js';
import { Levels } from '../geometry/levels.js';
import { Pace } from '../geometry/pace.js';
import { ProgressiveReader } from '../geometry/progressive.js';

// The longest time between two frames, in seconds, that counts as playing time: if the page was
// hidden or a frame was slow, the levels do not jump forward by more than this time.
const LONGEST = 0.5;

const isStill = window.matchMedia('(prefers-reduced-motion: reduce)');

const HINTS = {
    waiting: 'The server is computing the levels of detail.',
    shown: 'You cannot pick or edit while levels of detail are shown.',
};

export class Refining {
    #elements;
    #stage;
    #acts;
    #mesh = null; // {mesh, revision, faces} of the mesh whose levels are read or shown
    #reading = null; // AbortController of the request for the levels
    #levels = null;
    #pace = null; // null until the coarsest level is shown
    #position = 0; // the position of the slider that is to be shown, if its level has arrived
    #isPlaying = false;
    #time = 0; // time of the last frame while playing; 0 before the first
    #scheduled = 0;

    // `button` begins and ends the showing of levels; `box` is shown meanwhile and contains
    // `slider`, `faces` (the number of faces shown), `hint`, `progress` (what has arrived), `play`
    // and `done`. `onBegin()` is called when the coarsest level is shown, `onEnd()` when the mesh
    // must be shown again, `onStale()` if levels are no longer shown because the server sends
    // levels of another revision than the one shown.
    constructor(elements, stage, { onBegin, onEnd, onStale, onError }) {
        [this.#elements, this.#stage] = [elements, stage];
        this.#acts = { onBegin, onEnd, onStale, onError };
        const { button, box, slider, play, done } = elements;
        done.addEventListener('click', () => this.end());
        play.addEventListener('click', () => (this.#isPlaying ? this.#pause() : this.#play()));
        slider.addEventListener('input', () => {
            this.#isPlaying = false;
            this.#position = Number(slider.value);
            this.#schedule();
        });
        // Until the coarsest level is shown, the focus may be on the button, so the Esc key must
        // work there, too.
        for (const element of [button, box]) {
            element.addEventListener('keydown', (event) => {
                if (event.key === 'Escape') {
                    this.end();
                }
            });
        }
    }

    // Whether a level is shown instead of the mesh.
    get isOn() {
        return this.#pace !== null;
    }

    // Whether levels were requested or are shown.
    get isWanted() {
        return this.#mesh !== null;
    }

    // Reads the levels of the mesh in a Content (see revision.js) and plays them as they arrive.
    async begin({ mesh, revision, geometry, summary }) {
        this.end();
        const reading = new AbortController();
        this.#reading = reading;
        this.#mesh = { mesh, revision, faces: summary.counts.faces };
        this.#showWaiting();
        const reader = new ProgressiveReader((header) => {
            if (header.revision !== revision) {
                this.end();
                this.#acts.onStale();
            }
            reading.signal.throwIfAborted();
            this.#levels = new Levels(header, geometry.frame);
            return this.#levels;
        });
        try {
            const onBytes = (bytes) => {
                reader.push(bytes);
                this.#arrived();
            };
            await api.getProgressive(mesh, onBytes, reading.signal);
            reading.signal.throwIfAborted();
            reader.end();
            this.#elements.progress.hidden = true;
            this.#mesh.faces = this.#levels.faces;
            this.#schedule();
        } catch (error) {
            // An error is not shown if the user has cancelled the showing of levels.
            if (!reading.signal.aborted) {
                this.end();
                this.#acts.onError(error);
            }
        }
    }

    // Ends the showing of levels and shows the mesh again.
    end() {
        const { box, button } = this.#elements;
        const { isOn } = this;
        const hadFocus = box.contains(document.activeElement);
        this.#reading?.abort();
        cancelAnimationFrame(this.#scheduled);
        [this.#mesh, this.#reading, this.#levels, this.#pace] = [null, null, null, null];
        [this.#isPlaying, this.#scheduled] = [false, 0];
        box.hidden = true;
        button.setAttribute('aria-pressed', 'false');
        if (hadFocus) {
            button.focus();
        }
        if (isOn) {
            this.#acts.onEnd();
        }
    }

    // --- arriving data ---

    #showWaiting() {
        const { box, button, slider, faces, hint, progress, play } = this.#elements;
        button.setAttribute('aria-pressed', 'true');
        faces.textContent = '';
        hint.textContent = HINTS.waiting;
        box.setAttribute('aria-busy', 'true');
        progress.hidden = false;
        progress.removeAttribute('value');
        slider.disabled = true;
        play.disabled = true;
        box.hidden = false;
    }

    #arrived() {
        const levels = this.#levels;
        if (levels?.hasBase) {
            if (!this.isOn) {
                this.#showBase();
            }
            this.#elements.progress.value = levels.part;
            // If the user prefers reduced motion, the page waits until all levels have arrived.
            if (!isStill.matches) {
                this.#schedule();
            }
        }
    }

    #showBase() {
        const { button, box, slider, hint, play } = this.#elements;
        const { geometry, most } = this.#levels;
        this.#levels.goTo(0);
        this.#stage.showLevel(geometry, this.label);
        this.#pace = new Pace(geometry.triangleCount, most);
        slider.max = this.#pace.positions;
        slider.disabled = false;
        play.disabled = false;
        hint.textContent = HINTS.shown;
        box.setAttribute('aria-busy', 'false');
        this.#acts.onBegin();
        this.#position = isStill.matches ? this.#pace.positions : 0;
        this.#showLevel();
        if (document.activeElement === button) {
            slider.focus();
        }
        if (!isStill.matches) {
            this.#play();
        }
    }

    // --- levels ---

    #play() {
        this.#isPlaying = true;
        this.#time = 0;
        if (this.#position >= this.#pace.positions) {
            this.#position = 0;
        }
        this.#schedule();
    }

    #pause() {
        this.#isPlaying = false;
        this.#schedule();
    }

    #schedule() {
        if (this.#scheduled === 0 && this.isOn) {
            this.#scheduled = requestAnimationFrame((now) => {
                this.#scheduled = 0;
                this.#step(now);
            });
        }
    }

    // Called before a frame is drawn: goes to the level that the frame is to show.
    #step(now) {
        const [levels, pace] = [this.#levels, this.#pace];
        const wasPlaying = this.#isPlaying;
        if (wasPlaying) {
            const seconds = this.#time > 0 ? Math.min((now - this.#time) / 1000, LONGEST) : 0;
            this.#time = now;
            const further = this.#position + (seconds / pace.seconds) * pace.positions;
            // Playing does not go beyond the levels that have arrived.
            const most = levels.count < levels.most ? pace.positionOf(levels.count) : Infinity;
            this.#position = Math.min(further, pace.positions, Math.max(most, this.#position));
            this.#isPlaying = this.#position < pace.positions;
        }
        const before = levels.level;
        levels.goTo(pace.levelAt(this.#position));
        if (levels.level !== before) {
            this.#stage.refine(levels.takeChanges(), this.label);
        }
        // Screen readers announce the number of faces only at the end of playing. When the user
        // moves the slider, the slider itself is announced.
        const isAtEnd = wasPlaying && !this.#isPlaying;
        this.#elements.faces.setAttribute('aria-live', isAtEnd ? 'polite' : 'off');
        this.#showLevel();
        if (this.#isPlaying) {
            this.#schedule();
        }
    }

    // Returns the label of a frame that shows the present level, see Stage.show().
    get label() {
        const { mesh, revision } = this.#mesh;
        return { mesh, revision, faces: this.#levels.geometry.triangleCount };
    }

    #showLevel() {
        const { slider, faces, play } = this.#elements;
        const shown = this.#levels.geometry.triangleCount;
        const all = Math.max(this.#mesh.faces, shown);
        const text = `${formatCount(shown)} of ${formatCount(all)} faces`;
        faces.textContent = text;
        slider.value = Math.round(this.#position);
        slider.setAttribute('aria-valuetext', this.#isPlaying ? 'Playing' : text);
        play.textContent = this.#isPlaying ? 'Pause' : 'Play';
    }
}
