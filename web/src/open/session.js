// session.js - the open mesh, its selection, and the operations on it. This module does not touch
// the page: the page passes `onChange` and reads the properties.
//
// The session follows the mesh: events report edits of other clients, and the changes are fetched
// with one request at a time, however many edits there were. An edit names the revision that is
// shown. If another client has changed the mesh since then, the server refuses the edit; the page
// then fetches the changes and shows the refusal.

import * as api from '../wire/api.js';
import { wordsOf } from './entry.js';
import { Lineage } from './lineage.js';
import { Live } from '../wire/live.js';
import { Materials } from './materials.js';
import { Others } from './others.js';
import { Content } from './revision.js';
import { Selection } from './selection.js';

// After a change of a large mesh, its summary is read as soon as the mesh has not changed again for
// this many milliseconds.
const REST = 400;

export class Session {
    shown = null; // a Content; null if no mesh is open
    selection;
    loading = null; // fraction of a mesh to open that has been read, 0 to 1; null if none is opened
    busy = false; // whether an edit of this page is in progress
    own = new Set(); // the revisions of the open mesh that edits of this page have made

    #onChange;
    #onError;
    #withBoundary = true;
    #opening = null;
    // What is stored about the open mesh in addition to its Content: {live, latest, hasMissed,
    // lineage, materials}; `latest` is the newest revision that events and answers have named,
    // `hasMissed` says that events may have been missed.
    #followed = null;
    #running = null; // promise of #fetchAll() while it fetches changes
    #wanted = { once: false, whole: false };
    #rest = 0;

    // `onChange(what, change)` is called when something has changed; `what` is
    //
    //   'mesh'        another mesh was opened
    //   'content'     all arrays of the mesh are new
    //   'change'      the arrays have changed; `change` is the result of applyDelta()
    //   'facts'       the summary or the boundary loops have changed
    //   'name'        the name of the mesh has changed
    //   'history'     names of revisions have changed
    //   'selection'   other elements are selected
    //   'told'        an event told of an edit; `change` is its data
    //   'moment'      a revision has another name; `change` is the data of the event
    //   'others'      other clients came, left, or show something else
    //   'materials'   `change` is the result of Materials.note(), or null if any may have changed
    //   'gone'        the mesh was deleted
    //   'state'       `loading`, `busy` or `connection` has changed
    //
    // `onError` is called with errors of work that no caller waits for.
    constructor(onChange, onError) {
        this.#onChange = onChange;
        this.#onError = onError;
        this.selection = new Selection(
            () => this.shown?.geometry,
            () => onChange('selection'),
        );
    }

    // The id of the open mesh, or null.
    get mesh() {
        return this.shown?.mesh ?? null;
    }

    // The Materials of the open mesh, or null.
    get materials() {
        return this.#followed?.materials ?? null;
    }

    // The Others that are at the open mesh, or null.
    get others() {
        return this.#followed?.others ?? null;
    }

    // 'on', 'lost' or 'gone', see live.js; null if no mesh is open.
    get connection() {
        return this.#followed?.live.state ?? null;
    }

    // Opens a mesh and shows it when it has arrived completely. If open() is called again before
    // that, only the later call counts. The event stream is opened before the arrays are read, so
    // that no edit is missed.
    async open(mesh) {
        this.#opening?.abort();
        const opening = new AbortController();
        this.#opening = opening;
        const followed = this.#follow(mesh);
        try {
            await followed.live.open();
            opening.signal.throwIfAborted();
            const onProgress = (part) => this.#setLoading(part);
            const [shown] = await Promise.all([
                Content.read(mesh, this.#withBoundary, onProgress, opening.signal),
                followed.materials.read(opening.signal),
            ]);
            this.#followed?.live.close();
            this.#followed = followed;
            this.shown = shown;
            this.selection.reset(mesh);
            this.own.clear();
            this.#onChange('mesh');
            this.#heardOf(followed, 0);
            this.#catchUp(followed);
        } catch (error) {
            followed.live.close();
            if (error.name !== 'AbortError') {
                throw error;
            }
        } finally {
            if (this.#opening === opening) {
                this.#opening = null;
                this.#setLoading(null);
            }
        }
    }

    #follow(mesh) {
        const followed = {
            latest: 0,
            hasMissed: false,
            lineage: new Lineage(),
            materials: new Materials(mesh),
            others: new Others(),
        };
        followed.live = new Live(mesh, {
            event: (name, data) => this.#receive(followed, name, data),
            state: (state) => {
                if (followed === this.#followed) {
                    this.#onChange(state === 'gone' ? 'gone' : 'state');
                }
            },
            back: () => {
                followed.hasMissed = true;
                this.#catchUp(followed);
            },
        });
        return followed;
    }

