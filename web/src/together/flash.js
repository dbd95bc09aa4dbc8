// flash.js - marks for a moment what another client has changed.

import { shapeOfFaces } from '../geometry/changed.js';
import { COLORS } from '../gl/colors.js';
import { theme } from '../look/theme.js';

// Whether the user has asked for a page without motion.
const wantsRest = window.matchMedia('(prefers-reduced-motion: reduce)');

const MILLIS = 900;
const MOST_FACES = 20000; // a change of more faces is seen without a mark

export class Flash {
    #stage;
    #told = []; // {revision, faces} of edits that are not shown yet
    #timer = 0;

    constructor(stage) {
        this.#stage = stage;
    }

    // Called when an event told of an edit.
    note({ revision, created, modified }) {
        const faces = [...(created?.faces ?? []), ...(modified?.faces ?? [])];
        if (faces.length > 0 && faces.length <= MOST_FACES && !wantsRest.matches) {
            this.#told.push({ revision, faces });
        }
    }

    // Called when the session has changed: marks the edits that are shown now, unless this page has
    // made them. While an edit of this page is in progress, it is not known which edits are its own.
    follow({ shown, busy, own }) {
        if (busy || shown === null || this.#told.length === 0) {
            return;
        }
        const seen = this.#told.filter(({ revision }) => revision <= shown.revision);
        this.#told = this.#told.filter(({ revision }) => revision > shown.revision);
        const faces = seen.filter(({ revision }) => !own.has(revision)).flatMap((one) => one.faces);
        if (faces.length > 0) {
            const shape = shapeOfFaces(shown.geometry, [...new Set(faces)]);
            this.#stage.tint('flash', [{ color: COLORS[theme()].flash, ...shape }]);
            clearTimeout(this.#timer);
            this.#timer = setTimeout(() => this.#stage.tint('flash', []), MILLIS);
        }
    }

    // Forgets everything, because another mesh is opened.
    reset() {
        this.#told = [];
        clearTimeout(this.#timer);
        this.#stage.tint('flash', []);
    }
}
