// main.js - puts the page together: session in the middle, panels and renderer around it.

import * as api from './api.js';
import { Direct } from './direct.js';
import { formatCount, make } from './dom.js';
import { framing } from './framing.js';
import { begin, drag } from './gesture.js';
import { History } from './history.js';
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
import { Trial } from './trial.js';
import { Uploads } from './upload.js';
import { Work } from './work.js';

// A pointer that moved further than this between down and up was orbiting.
const CLICK_PIXELS = 4;

// Browsers refuse an address that changes often: this long after the camera's last move.
const LINK_DELAY = 250;

// What works on all of a mesh is not tried beforehand on one of more faces.
const MOST_TRIED = 100000;

const SPLIT_TITLES = {
    edge_split: 'Split the edge and the faces beside it',
    face_poke: 'Split the face from its middle to its corners',
    face_split: 'Split the face between the two vertices',
};

const page = (id) => document.getElementById(id);
const canvas = page('canvas');
const toasts = new Toasts(page('toasts'));
const fail = (error) => toasts.show(error);

const session = new Session(update, fail);
const statistics = new Statistics({ sizes: page('sizes'), facts: page('facts') });
const inspector = new Inspector(
    {
        title: page('element-title'),
        hint: page('element-hint'),
        gone: page('element-gone'),
        members: page('members'),
        around: page('around'),
    },
    {
        onFollow: (kind, id) => session.selection.select(kind, id).catch(fail),
        heirOf: (element) => session.heirOf(element),
    },
);
const history = new History(
    { list: page('history'), more: page('more-history') },
    {
        readPage: (cursor) => api.getHistory(session.mesh, cursor),
        onUndo: (revision) => session.undo(revision).catch(fail),
        onError: fail,
    },
);
const work = new Work(
    {
        box: page('work'),
        label: page('work-label'),
        progress: page('work-progress'),
        button: page('work-cancel'),
    },
    fail,
);
const list = new MeshList(
    { list: page('meshes'), more: page('more-meshes') },
    {
        readPage: api.listMeshes,
        onOpen: (mesh) => session.open(mesh).catch(fail),
        onError: fail,
    },
);
const trial = new Trial(page('verdict'), tryOut);
const tools = new Tools(
    { select: page('operation'), form: page('parameters'), search: page('operation-search') },
    {
        onRun: (operation) => run(operation).catch(fail),
        onTouch: (operation, error) => {
            if (error === null) {
                trial.ask(operation);
            } else {
                trial.refuse(error);
            }
        },
        onArm: setPickMode,
        meshes: async () => (await api.listMeshes()).items,
        onError: fail,
    },
);
new Uploads(
    {
        input: page('file'),
        work: new Work(
            {
                box: page('uploading'),
                label: page('upload-label'),
                progress: page('upload-progress'),
                button: page('upload-cancel'),
            },
            fail,
        ),
        area: page('drop'),
    },
    {
        send: api.upload,
        onDone: async (summary, file) => {
            await refreshList();
            await session.open(summary.id);
            toasts.tell(`Read ${file.name}`, importOf(summary));
        },
        onError: (error, again) => toasts.show(error, again),
    },
);
const directTools = ['move', 'extrude', 'inset'];
const direct = new Direct(
    canvas,
    {
        note: page('direct-note'),
        hint: page('direct-hint'),
        amount: page('direct-amount'),
        buttons: Object.fromEntries(directTools.map((tool) => [tool, page(`direct-${tool}`)])),
    },
    {
        begin: (tool) =>
            renderer && begin(tool, session.selection.chosen, session.shown.geometry),
        drag: (gesture, moved) => drag(gesture, renderer.view, moved),
        onShow: (lines) => renderer?.preview(lines),
        onRun: (operation) => run(operation).catch(fail),
    },
);
const renderer = makeRenderer();

function importOf({ counts, import: report }) {
    const found = ['repairs', 'warnings']
        .filter((name) => report?.[name]?.length > 0)
        .map((name) => `${formatCount(report[name].length)} ${name}`);
    const sizes = ['vertices', 'faces'].map((kind) => `${formatCount(counts[kind])} ${kind}`);
    return [...sizes, ...found].join(', ');
}

async function tryOut(operation, signal) {
    const { mesh, shown: content, busy } = session;
    const isDear =
        tools.isWhole(operation.op) && content?.summary.counts.faces > MOST_TRIED;
    return mesh === null || busy || isDear ? null : api.tryEdit(mesh, operation, signal);
}

