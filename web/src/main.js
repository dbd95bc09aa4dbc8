// main.js - builds the page: makes the session, the panels and the 3D view, and connects them.

import { Address } from './open/address.js';
import { Share } from './open/share.js';
import * as api from './wire/api.js';
import { isReady, showName, showState } from './stage/bar.js';
import { Colouring } from './colour/colouring.js';
import { colourByDeviation, nextAfter } from './edit/offers.js';
import { Comparing } from './edit/comparing.js';
import { copyText } from './kit/clipboard.js';
import { byId, partsOf } from './kit/dom.js';
import { fileNameOf, save } from './kit/download.js';
import { Editing } from './edit/editing.js';
import { askExport } from './meshes/exporting.js';
import { framing } from './geometry/framing.js';
import { Gizmo } from './gizmo/gizmo.js';
import { History } from './panels/history.js';
import { ImportReport } from './meshes/import_report.js';
import { Importing } from './meshes/importing.js';
import { Inspector } from './panels/inspector.js';
import { keyList, listenToKeys } from './stage/keys.js';
import { Legend } from './stage/legend.js';
import { offerLinks } from './stage/links_menu.js';
import { Lens } from './lens/lens.js';
import { Look } from './look/look.js';
import { linkOf, stateOfLink } from './look/state.js';
import { MeshList } from './meshes/list.js';
import { Measuring } from './measure/measuring.js';
import { MeshActs } from './meshes/acts.js';
import { askShape } from './meshes/new_shape.js';
import { Palette } from './palette/palette.js';
import { Refining } from './open/refining.js';
import { Select } from './select/select.js';
import { Session } from './open/session.js';
import { SignIn } from './panels/sign_in.js';
import { Stage } from './stage/stage.js';
import { Guide } from './teach/guide.js';
import { Offering } from './teach/offering.js';
import { Statistics } from './panels/statistics.js';
import { Time } from './time/time.js';
import { Toasts } from './kit/toast.js';
import { onUnit } from './kit/units.js';
import { embed, isEmbedded } from './together/embed.js';
import { Flash } from './together/flash.js';
import { People } from './together/people.js';
import { Presence } from './together/presence.js';
import { Selections } from './together/selections.js';
import { unpack } from './geometry/geometry.js';
import { Uploads } from './meshes/upload.js';
import { Work } from './kit/work.js';

const canvas = byId('canvas');
const toasts = new Toasts(byId('toasts'), {
    onElement: (kind, id) => flyTo(kind, id).catch(fail),
});
const fail = (error) => toasts.show(error);

