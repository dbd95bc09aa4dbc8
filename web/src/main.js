// main.js - puts the page together: session in the middle, panels and renderer around it.

import * as api from './api.js';
import { make } from './dom.js';
import { framing } from './framing.js';
import { Inspector } from './inspector.js';
import { keyList, listenToKeys } from './keys.js';
import { formatLink, parseLink } from './link.js';
import { MeshList } from './list.js';
import { REACH, choose } from './pick.js';
import { NoWebGL, Renderer } from './render.js';
import { Session } from './session.js';
import { Statistics } from './statistics.js';
import { Toasts } from './toast.js';
import { Tools } from './tools.js';
import { Uploads } from './upload.js';

// A pointer that moved further than this between down and up was orbiting.
const CLICK_PIXELS = 4;

// Browsers refuse an address that changes often: this long after the camera's last move.
const LINK_DELAY = 250;

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
    {
        title: page('element-title'),
        hint: page('element-hint'),
        members: page('members'),
        around: page('around'),
    },
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
const tools = new Tools(
    { select: page('operation'), form: page('parameters') },
    { onRun: run, onError: fail },
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

function run(operation) {
    session.run(operation).catch(fail);
}

function makeRenderer() {
    try {
        return new Renderer(canvas, {
            onFrame: markFrame,
            onLost: (lost) => {
                page('context-lost').hidden = !lost;
            },
            onMove: writeLinkSoon,
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
    const { mesh, shown: content, selection } = session;
    return content === null
        ? null
        : {
              mesh,
              revision: content.revision,
              selection: selection.map(({ kind, id }) => `${kind}:${id}`).join(' '),
          };
}

// The session changed: see Session for what.
function update(what) {
    if (what === 'mesh' || what === 'revision') {
        drawMesh();
        showMesh();
    }
    if (what === 'mesh') {
        renderer?.fit();
    }
    if (what !== 'state') {
        renderer?.select(session.marks, session.arrows, shown());
        inspector.show(session.selection, session.around);
        tools.setSelection(session.selection);
        writeLink();
    }
    showState();
}

function drawMesh() {
    const { geometry, boundary } = session.shown;
    try {
        renderer?.show(geometry, boundary, shown());
    } catch (error) {
        renderer.show(null, [], shown());
        fail(error);
    }
}

function showMesh() {
    const { mesh, summary } = session.shown;
    const name = summary.name || mesh;
    page('mesh-title').textContent = name;
    document.title = `${name} \u2013 hedge`;
    canvas.setAttribute(
        'aria-label',
        `3D view of ${name}. Drag to orbit, click to pick, press ? for keys.`,
    );
    page('empty').hidden = true;
    page('details').hidden = false;
    statistics.show(summary);
    list.setCurrent(mesh);
    list.update(summary);
}

function showState() {
    const { mesh, loading, busy, split } = session;
    const history = session.shown?.history;
    const ready = mesh !== null && !busy;
    page('split').disabled = !ready || split === null;
    page('split').title = SPLIT_TITLES[split] ?? 'Select a face, an edge or two vertices to split';
    page('undo').disabled = !ready || history.undo === 0;
    page('redo').disabled = !ready || history.redo === 0;
    page('fit').disabled = mesh === null || renderer === null;
    page('screenshot').disabled = mesh === null || renderer === null;
    page('goto-id').disabled = mesh === null;
    page('goto-button').disabled = mesh === null;
    tools.setEnabled(ready);
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
    const chosen = choose(pickMode(), session.shown.geometry, seen, screen);
    session.pick(chosen, event.shiftKey).catch(fail);
});

function setPickMode(mode) {
    document.querySelector(`input[name="pick"][value="${mode}"]`).checked = true;
    renderer?.showVertices(mode === 'vertex');
}

// The selection, or the whole mesh where there is none.
function frameSelection() {
    const found = session.shown === null ? null : framing(session.shown.geometry, session);
    if (found === null) {
        renderer?.fit();
    } else {
        renderer?.frame(found);
    }
}

function openTool(name) {
    if (!tools.open(name)) {
        toasts.show({ title: 'Not here', detail: `This server has no operation ${name}.` });
    }
}

// What X does to what is selected: to the last one where the operation takes only one.
function removeSelection() {
    const last = session.selection.at(-1);
    const operations = {
        vertex: 'vertex_delete',
        halfedge: 'edge_collapse',
        edge: 'edge_collapse',
        face: 'face_delete',
    };
    if (last !== undefined) {
        run(tools.operationOn(operations[last.kind], session.selection));
    }
}

// --- the address ---

let linkTimer = 0;

function writeLinkSoon() {
    clearTimeout(linkTimer);
    linkTimer = setTimeout(writeLink, LINK_DELAY);
}

// Moving the camera makes no entry in the browser's history.
function writeLink() {
    clearTimeout(linkTimer);
    const { mesh, selection } = session;
    if (mesh !== null) {
        const { kind, id } = selection.at(-1) ?? {};
        const link = formatLink({ mesh, kind, id, camera: renderer?.camera });
        window.history.replaceState(null, '', link);
    }
}

async function followLink() {
    const { mesh, kind, id, camera } = parseLink(window.location.hash);
    if (mesh === null) {
        return;
    }
    if (mesh !== session.mesh) {
        await session.open(mesh);
    }
    if (session.mesh === mesh && renderer !== null && camera !== null) {
        renderer.camera = camera;
    }
    if (session.mesh === mesh && kind !== null) {
        await session.select(kind, id);
    }
}

// --- what is pressed ---

async function saveScreenshot() {
    const blob = await renderer.capture();
    const address = URL.createObjectURL(blob);
    const name = session.shown.summary.name || session.mesh;
    make('a', { href: address, download: `${name}.png` }).click();
    URL.revokeObjectURL(address);
}

async function goTo(event) {
    event.preventDefault();
    await session.select(page('goto-kind').value, Number(page('goto-id').value));
    frameSelection();
}

const undo = () => !page('undo').disabled && session.undo().catch(fail);
const redo = () => !page('redo').disabled && session.redo().catch(fail);

listenToKeys(canvas, {
    pickVertex: () => setPickMode('vertex'),
    pickEdge: () => setPickMode('edge'),
    pickFace: () => setPickMode('face'),
    pickHalfedge: () => setPickMode('halfedge'),
    next: () => session.step('next').catch(fail),
    prev: () => session.step('prev').catch(fail),
    twin: () => session.step('twin').catch(fail),
    frame: frameSelection,
    zoomIn: () => renderer?.zoom(true),
    zoomOut: () => renderer?.zoom(false),
    move: () => openTool('vertex_move'),
    extrude: () => openTool('face_extrude'),
    inset: () => openTool('face_inset'),
    remove: removeSelection,
    undo,
    redo,
    help: () => page('help').showModal(),
    clear: () => session.clearSelection(),
});
page('keys').append(...keyList());
page('pick-modes').addEventListener('change', () => setPickMode(pickMode()));
page('help-button').addEventListener('click', () => page('help').showModal());
page('help-close').addEventListener('click', () => page('help').close());
page('screenshot').addEventListener('click', () => saveScreenshot().catch(fail));
page('goto').addEventListener('submit', (event) => goTo(event).catch(fail));
window.addEventListener('hashchange', () => followLink().catch(fail));
page('split').addEventListener('click', () => session.splitSelection().catch(fail));
page('undo').addEventListener('click', undo);
page('redo').addEventListener('click', redo);
page('fit').addEventListener('click', () => renderer.fit());
page('refresh').addEventListener('click', () => refreshList().catch(fail));
for (const button of document.querySelectorAll('.upload')) {
    button.addEventListener('click', () => page('file').click());
}
window.addEventListener('error', (event) => fail(event.error ?? event));
window.addEventListener('unhandledrejection', (event) => fail(event.reason));

showState();
inspector.show([], null);
api.getOperations()
    .then((operations) => {
        tools.setOperations(operations);
        showState();
    })
    .catch(fail);
start().catch(fail);

// What the address says, or else the first of the list.
async function start() {
    const [first] = await refreshList();
    await followLink().catch(fail);
    if (session.mesh === null && first !== undefined) {
        await session.open(first);
    }
}
