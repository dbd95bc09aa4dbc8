// address.js - what is shown is in the page's address, and an address shows it again; see link.js.

import { formatLink, parseLink } from './link.js';

// Browsers refuse an address that changes often: this long after the camera's last move.
const DELAY = 250;

export class Address {
    #session;
    #stageNow;
    #timer = 0;

    // `stage()` gives the view, which is made later.
    constructor(session, stage) {
        this.#session = session;
        this.#stageNow = stage;
    }

    // The camera moves, and perhaps goes on doing so.
    writeSoon() {
        clearTimeout(this.#timer);
        this.#timer = setTimeout(() => this.write(), DELAY);
    }

    // Moving the camera makes no entry in the browser's history.
    write() {
        clearTimeout(this.#timer);
        const { mesh, selection } = this.#session;
        if (mesh !== null) {
            const { kind, id } = selection.last ?? {};
            const link = formatLink({ mesh, kind, id, camera: this.#stageNow().camera });
            window.history.replaceState(null, '', link);
        }
    }

    // Show what the address says.
    async follow() {
        const { mesh, kind, id, camera } = parseLink(window.location.hash);
        const session = this.#session;
        if (mesh === null) {
            return;
        }
        if (mesh !== session.mesh) {
            await session.open(mesh);
        }
        if (session.mesh === mesh && camera !== null) {
            this.#stageNow().camera = camera;
        }
        if (session.mesh === mesh && kind !== null) {
            await session.selection.select(kind, id);
        }
    }
}