const session = new Session(update, fail);
const signIn = new SignIn(() => showWhatMayBeDone());
const statistics = new Statistics({ sizes: byId('sizes'), facts: byId('facts') });
const inspector = new Inspector(
    {
        ...partsOf('element', ['title', 'hint', 'gone']),
        members: byId('members'),
        around: byId('around'),
    },
    {
        onFollow: (kind, id) => session.selection.select(kind, id).catch(fail),
        heirOf: (element) => session.heirOf(element),
    },
);
const report = new ImportReport(
    {
        dialog: byId('report'),
        ...partsOf('report', ['file', 'close', 'repairs', 'warnings']),
        opener: byId('report-open'),
    },
    { onFollow: (kind, id) => flyTo(kind, id).catch(fail) },
);
const legend = new Legend(
    { section: byId('materials'), list: byId('legend'), toggle: byId('show-materials') },
    { onToggle: (isOn) => stage.colorFaces(isOn) },
);
const history = new History(
    { list: byId('history'), more: byId('more-history') },
    {
        readPage: (cursor) => api.getHistory(session.mesh, cursor),
        onUndo: (revision) => session.undo(revision).catch(fail),
        onReturn: (entry) => session.returnTo(entry).catch(fail),
        onLook: (revision) => time.look(revision),
        onName: (revision, name) => session.nameRevision(revision, name),
        onError: fail,
    },
);
const comparing = new Comparing(
    {
        form: byId('compare'),
        ...partsOf('compare', ['kind', 'revision', 'button', 'result']),
        other: byId('compare-mesh'),
    },
    {
        compare: (other) => editing.watch('compare', (work) => api.compare(session.mesh, other, work)),
        meshes: api.meshesToChoose,
        color: (other) => colourByDeviation(other, { colouring, editing, session }),
        onPlace: (face) => flyTo('face', face).catch(fail),
        onError: fail,
    },
);
const list = new MeshList(
    {
        list: byId('meshes'),
        more: byId('more-meshes'),
        find: { box: byId('find-mesh'), filter: byId('mesh-filter'), order: byId('mesh-order') },
        none: byId('no-mesh'),
    },
    {
        readPage: api.listMeshes,
        onOpen: (mesh) => session.open(mesh).catch(fail),
        onMore: (button, mesh) => acts.open(button, mesh),
        onError: fail,
    },
);
const work = new Work(
    {
        box: byId('uploading'),
        label: byId('upload-label'),
        progress: byId('upload-progress'),
        button: byId('upload-cancel'),
    },
    fail,
);
const acts = new MeshActs(
    { toasts, work, list },
    { onChange: refreshList, onOpen: (mesh) => session.open(mesh), onDeleted: leave },
);
const importing = new Importing({ toasts, report }, openNew);
new Uploads(
    { input: byId('file'), work, area: byId('drop') },
    {
        isOpen: mayEdit,
        send: api.upload,
        onDone: (summary, batch) => importing.done(summary, batch),
        onRefused: (error, batch) => importing.refused(error, batch),
        onError: fail,
    },
);
const stage = new Stage(
    canvas,
    {
        noWebGL: byId('no-webgl'),
        contextLost: byId('context-lost'),
        modes: byId('pick-modes'),
    },
    {
        content: () => session.shown,
        onPick: (chosen, also, place) =>
            (measuring.isOn && byId('measure-kind').value !== 'area'
                ? measuring.click(place)
                : editing.pick(chosen, also)
            ).catch(fail),
        onLine: (event) => {
            if (!measuring.isOn && !editing.isPicking) {
                select.pickLine(event).catch(fail);
            }
        },
        onMode: (kind) => {
            byId('goto-kind').value = kind;
        },
        onRest: () => {
            address.write();
            presence.soon();
        },
        onFrame: () => {
            look.frameDrawn();
            measuring.place();
            selections.place();
        },
        onSlow: () => look.slow(),
        onBroken: (reason) => look.broken(reason),
        onError: fail,
    },
);
const look = new Look(
    stage,
    {
        panel: {
            ...partsOf('view', ['button', 'close', 'form', 'reset']),
            box: byId('view-panel'),
        },
        section: partsOf('section', [
            'axes', 'box', 'slider', 'at', 'unit', 'flip', 'free', 'turn', 'tilt', 'view', 'length',
            'area', 'loops',
        ]),
        labels: { box: byId('view-labels'), grid: byId('view-grid'), cross: byId('view-cross') },
        needs: byId('look-needs'),
    },
    { content: () => session.shown, onError: fail },
);
const offering = new Offering(byId('lesson-open'), session, {
    onApply: (operation) => editing.run(operation).catch(fail),
    onError: fail,
});
const colouring = new Colouring(
    {
        section: byId('colour'),
        select: byId('colour-by'),
        ...partsOf('colour', ['part', 'scale', 'shade', 'said', 'values', 'key']),
        canvas,
    },
    session,
    stage,
    { label, onError: fail },
);
const editing = new Editing(canvas, session, stage, toasts, {
    onPicking: () => {
        refining.end();
        putToolsDown('editing');
    },
    onKnown: (operation) => offering.offer(operation),
    nextAfter: (operation, before) =>
        nextAfter(operation, before, { colouring, editing, session, onError: fail }),
});
const measuring = new Measuring(
    {
        ...partsOf('measure', [
            'button', 'kind', 'hint', 'form', 'ids', 'results', 'said', 'done', 'clear', 'labels',
        ]),
        section: byId('measure'),
    },
    session,
    stage,
    { onStart: () => putToolsDown('measuring'), onError: fail },
);
const select = new Select(canvas, session, stage, {
    isFree: () => !editing.isDragging,
    // What is selected can be measured at the same time.
    onArm: () => putToolsDown('select', byId('measure-kind').value === 'area' ? 'measuring' : ''),
    onTell: (title, detail) => toasts.tell(title, detail),
    onError: fail,
});
const gizmo = new Gizmo(canvas, session, stage, {
    onArm: () => putToolsDown('gizmo'),
    onRun: (operation) => editing.run(operation, true),
    onError: fail,
});
const lens = new Lens(
    {
        section: byId('lens'),
        ...partsOf('lens', ['run', 'meets', 'said', 'groups']),
        box: byId('lens-work'),
        ...partsOf('lens-work', ['label', 'progress', 'cancel']),
    },
    session,
    {
        show: async ({ kind, ids, ball }) => {
            stage.frame(ball);
            await session.selection.selectAll(kind, ids);
        },
        onError: fail,
    },
);
const guide = new Guide(
    {
        box: byId('guide'),
        ...partsOf('guide', ['title', 'text', 'next', 'end']),
    },
    session,
    { onMade: openNew, onRun: (operations) => session.run(operations), onError: fail },
);
const share = new Share();
share.register('look', {
    get: (isShared) => linkOf(look.state, isShared),
    set: (text) => {
        const state = text === null ? null : stateOfLink(text);
        if (state !== null) {
            look.visit({ ...state, hurry: look.state.hurry });
        }
    },
});
share.register('colour', { get: () => colouring.shared, set: (text) => colouring.show(text) });
const address = new Address(session, stage, share);
const presence = new Presence(session, isEmbedded, {
    camera: () => stage.camera,
    onChange: showPeople,
});
const selections = new Selections(byId('others'), stage, fail);
const flash = new Flash(stage);
const people = new People(
    {
        section: byId('people-section'),
        list: byId('people'),
        said: byId('people-said'),
        name: byId('own-name'),
        label: byId('own-name-label'),
    },
    {
        onLook: ({ camera }) => {
            stage.camera = [...camera.position, ...camera.target];
        },
        onName: (name) => {
            presence.name = name;
            presence.soon();
        },
    },
);
presence.name = people.name;
const time = new Time(
    {
        box: byId('time'),
        slider: byId('time-slider'),
        at: byId('time-at'),
        ...partsOf('past', ['note', 'said', 'compare', 'wipe', 'undo', 'done']),
        line: byId('wiper'),
    },
    stage,
    {
        read: async (mesh, revision, signal) =>
            unpack(await api.getEarlierGeometry(mesh, revision, signal)),
        label,
        onChange: () => {
            if (time.isOn) {
                putToolsDown();
                endRefining();
            }
            showWhatMayBeDone();
        },
        onUndo: (revision) => goBack(revision).catch(fail),
        onError: fail,
    },
);
const refining = new Refining(
    {
        button: byId('progressive'),
        box: byId('levels'),
        slider: byId('level'),
        ...partsOf('level', ['faces', 'hint', 'progress', 'play', 'done']),
    },
    stage,
    {
        onBegin: () => {
            look.suspend();
            putToolsDown();
            showWhatMayBeDone();
        },
        onEnd: () => update('content'),
        onStale: tellStale,
        onError: fail,
    },
);

