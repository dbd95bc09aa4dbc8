// presence.js - shows what is selected on this page to the other clients of the open mesh. The
// server forgets a client that it has not heard of for half a minute, so the page repeats itself.

import * as api from '../wire/api.js';

// Milliseconds after which changes are sent: a short while, because a selection often changes
// several times, and again if nothing has changed.
const SOON = 120;
const AGAIN = 12000;

// The most ids that the server takes.
const MOST_IDS = 256;

export class Presence {
    // The id of this page among the clients of a mesh, chosen at random.
    client = [...crypto.getRandomValues(new Uint8Array(9))]
        .map((byte) => byte.toString(16).padStart(2, '0'))
        .join('');
    name = '';
    isRefused = false; // the server does not show this page to others now

    #session;
    #isSilent;
    #cameraNow;
    #onChange;
    #mesh = null; // the mesh at which this page has shown itself
    #sent = ''; // what was sent last, and when
    #time = -Infinity;
    #timer = 0;

    // `camera()` returns the numbers of the camera, see Stage.camera. `onChange()` is called when
    // `isRefused` has changed. If `isSilent` is true, the page never shows itself.
    constructor(session, isSilent, { camera, onChange }) {
        this.#session = session;
        this.#isSilent = isSilent;
        this.#cameraNow = camera;
        this.#onChange = onChange;
        window.addEventListener('pagehide', () => this.#leave(true));
        document.addEventListener('visibilitychange', () => this.soon());
    }

    // Called when something that is shown to others may have changed.
    soon() {
        if (this.#isSilent) {
            return;
        }
        // The page leaves a mesh at once, because the mesh may be deleted next.
        if (this.#session.mesh !== this.#mesh) {
            this.#leave(false);
        }
        clearTimeout(this.#timer);
        this.#timer = setTimeout(() => this.#send(), SOON);
    }

    // Called when a mesh was deleted: the page need not leave it.
    forget(mesh) {
        if (mesh === this.#mesh) {
            this.#mesh = null;
            this.#sent = '';
        }
    }

    async #send() {
        const { mesh, connection } = this.#session;
        if (mesh !== this.#mesh) {
            this.#leave(false);
        }
        clearTimeout(this.#timer);
        // While nobody looks at the page, it does not repeat itself, and is forgotten.
        if (mesh === null || connection !== 'on' || document.visibilityState !== 'visible') {
            return;
        }
        this.#timer = setTimeout(() => this.#send(), AGAIN);
        const shown = this.#shown();
        const text = JSON.stringify(shown);
        if (text !== this.#sent || performance.now() - this.#time >= AGAIN - SOON) {
            await this.#put(mesh, shown, text);
        }
    }

    async #put(mesh, shown, text) {
        this.#mesh = mesh;
        this.#sent = text;
        this.#time = performance.now();
        try {
            await api.putPresence(mesh, shown);
            this.#setRefused(false);
        } catch {
            // The page works without others; the list of people says that it is not shown. The next
            // change, or repetition, tries again.
            this.#sent = '';
            this.#setRefused(true);
        }
    }

    #setRefused(isRefused) {
        if (this.isRefused !== isRefused) {
            this.isRefused = isRefused;
            this.#onChange();
        }
    }

    #leave(isLeaving) {
        if (this.#mesh !== null) {
            api.putPresence(this.#mesh, { client: this.client, leaves: true }, isLeaving).catch(
                () => {}, // the server forgets this page anyway
            );
            this.#mesh = null;
            this.#sent = '';
        }
    }

    // Returns what is selected as the server takes it, or null. Of many faces or vertices it names only
    // the first ones and the count. The ids of many edges are not known without asking the server.
    #selected() {
        const { chosen, crowd, kind, count } = this.#session.selection;
        if (crowd === null) {
            const ids = chosen.slice(-MOST_IDS).map(({ id }) => id);
            return kind === null ? null : { kind, ids, count };
        }
        return crowd.flags === null ? null : { kind, ids: firstOf(crowd.flags, MOST_IDS), count };
    }

    #shown() {
        const camera = this.#cameraNow();
        return {
            client: this.client,
            name: this.name,
            selection: this.#selected(),
            camera:
                camera === undefined
                    ? null
                    : { position: camera.slice(0, 3), target: camera.slice(3), up: [0, 0, 1] },
        };
    }
}

// Returns the places of the first `most` ones in an array.
function firstOf(flags, most) {
    const found = [];
    for (let at = flags.indexOf(1); at >= 0 && found.length < most; at = flags.indexOf(1, at + 1)) {
        found.push(at);
    }
    return found;
}
