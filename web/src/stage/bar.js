// bar.js - the bar at the top of the page: the name of the open mesh, the buttons, and problems
// with the connection.

import { byId, enable } from '../kit/dom.js';
import { nameInText, seenName } from '../wire/names.js';

const SPLIT_TITLES = {
    edge_split: 'Split the edge and the faces beside it',
    face_poke: 'Divide the face into triangles around a new vertex',
    face_split: 'Split the face between the two vertices',
};

const CONNECTIONS = {
    lost: 'Connection lost, reconnecting. Changes by other clients are not shown meanwhile.',
    gone: 'This mesh was deleted; you are looking at its last state.',
};

export function showName({ mesh, summary }) {
    const name = summary.name || mesh;
    byId('mesh-title').textContent = seenName(name);
    document.title = `${nameInText(name)} \u2013 hedge`;
    byId('canvas').setAttribute(
        'aria-label',
        `3D view of ${nameInText(name)}. Drag to orbit, click to pick, press ? for keys.`,
    );
}

// Returns whether the open mesh may be edited now.
export function isReady({ mesh, busy, connection }, mayEdit) {
    return mayEdit && mesh !== null && !busy && connection !== 'gone';
}

// Shows the state of the session. `ready` says whether the mesh may be edited now, `isDrawn`
// whether the browser can draw the mesh.
export function showState(session, ready, isDrawn) {
    const { mesh, split } = session;
    const steps = session.shown?.history;
    enable(byId('split'), ready && split !== null);
    byId('split').title =
        SPLIT_TITLES[split] ?? 'Select a face, an edge or two vertices to split';
    enable(byId('undo'), ready && steps.undo > 0);
    enable(byId('redo'), ready && steps.redo > 0);
    enable(byId('export'), mesh !== null);
    enable(byId('share'), mesh !== null);
    enable(byId('mesh-menu'), mesh !== null && session.connection !== 'gone');
    enable(byId('fit'), mesh !== null && isDrawn);
    enable(byId('progressive'), mesh !== null && isDrawn);
    enable(byId('check'), mesh !== null);
    enable(byId('screenshot'), mesh !== null && isDrawn);
    enable(byId('goto-id'), mesh !== null);
    enable(byId('goto-button'), mesh !== null);
    showConnection(session);
    showLoading(session);
}

// Shows the state of the event stream if it has a problem.
function showConnection({ connection }) {
    const box = byId('connection');
    const text = CONNECTIONS[connection] ?? '';
    if (box.dataset.state !== `${connection}`) {
        box.dataset.state = connection;
        box.textContent = text;
        box.hidden = text === '';
    }
}

function showLoading({ loading }) {
    byId('loading').hidden = loading === null;
    byId('load-progress').value = loading ?? 0;
}