// --- showing the session ---

// Called when the session has changed; the constructor of Session explains `what` and `change`.
function update(what, change) {
    const isNew = what === 'mesh' || what === 'content';
    const isChanged = isNew || what === 'change';
    if (refining.isWanted && (isChanged || session.loading !== null)) {
        endLevels();
    }
    if (isNew) {
        stage.show(session.shown.geometry, label());
    } else if (isChanged) {
        stage.update(change, label());
    }
    look.follow(what);
    if (isChanged || what === 'facts') {
        stage.setBoundary(session.shown.boundary);
        showFacts();
    }
    if (isChanged || what === 'history') {
        history.show(session.shown.history, session.mesh);
    }
    if (isChanged) {
        comparing.forget();
    }
    if (what === 'state' && session.connection === 'on') {
        list.goOn();
    }
    time.follow(what, session.shown);
    followOthers(what, change);
    if (isNew || what === 'name') {
        showName(session.shown);
        list.update(session.shown.summary);
    }
    if (what === 'mesh' || what === 'materials') {
        showMaterials(change ?? null);
    }
    if (what === 'mesh') {
        toasts.setMesh(session.mesh);
        guide.follow(session.mesh);
        byId('empty').hidden = true;
        byId('details').hidden = false;
        list.setCurrent(session.mesh);
        comparing.setMesh(session.mesh);
        report.follow(session.mesh);
        stage.fit();
    }
    if (isChanged || what === 'selection') {
        showSelection();
        editing.follow(what);
    }
    select.follow(what);
    gizmo.follow(what);
    lens.follow(what);
    colouring.follow(what);
    measuring.follow(what);
    if (what === 'gone') {
        presence.forget(session.mesh);
        refreshList().catch(fail);
    }
    showWhatMayBeDone();
}