async function run(operation) {
    trial.clear();
    direct.cancel();
    if (!tools.isWhole(operation.op)) {
        await session.run(operation);
        return;
    }
    work.start(operation.op, false);
    try {
        await session.run(operation, work);
        toasts.tell(operation.op, `Done: this is revision ${session.shown.revision}.`);
    } finally {
        work.end();
    }
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
              selection: selection.chosen.map(({ kind, id }) => `${kind}:${id}`).join(' '),
          };
}

// Of what a test compares with what the server sends.
Object.defineProperty(canvas, 'geometry', { get: () => session.shown?.geometry ?? null });

// The session changed: see Session for what.
function update(what, change) {
    const isNew = what === 'mesh' || what === 'content';
    if (isNew) {
        draw(() => renderer?.show(session.shown.geometry, shown()));
    } else if (what === 'change') {
        draw(() => renderer?.update(change, shown()));
    }
    if (what === 'facts') {
        renderer?.setBoundary(session.shown.boundary);
        showFacts();
    } else if (isNew || what === 'change') {
        renderer?.setBoundary(session.shown.boundary);
        showFacts();
        history.show(session.shown.history);
    }
    if (isNew || what === 'name') {
        showName();
    }
    if (what === 'mesh') {
        showMesh();
        renderer?.fit();
    }
    if (isNew || what === 'change' || what === 'selection') {
        showSelection();
        if (what === 'mesh' || what === 'selection') {
            direct.cancel();
        } else {
            direct.refresh();
        }
        if (what === 'mesh') {
            trial.clear();
        } else if (what !== 'selection') {
            trial.askAgain();
        }
    }
    if (what === 'gone') {
        refreshList().catch(fail);
    }
    showState();
}

function draw(act) {
    try {
        act();
    } catch (error) {
        renderer.show(null, shown());
        fail(error);
    }
}

function showSelection() {
    const { shown: content, selection } = session;
    if (content !== null) {
        const { geometry } = content;
        const marks = selection.marksIn(geometry);
        renderer?.select(marks, selection.arrowsIn(geometry), shown());
    }
    inspector.show(selection);
    tools.setSelection(selection.chosen);
    writeLink();
}

function showMesh() {
    page('empty').hidden = true;
    page('details').hidden = false;
    list.setCurrent(session.mesh);
}

function showFacts() {
    const { summary, hasFacts } = session.shown;
    statistics.show(summary, hasFacts);
    list.update(summary);
    page('boundary-toggle').hidden = summary.counts.boundary_loops === 0;
}

function showName() {
    const { mesh, summary } = session.shown;
    const name = summary.name || mesh;
    page('mesh-title').textContent = name;
    document.title = `${name} \u2013 hedge`;
    canvas.setAttribute(
        'aria-label',
        `3D view of ${name}. Drag to orbit, click to pick, press ? for keys.`,
    );
    list.update(summary);
}

const CONNECTIONS = {
    lost: 'Connection lost, trying again. What others do meanwhile is not shown.',
    gone: 'This mesh was deleted. What you see is what it was last.',
};

// What the stream of events is like, said where that is a hindrance.
function showConnection() {
    const { connection } = session;
    const box = page('connection');
    const text = CONNECTIONS[connection] ?? '';
    if (box.dataset.state !== `${connection}`) {
        box.dataset.state = connection;
        box.textContent = text;
        box.hidden = text === '';
    }
}

function showState() {
    const { mesh, loading, busy, split, connection } = session;
    const steps = session.shown?.history;
    const ready = mesh !== null && !busy && connection !== 'gone';
    page('split').disabled = !ready || split === null;
    page('split').title = SPLIT_TITLES[split] ?? 'Select a face, an edge or two vertices to split';
    page('undo').disabled = !ready || steps.undo === 0;
    page('redo').disabled = !ready || steps.redo === 0;
    page('fit').disabled = mesh === null || renderer === null;
    page('screenshot').disabled = mesh === null || renderer === null;
    page('goto-id').disabled = mesh === null;
    page('goto-button').disabled = mesh === null;
    tools.setEnabled(ready);
    direct.setEnabled(ready);
    history.setEnabled(ready);
    showConnection();
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
    const act = tools.isArmed
        ? giveToField(chosen)
        : session.selection.pick(chosen, event.shiftKey);
    act.catch(fail);
});

