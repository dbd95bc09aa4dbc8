// main.js - puts the page together: session in the middle, panels and renderer around it.

import * as api from './api.js';
import { Inspector } from './inspector.js';
import { MeshList } from './list.js';
import { REACH, choose } from './pick.js';
import { NoWebGL, Renderer } from './render.js';
import { Session } from './session.js';
import { Statistics } from './statistics.js';
import { Toasts } from './toast.js';
import { Uploads } from './upload.js';

// A pointer that moved further than this between down and up was orbiting.
const CLICK_PIXELS = 4;

const SPLIT_TITLES = {
    edge_split: 'Split the edge and the faces beside it',
    face_poke: 'Split the face from its middle to its corners',
    face_split: 'Split the face between the two vertices',
};

const page = (id) => document.getElementById(id);
const canvas = page('canvas');
const toasts = new Toasts(page('toasts'));
const fail = (error) => toasts.show(error);

const session = new Session(update);
const statistics = new Statistics({ sizes: page('sizes'), facts: page('facts') });
const inspector = new Inspector(
    { title: page('element-title'), hint: page('element-hint'), members: page('members') },
    { onFollow: (kind, id) => session.select(kind, id).catch(fail) },
);
const list = new MeshList(
    { list: page('meshes'), more: page('more-meshes') },
    {
        readPage: api.listMeshes,
        onOpen: (mesh) => session.open(mesh).catch(fail),
        onError: fail,
    },
);
new Uploads(
    {
        input: page('file'),
        progress: page('upload-progress'),
        label: page('upload-label'),
        area: page('drop'),
    },
    {
        send: api.upload,
        onDone: async (summary) => {
            await refreshList();
            await session.open(summary.id);
        },
        onError: fail,
    },
);
const renderer = makeRenderer();

function makeRenderer() {
    try {
        return new Renderer(canvas, {
            onFrame: markFrame,
            onLost: (lost) => {
                page('context-lost').hidden = !lost;
            },
        });
    } catch (error) {
        page('no-webgl').hidden = false;
        if (!(error instanceof NoWebGL)) {
            fail(error);
        }
        return null;
    }
}

// What the frame on the screen shows, for whoever waits for it.
function markFrame(shown) {
    for (const name of ['mesh', 'revision', 'selection']) {
        if (shown?.[name] === undefined) {
            delete canvas.dataset[name];
        } else {
            canvas.dataset[name] = shown[name];
        }
    }
}

function shown() {
    const { mesh, summary, selection } = session;
    return mesh === null
        ? null
        : {
              mesh,
              revision: summary.revision,
              selection: selection.map(({ kind, id }) => `${kind}:${id}`).join(' '),
          };
}

// The session changed: see Session for what.
function update(what) {
    if (what === 'mesh' || what === 'revision') {
        renderer?.show(session.geometry, shown());
        showMesh();
    }
    if (what === 'mesh') {
        renderer?.fit();
    }
    if (what !== 'state') {
        renderer?.select(session.marks, shown());
        inspector.show(session.selection);
    }
    showState();
}

function showMesh() {
    const { mesh, summary } = session;
    const name = summary.name || mesh;
    page('mesh-title').textContent = name;
    document.title = `${name} \u2013 hedge`;
    canvas.setAttribute('aria-label', `3D view of ${name}. Drag to orbit, click to pick.`);
    page('empty').hidden = true;
    page('details').hidden = false;
    statistics.show(summary);
    list.setCurrent(mesh);
    list.update(summary);
}

function showState() {
    const { mesh, loading, busy, history, split } = session;
    const ready = mesh !== null && !busy;
    page('split').disabled = !ready || split === null;
    page('split').title = SPLIT_TITLES[split] ?? 'Select a face, an edge or two vertices to split';
    page('undo').disabled = !ready || history.undo === 0;
    page('redo').disabled = !ready || history.redo === 0;
    page('fit').disabled = mesh === null || renderer === null;
    page('loading').hidden = loading === null;
    page('load-progress').value = loading ?? 0;
}

// The empty state shows where there is nothing to open.
async function refreshList() {
    const ids = await list.refresh();
    page('empty').hidden = ids.length > 0 || session.mesh !== null;
    return ids;
}

function pickMode() {
    return document.querySelector('input[name="pick"]:checked').value;
}

let down = null;
canvas.addEventListener('pointerdown', (event) => {
    down = event.isPrimary && event.button === 0 ? event : null;
});
canvas.addEventListener('pointerup', (event) => {
    const moved = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY);
    if (down === null || moved > CLICK_PIXELS || renderer === null || session.mesh === null) {
        return;
    }
    const box = canvas.getBoundingClientRect();
    const x = event.clientX - box.left;
    const y = event.clientY - box.top;
    const screen = { matrix: renderer.matrix, width: box.width, height: box.height, x, y };
    const seen = renderer.look(x, y, REACH);
    const chosen = choose(pickMode(), session.geometry, seen, screen);
    session.pick(chosen, event.shiftKey).catch(fail);
});

page('pick-modes').addEventListener('change', () => {
    renderer?.showVertices(pickMode() === 'vertex');
});
page('split').addEventListener('click', () => session.splitSelection().catch(fail));
page('undo').addEventListener('click', () => session.undo().catch(fail));
page('redo').addEventListener('click', () => session.redo().catch(fail));
page('fit').addEventListener('click', () => renderer.fit());
page('refresh').addEventListener('click', () => refreshList().catch(fail));
for (const button of document.querySelectorAll('.upload')) {
    button.addEventListener('click', () => page('file').click());
}
window.addEventListener('error', (event) => fail(event.error ?? event));
window.addEventListener('unhandledrejection', (event) => fail(event.reason));

showState();
inspector.show([]);
refreshList()
    .then(([first]) => first !== undefined && session.open(first))
    .catch(fail);