onUnit(() => {
    if (session.shown !== null) {
        showFacts();
        inspector.show(session.selection);
    }
});

// Shows what other clients do, and this page to them.
function followOthers(what, change) {
    const isChanged = what === 'mesh' || what === 'content' || what === 'change';
    if (what === 'mesh') {
        flash.reset();
    }
    if (what === 'told') {
        flash.note(change);
    }
    flash.follow(session);
    if (isChanged || what === 'others') {
        showPeople();
        selections.show(session.shown, session.others.besides(presence.client));
    }
    if (isChanged || what === 'selection' || what === 'state') {
        presence.soon();
    }
}

function showPeople() {
    if (session.mesh !== null) {
        const others = session.others.besides(presence.client);
        people.show(others, signIn.name, presence.isRefused);
    }
}

// Undoes, or redoes, as many edits as lead to the content of a revision.
function goBack(revision) {
    const { entries } = session.shown.history;
    const entry = entries.find((one) => one.revision === revision);
    return entry === undefined ? session.undo(revision) : session.returnTo(entry);
}

async function copyLink() {
    await copyText(address.link);
    toasts.tell('Link copied', 'It shows this mesh as you see it now.');
}

// Shows the link itself, because the browser does not let the page copy it.
function tellLink() {
    toasts.tell('Copy this link', address.link);
}

function endRefining() {
    if (refining.isWanted) {
        refining.end();
    }
}

// Returns a label that says what the next frame will show.
function label() {
    const { mesh, shown: content, selection } = session;
    if (refining.isOn) {
        return refining.label;
    }
    return content === null
        ? null
        : {
              mesh,
              revision: content.revision,
              selection: selection.name,
              materials: session.materials.revision,
              colour: colouring.label,
              past: time.revision ?? undefined,
          };
}

// The properties `geometry` and `look` of the canvas are for tests, which compare the first with what the
// server sends, and set the state of the second.
Object.defineProperty(canvas, 'geometry', { get: () => session.shown?.geometry ?? null });
Object.defineProperty(canvas, 'look', { value: look });

function showSelection() {
    const { shown: content, selection } = session;
    if (content !== null) {
        const { geometry } = content;
        stage.select(selection.marksIn(geometry), selection.arrowsIn(geometry), label());
        stage.selectMany(selection.crowd);
    }
    inspector.show(selection);
    showMaterialOfSelection();
    address.write();
}

// Shows the materials. `change` is a result of Materials.note(), or null if all materials may have
// changed.
function showMaterials(change) {
    const { materials } = session;
    if (change === null) {
        stage.showMaterials(materials, label());
    } else {
        stage.updateMaterials(materials, change, label());
    }
    if (change === null || change.palette) {
        legend.show(materials);
    }
    showMaterialOfSelection();
}

