// address.js - writes the open mesh, the selection, the camera and the parts of share.js into the
// page's address, and shows what an address names; see link.js.

import { formatLink, parseLink } from './link.js';

export class Address {
    #session;
    #stage;
    #share;

    constructor(session, stage, share) {
        this.#session = session;
        this.#stage = stage;
        this.#share = share;
    }

    // Writes the open mesh, the selection, the camera and all parts into the page's address. It replaces the
    // newest entry of the browser's history, so that moving the camera does not fill the history. If
    // `isShared` is true, parts in their usual state are written, too, see share.js.
    write(isShared = false) {
        const { mesh, selection } = this.#session;
        if (mesh !== null) {
            const kind = selection.last?.kind;
            const ids = selection.chosen.map(({ id }) => id);
            const { camera } = this.#stage;
            const link = formatLink({ mesh, kind, ids, camera, parts: this.#share.parts(isShared) });
            window.history.replaceState(null, '', link);
        }
    }

    // Returns the whole address of what is shown now.
    get link() {
        this.write(true);
        return window.location.href;
    }

    // Shows the mesh, the selection, the camera's position and the parts that are in the page's
    // address.
    async follow() {
        const { mesh, kind, ids, camera, parts } = parseLink(window.location.hash);
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
        // The parts are shown even if the element does not exist any more.
        try {
            if (session.mesh === mesh && ids.length > 1) {
                await session.selection.selectAll(kind, ids);
            } else if (session.mesh === mesh && kind !== null) {
                await session.selection.select(kind, ids[0]);
            }
        } finally {
            if (session.mesh === mesh) {
                await this.#share.show(parts);
            }
        }
    }
}