    // If events may have been missed, fetches the changes that they would have reported. While the
    // mesh is still being opened, does nothing: open() calls this again at its end.
    #catchUp(followed) {
        if (followed.hasMissed && followed === this.#followed) {
            followed.hasMissed = false;
            this.#fetchSoon(followed, { once: true });
            this.#readMaterials(followed);
        }
    }

    #receive(followed, name, data) {
        if (name === 'edit') {
            followed.lineage.note(data);
            this.#noteMaterials(followed, data);
            this.#heardOf(followed, data.revision);
        } else if (name === 'resync') {
            this.#readMaterials(followed);
            // If this page itself has replaced the mesh, it may have fetched the new mesh before
            // this event.
            followed.latest = Math.max(followed.latest, data.revision);
            const isKnown = data.reason === 'replaced' && this.shown?.revision === data.revision;
            this.#fetchSoon(followed, { whole: !isKnown });
        } else if (name === 'metadata' && followed === this.#followed) {
            Object.assign(this.shown.summary, data);
            this.#onChange('name');
        }
        this.#receiveOfOthers(followed, name, data);
    }

    // Receives what an event tells of other clients, and of names of revisions.
    #receiveOfOthers(followed, name, data) {
        if (name === 'presence') {
            followed.others.note(data);
        }
        const what = { edit: 'told', moment: 'moment', presence: 'others' }[name];
        if (what !== undefined && followed === this.#followed) {
            this.#onChange(what, data);
        }
        if (name === 'moment' && followed === this.#followed) {
            this.#readHistory().catch((error) => error.status !== 0 && this.#onError(error));
        }
    }

    // Reads the history again, because the name of a revision has changed.
    async #readHistory() {
        const { shown } = this;
        const put = await shown.readHistory();
        if (this.shown === shown) {
            put(true); // changes may have been fetched meanwhile
            this.#onChange('history');
        }
    }

    #noteMaterials(followed, edit) {
        const change = followed.materials.note(edit);
        if (change !== null && followed === this.#followed) {
            this.#onChange('materials', change);
        }
    }

    #readMaterials(followed) {
        if (followed === this.#followed) {
            followed.materials
                .read()
                .then(() => followed === this.#followed && this.#onChange('materials', null))
                .catch((error) => error.status !== 0 && this.#onError(error));
        }
    }

    #heardOf(followed, revision) {
        followed.latest = Math.max(followed.latest, revision);
        this.#fetchSoon(followed, {});
    }

    #fetchSoon(followed, wanted) {
        if (followed !== this.#followed) {
            return;
        }
        this.#fetch(wanted).catch((error) => {
            // The request failed because the connection is lost. The event stream then ends, too,
            // and the page shows the lost connection, so it shows no error of this request.
            if (error.status !== 0) {
                this.#onError(error);
            }
        });
    }

    // Fetches changes until the newest known revision is shown; `once` makes it send at least one
    // request; `whole` makes it fetch all arrays again. A call during a fetch returns the promise
    // of that fetch.
    #fetch({ once = false, whole = false }) {
        this.#wanted.once ||= once;
        this.#wanted.whole ||= whole;
        this.#running ??= this.#fetchAll().finally(() => {
            this.#running = null;
        });
        return this.#running;
    }

    async #fetchAll() {
        const isBehind = () => this.#followed.latest > this.shown.revision;
        while (this.#wanted.once || this.#wanted.whole || isBehind()) {
            const { whole } = this.#wanted;
            this.#wanted = { once: false, whole: false };
            try {
                await this.#advance(whole);
            } catch (error) {
                // The changes belong to arrays other than those shown, for example because the mesh
                // was replaced: then all arrays are fetched.
                if (whole || !(error instanceof RangeError || error.status === 400)) {
                    throw error;
                }
                await this.#advance(true);
            }
        }
    }

    async #advance(whole) {
        const { shown } = this;
        const { revision } = shown;
        const putGeometry = await shown.readGeometry(whole);
        const puts = await Promise.all([
            this.selection.read(),
            shown.readHistory(),
            shown.isLarge ? () => this.#readFactsAtRest() : shown.readFacts(this.#withBoundary),
        ]);
        if (this.shown === shown) {
            const change = putGeometry();
            puts.forEach((put) => put());
            const isSame = shown.revision === revision;
            this.#onChange(change === null ? 'content' : isSame ? 'facts' : 'change', change);
        }
    }

    #readFactsAtRest() {
        clearTimeout(this.#rest);
        this.#rest = setTimeout(() => {
            this.#readFacts().catch((error) => error.status !== 0 && this.#onError(error));
        }, REST);
    }

    async #readFacts() {
        const { shown } = this;
        const put = await shown.readFacts(this.#withBoundary);
        if (this.shown === shown) {
            put();
            this.#onChange('facts');
        }
    }

    // Sets whether the boundary loops of the mesh are read and shown.
    async showBoundary(isShown) {
        this.#withBoundary = isShown;
        if (this.shown !== null) {
            await this.#readFacts();
        }
    }

    // Returns the element that replaced a deleted element, {kind, id}, or null.
    heirOf(element) {
        return this.#followed?.lineage.heirOf(element) ?? null;
    }

    // The operation that the button Split runs on the selected elements: 'edge_split', 'face_poke'
    // or 'face_split', or null if they cannot be split.
    get split() {
        const kinds = this.selection.chosen.map(({ kind }) => kind).join();
        const operations = {
            edge: 'edge_split',
            halfedge: 'edge_split',
            face: 'face_poke',
            'vertex,vertex': 'face_split',
        };
        return operations[kinds] ?? null;
    }

    async splitSelection() {
        const op = this.split;
        const [first, second] = this.selection.chosen;
        if (op === 'edge_split') {
            await this.run({ op, edge: first.kind === 'edge' ? first.id : first.element.edge });
        } else if (op === 'face_poke') {
            await this.run({ op, face: first.id });
        } else if (op === 'face_split') {
            const face = await this.#sharedFace(first.id, second.id);
            await this.run({ op, face, from: first.id, to: second.id });
        }
    }

    // Returns a face that has both vertices as corners. Throws a Problem if there is none.
    async #sharedFace(a, b) {
        const [ofA, ofB] = await Promise.all(
            [a, b].map((id) => api.getAdjacent(this.mesh, 'vertex', id, 'faces')),
        );
        const face = ofA.find((id) => ofB.includes(id));
        if (face === undefined) {
            throw new api.Problem({
                title: 'No shared face',
                detail: `Vertices ${a} and ${b} are not corners of one face.`,
            });
        }
        return face;
    }

    // Runs an operation, or a list of operations, on the open mesh; if it may take long, `work` shows
    // its progress, see edit() in api.js. Returns the server's answer, or null if there is none.
    run(operations, work = null) {
        return this.#edit((revision) => api.edit(this.mesh, operations, revision, work));
    }

    // Undoes the last step, or all steps since the revision `to`.
    undo(to = undefined) {
        return this.#edit((revision) => api.undo(this.mesh, revision, to));
    }

    // Makes a named set, {domain, name}, of some elements, see putSet() in api.js.
    saveSet(set, ids) {
        return this.#edit((revision) => api.putSet(this.mesh, set, ids, revision));
    }

    deleteSet(set) {
        return this.#edit(() => api.deleteSet(this.mesh, set));
    }

    // Redoes the step undone last, or as many as lead to the content of the revision `to`.
    redo(to = undefined) {
        return this.#edit((revision) => api.redo(this.mesh, revision, to));
    }

    // Undoes or redoes as many steps as lead to the content of an entry of the history.
    returnTo({ revision, state }) {
        const present = this.shown.history.entries[0]?.state ?? 0;
        return state < present ? this.undo(revision) : this.redo(revision);
    }

    // Names a revision; null takes its name away.
    async nameRevision(revision, name) {
        await api.nameRevision(this.mesh, revision, name);
        await this.#readHistory();
    }

    async #edit(send) {
        if (this.busy) {
            return null;
        }
        const followed = this.#followed;
        const { revision } = this.shown;
        this.#setBusy(true);
        try {
            const answer = await send(revision);
            if (answer !== null) {
                followed.lineage.note(answer);
                followed.latest = Math.max(followed.latest, answer.revision);
                if (followed === this.#followed) {
                    this.own.add(answer.revision);
                }
            }
            if (followed === this.#followed) {
                await this.#fetch({});
            }
            return answer;
        } catch (error) {
            if ((error.status !== 409 && error.status !== 412) || followed !== this.#followed) {
                throw error;
            }
            await this.#fetch({ once: true });
            error.detail += this.#since(revision);
            throw error;
        } finally {
            this.#setBusy(false);
        }
    }

    // Returns a sentence that lists the edits of the mesh since a revision, or '' if there are
    // none.
    #since(revision) {
        const entries = this.shown.history.entries.filter((entry) => entry.revision > revision);
        const words = entries.reverse().map(wordsOf);
        return words.length === 0
            ? ''
            : ` Meanwhile another client made these changes, which are shown now: ${words.join('; ')}.`;
    }

    #setLoading(part) {
        this.loading = part;
        this.#onChange('state');
    }

    #setBusy(busy) {
        this.busy = busy;
        this.#onChange('state');
    }
}