function showMaterialOfSelection() {
    const { last } = session.selection;
    legend.setCurrent(last?.kind === 'face' ? session.materials.nameOf(last.id) : '');
}

function showFacts() {
    const { summary, hasFacts } = session.shown;
    statistics.show(summary, hasFacts);
    list.update(summary);
    byId('boundary-toggle').hidden = summary.counts.boundary_loops === 0;
}

function showWhatMayBeDone() {
    const ready = isReady(session, mayEdit()) && !refining.isOn && !time.isOn;
    const isSeen = session.mesh !== null && !refining.isOn && !time.isOn;
    showState(session, ready, stage.isThere);
    editing.setEnabled(ready);
    measuring.setEnabled(isSeen);
    select.setEnabled(isSeen, ready);
    gizmo.setEnabled(ready);
    history.setEnabled(ready);
    lens.setEnabled(ready, session.mesh !== null);
}

// Ends the showing of levels of detail. It is called when another mesh or revision is shown,
// because the levels belong to the earlier one.
function endLevels() {
    refining.end();
    if (session.loading === null) {
        tellStale();
    }
}

function tellStale() {
    toasts.tell('Back to the mesh', 'The mesh was changed, so the levels of detail are outdated.');
}

// Reads the list of meshes again, and shows a hint if there are none. Returns the ids in its first
// page.
async function refreshList() {
    const ids = await list.refresh();
    byId('empty').hidden = ids.length > 0 || session.mesh !== null || list.filter !== '';
    return ids;
}

// Called when the user has deleted a mesh. If it is the open one, opens the one beside it in the
// list.
async function leave(mesh) {
    presence.forget(mesh);
    const beside = list.neighbour(mesh);
    await refreshList();
    if (mesh === session.mesh && beside !== null) {
        await session.open(beside);
    }
}

// Opens a mesh that the user has just made, given by its summary.
async function openNew({ id }) {
    await refreshList();
    await session.open(id);
}

// --- buttons ---

// Whether the user may change meshes. A page in a frame of another page only shows them.
function mayEdit() {
    return signIn.mayEdit && !isEmbedded;
}

// Ends all that waits for clicks or drags in the view, except the named tools.
function putToolsDown(...kept) {
    const tools = {
        editing: () => editing.stop(),
        select: () => select.cancel(),
        gizmo: () => gizmo.hide(),
        measuring: () => measuring.stop(),
    };
    Object.entries(tools).forEach(([name, putDown]) => kept.includes(name) || putDown());
}

// Handles the Esc key: ends what is going on in the view, or else clears the selection.
function giveUp() {
    if (time.isOn) {
        time.end();
    } else if (refining.isWanted) {
        refining.end();
    } else if (select.isArmed) {
        select.cancel();
    } else if (gizmo.isOn) {
        gizmo.hide();
    } else if (measuring.isOn) {
        measuring.giveUp();
    } else {
        editing.giveUp();
    }
}

// Moves the camera to the selection, or to the whole mesh if nothing is selected.
function frameSelection() {
    const geometry = session.shown?.geometry;
    stage.frame(geometry === undefined ? null : framing(geometry, session.selection));
}

async function saveScreenshot() {
    const name = session.shown.summary.name || session.mesh;
    save(await stage.capture(), fileNameOf(name, 'png'));
}

async function goTo(event) {
    event.preventDefault();
    await flyTo(byId('goto-kind').value, Number(byId('goto-id').value));
}

// Selects an element and moves the camera to it.
async function flyTo(kind, id) {
    await session.selection.select(kind, id);
    frameSelection();
}

function toggleLevels() {
    if (refining.isWanted) {
        refining.end();
    } else {
        time.end();
        refining.begin(session.shown).catch(fail);
    }
}

const undo = () => !byId('undo').disabled && session.undo().catch(fail);
const redo = () => !byId('redo').disabled && session.redo().catch(fail);

