// address.js - writes the open mesh, the selection and the camera into the page's address, and
// shows the mesh, selection and camera that an address names; see link.js.

import { formatLink, parseLink } from './link.js';

export class Address {
    #session;
    #stage;

    constructor(session, stage) {
        this.#session = session;
        this.#stage = stage;
    }

    // Writes the open mesh, the selection and the camera into the page's address. It replaces the
    // newest entry of the browser's history, so that moving the camera does not fill the history.
    write() {
        const { mesh, selection } = this.#session;
        if (mesh !== null) {
            const { kind, id } = selection.last ?? {};
            const link = formatLink({ mesh, kind, id, camera: this.#stage.camera });
            window.history.replaceState(null, '', link);
        }
    }

    // Shows the mesh, the selection and the camera's position that are in the page's address.
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
            this.#stage.camera = camera;
        }
        if (session.mesh === mesh && kind !== null) {
            await session.selection.select(kind, id);
        }
    }
}