// What pick.js chose goes to the field of the form that waits for it.
async function giveToField(chosen) {
    const id = chosen === null ? null : await session.selection.idOf(chosen);
    if (id !== null) {
        const isVertex = chosen.kind === 'vertex';
        const place = isVertex
            ? (await api.getElement(session.mesh, 'vertex', id)).position
            : undefined;
        if (tools.isArmed) {
            tools.take(id, place);
        }
    }
}

function setPickMode(mode) {
    document.querySelector(`input[name="pick"][value="${mode}"]`).checked = true;
    renderer?.showVertices(mode === 'vertex');
}

// The selection, or the whole mesh where there is none.
function frameSelection() {
    const geometry = session.shown?.geometry;
    const found = geometry === undefined ? null : framing(geometry, session.selection);
    if (found === null) {
        renderer?.fit();
    } else {
        renderer?.frame(found);
    }
}

function openTool(name) {
    if (tools.has(name)) {
        tools.open(name);
    } else {
        toasts.show({ title: 'Not here', detail: `This server has no operation ${name}.` });
    }
}

// The form of a tool for what is selected, where it is not used in the view.
const FORMS = { move: 'vertex_move', extrude: 'face_extrude', inset: 'face_inset' };

// Arm a tool of the view, or show the form where nothing is selected that it fits. The form of what
// is selected is shown beside it, for who wants numbers.
function startDirect(tool, isKey) {
    const name = FORMS[tool];
    const isThere = isKey ? direct.arm(tool) : direct.toggle(tool);
    if (!tools.has(name) || !isThere) {
        direct.cancel();
        openTool(name);
    } else if (direct.isArmed && session.selection.last.kind === name.split('_')[0]) {
        tools.show(name);
    }
}

// What Esc gives up: the nearest to hand.
function giveUp() {
    if (direct.isArmed) {
        direct.cancel();
    } else if (tools.isArmed) {
        tools.disarm();
    } else {
        session.selection.clear();
    }
}

// What X does to what is selected: to the last one where the operation takes only one.
function removeSelection() {
    const { chosen, last } = session.selection;
    const operations = {
        vertex: 'vertex_delete',
        halfedge: 'edge_collapse',
        edge: 'edge_collapse',
        face: 'face_delete',
    };
    if (last !== undefined) {
        run(tools.operationOn(operations[last.kind], chosen)).catch(fail);
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
        const { kind, id } = selection.last ?? {};
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
        await session.selection.select(kind, id);
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
    await session.selection.select(page('goto-kind').value, Number(page('goto-id').value));
    frameSelection();
}

const undo = () => !page('undo').disabled && session.undo().catch(fail);
const redo = () => !page('redo').disabled && session.redo().catch(fail);

listenToKeys(canvas, {
    pickVertex: () => setPickMode('vertex'),
    pickEdge: () => setPickMode('edge'),
    pickFace: () => setPickMode('face'),
    pickHalfedge: () => setPickMode('halfedge'),
    next: () => session.selection.step('next').catch(fail),
    prev: () => session.selection.step('prev').catch(fail),
    twin: () => session.selection.step('twin').catch(fail),
    frame: frameSelection,
    zoomIn: () => renderer?.zoom(true),
    zoomOut: () => renderer?.zoom(false),
    move: () => startDirect('move', true),
    extrude: () => startDirect('extrude', true),
    inset: () => startDirect('inset', true),
    split: () => page('split').click(),
    remove: removeSelection,
    undo,
    redo,
    help: () => page('help').showModal(),
    clear: giveUp,
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
page('show-boundary').addEventListener('change', (event) => {
    session.showBoundary(event.target.checked).catch(fail);
});
for (const tool of directTools) {
    page(`direct-${tool}`).addEventListener('click', () => startDirect(tool, false));
}
page('fit').addEventListener('click', () => renderer.fit());
page('refresh').addEventListener('click', () => refreshList().catch(fail));
for (const button of document.querySelectorAll('.upload')) {
    button.addEventListener('click', () => page('file').click());
}
window.addEventListener('error', (event) => fail(event.error ?? event));
window.addEventListener('unhandledrejection', (event) => fail(event.reason));

showState();
inspector.show(session.selection);
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