listenToKeys(canvas, {
    type: (key) => editing.typeAmount(key),
    pickVertex: () => stage.setPickMode('vertex'),
    pickEdge: () => stage.setPickMode('edge'),
    pickFace: () => stage.setPickMode('face'),
    pickHalfedge: () => stage.setPickMode('halfedge'),
    next: () => session.selection.step('next').catch(fail),
    prev: () => session.selection.step('prev').catch(fail),
    twin: () => session.selection.step('twin').catch(fail),
    frame: frameSelection,
    zoomIn: () => stage.zoom(true),
    zoomOut: () => stage.zoom(false),
    view: () => !isEmbedded && look.toggle(),
    nextWay: () => look.nextWay(),
    move: () => editing.start('move', true),
    extrude: () => editing.start('extrude', true),
    inset: () => editing.start('inset', true),
    split: () => byId('split').click(),
    remove: () => byId('remove').click(),
    undo,
    redo,
    check: () => byId('check').click(),
    help: () => byId('help').showModal(),
    measure: () => measuring.toggle(),
    clear: giveUp,
    ...Object.fromEntries(['box', 'lasso', 'paint'].map((tool) => [tool, () => select.draw(tool)])),
    ...Object.fromEntries(
        ['all', 'invert', 'grow', 'shrink', 'connected'].map((name) => [name, () => select.change(name)]),
    ),
    gizmo: () => gizmo.toggle(),
    loop: () => select.line('loop'),
    ring: () => select.line('ring'),
});
byId('keys').append(...keyList());
byId('help-button').addEventListener('click', () => byId('help').showModal());
offerLinks(byId('links-menu'));
byId('help-close').addEventListener('click', () => byId('help').close());
byId('screenshot').addEventListener('click', () => saveScreenshot().catch(fail));
byId('share').addEventListener('click', () => copyLink().catch(tellLink));
byId('export').addEventListener('click', () => askExport(session.shown, toasts).catch(fail));
byId('goto').addEventListener('submit', (event) => goTo(event).catch(fail));
byId('mesh-menu').addEventListener('click', () => {
    acts.open(byId('mesh-menu'), { id: session.mesh, name: session.shown.summary.name });
});
window.addEventListener('hashchange', () => address.follow().catch(fail));
byId('split').addEventListener('click', () => session.splitSelection().catch(fail));
byId('undo').addEventListener('click', undo);
byId('redo').addEventListener('click', redo);
byId('show-boundary').addEventListener('change', (event) => {
    session.showBoundary(event.target.checked).catch(fail);
});
byId('examples').addEventListener('click', () => guide.choose());
byId('check').addEventListener('click', () => lens.reveal());
byId('fit').addEventListener('click', () => stage.fit());
byId('progressive').addEventListener('click', toggleLevels);
byId('refresh').addEventListener('click', () => signIn.start().then(refreshList).catch(fail));
for (const button of document.querySelectorAll('.upload')) {
    button.addEventListener('click', () => byId('file').click());
}
for (const button of document.querySelectorAll('.new-shape')) {
    button.addEventListener('click', () => askShape(openNew).catch(fail));
}
window.addEventListener('error', (event) => fail(event.error ?? event));
window.addEventListener('unhandledrejection', (event) => fail(event.reason));

if (isEmbedded) {
    embed(() => address.link);
} else {
    new Palette({
        operations: () => (mayEdit() && session.mesh !== null ? editing.operations : []),
        onOpen: (name) => editing.openForm(name),
    });
}
showWhatMayBeDone();
inspector.show(session.selection);
api.getOperations()
    .then((operations) => {
        editing.setOperations(operations);
        offering.setOperations(operations);
        showWhatMayBeDone();
    })
    .catch(fail);
start().catch(fail);

// Opens the mesh that the page's address names, or else the first mesh of the list.
async function start() {
    await signIn.start();
    const [first] = await refreshList();
    await address.follow().catch(fail);
    if (session.mesh === null && first !== undefined) {
        await session.open(first);
    }
}
