// lens.js - the check lens: a list of everything that a check of the mesh finds, with its boundary
// loops and components. A click on a finding shows it in the view and offers ways to mend it, which
// are tried before they are done.
//
// The list belongs to one revision. When the mesh has changed, the list is read again, unless the
// mesh is large: then the user is told that the list is outdated.

import * as api from '../wire/api.js';
import { enable, formatCount, make } from '../kit/dom.js';
import { elementsOf, groupsOf, restOf, summaryOf, wordsOfPlace } from './findings.js';
import { Mend } from './mend.js';
import { ballAround, cornersOf } from './places.js';
import { MOST_READ } from '../open/selection.js';
import { onUnit } from '../kit/units.js';
import { wordsOf } from '../edit/trial.js';
import { Work } from '../kit/work.js';

// A group shows at most this many findings until the user wants more.
const MOST_SHOWN = 50;

// At first a group with more findings than this is closed.
const MOST_OPEN = 8;

// An operation on a large mesh is not tried before it is done.
const MOST_TRIED = 100000;

export class Lens {
    #elements;
    #session;
    #acts;
    #work;
    #isOn = false; // whether the user has asked to check the mesh
    #reading = null; // the AbortController of the check that is read
    #groups = null; // null: nothing was read yet
    #revision = 0; // the revision of the groups
    #open = null; // key of the item that is open
    #all = null; // name of the group of which all findings are about to be mended
    #folded = new Map(); // name of a group -> whether the user has closed it
    #mends = [];
    #isReady = false;
    #refocus = null; // {group, at}: where the focus goes when the list was read again

    // `elements` are those of the page: section, run, meets, said, groups, and box, label, progress
    // and cancel for work that takes long. `acts` has functions: show({kind, ids, ball}) selects
    // elements and moves the camera to a ball; onError(error).
    constructor(elements, session, acts) {
        this.#elements = elements;
        this.#session = session;
        this.#acts = acts;
        const { box, label, progress, cancel } = elements;
        this.#work = new Work({ box, label, progress, button: cancel }, acts.onError);
        elements.run.addEventListener('click', () => this.check());
        onUnit(() => {
            if (this.#groups !== null && !session.shown.isLarge) {
                this.check();
            }
        });
        elements.meets.addEventListener('change', () => {
            if (this.#isOn) {
                this.check();
            }
        });
    }

    // Checks the mesh and moves the focus to the result.
    reveal() {
        this.#elements.run.focus();
        this.check(() => this.#elements.section.scrollIntoView({ block: 'start' }));
    }

    // Called when the session has changed; `what` is explained at the constructor of Session.
    follow(what) {
        if (what === 'mesh') {
            this.#reset();
        } else if ((what === 'change' || what === 'content') && this.#isOn) {
            const isOwn = this.#refocus?.done !== undefined;
            if (this.#session.shown.isLarge && !isOwn && this.#reading === null) {
                this.#say(`The mesh has changed since revision ${this.#revision}. Check it again.`);
            } else {
                this.check();
            }
        }
    }

    setEnabled(isReady, isThere) {
        this.#isReady = isReady;
        enable(this.#elements.run, isThere);
        this.#mends.forEach((mend) => mend.setEnabled(isReady));
    }

    #reset() {
        this.#reading?.abort();
        this.#isOn = false;
        this.#groups = null;
        this.#open = null;
        this.#all = null;
        this.#refocus = null;
        this.#folded.clear();
        this.#say('');
        this.#render();
    }

    #say(text) {
        this.#elements.said.textContent = text;
    }

    // --- reading ---

    // Reads and shows the list; then calls `andThen()`.
    check(andThen = () => {}) {
        this.#isOn = true;
        this.#check().then(andThen).catch(this.#acts.onError);
    }

    async #check() {
        this.#reading?.abort();
        const reading = new AbortController();
        this.#reading = reading;
        const { mesh } = this.#session;
        this.#elements.groups.setAttribute('aria-busy', 'true');
        if (this.#groups === null) {
            this.#say('Checking\u2026');
        }
        this.#work.start('Checking the mesh', false);
        try {
            const found = await this.#read(mesh, reading.signal);
            // If the page shows another revision, it will change soon, and the mesh is checked again.
            const { revision } = this.#session.shown;
            if (!reading.signal.aborted && found.check.revision === revision) {
                this.#take(found);
            }
        } catch (error) {
            if (!reading.signal.aborted) {
                this.#say(this.#groups === null ? '' : `Checked revision ${this.#revision}.`);
                throw error;
            }
        } finally {
            if (this.#reading === reading) {
                this.#reading = null;
                this.#work.end();
                this.#elements.groups.setAttribute('aria-busy', 'false');
            }
        }
    }

    // Reads what the list shows, of one revision.
    async #read(mesh, signal) {
        for (;;) {
            const [check, { loops, ...boundaries }, { components, ...connected }] = await Promise.all([
                api.getCheck(mesh, this.#elements.meets.checked, signal, this.#work),
                api.getBoundaries(mesh, signal),
                api.getComponents(mesh, signal),
            ]);
            const wanted = elementsOf(check);
            const answers =
                wanted.length === 0
                    ? []
                    : await api.query(mesh, wanted.map(({ kind, id }) => ({ get: { [kind]: id } })));
            const elements = new Map(
                wanted
                    .map(({ kind, id }, i) => [`${kind}:${id}`, answers[i]])
                    .filter(([, answer]) => !('status' in answer)),
            );
            const { revision } = check;
            if (boundaries.revision === revision && connected.revision === revision) {
                return { check, loops, components, elements };
            }
            signal.throwIfAborted();
        }
    }

    #take(found) {
        const { geometry, summary } = this.#session.shown;
        const degrees = Object.keys(summary.degrees);
        const isTriangles = degrees.length === 1 && degrees[0] === '3';
        this.#groups = groupsOf(geometry, found, isTriangles);
        this.#revision = found.check.revision;
        this.#render();
        const done = this.#refocus?.done ?? '';
        this.#say(`${done} ${summaryOf(this.#groups, found.check.complete)}`.trim());
        this.#restoreFocus();
    }

    // --- showing ---

    #render() {
        this.#mends.forEach((mend) => mend.cancel());
        this.#mends = [];
        const { groups, run } = this.#elements;
        if (groups.contains(document.activeElement)) {
            this.#refocus ??= this.#focused();
        }
        run.textContent = this.#groups === null ? 'Check the mesh' : 'Check again';
        groups.replaceChildren(...(this.#groups ?? []).map((group) => this.#groupBox(group)));
    }

    // Returns where the focus is in the list, {group, at}.
    #focused() {
        const group = document.activeElement.closest('.lens-group');
        const item = document.activeElement.closest('li');
        return {
            group: group?.dataset.group,
            at: item === null ? -1 : [...item.parentElement.children].indexOf(item),
        };
    }

    // Moves the focus to what is now at the place where it was: the finding that followed the one
    // that was mended, or the head of the group, or the button at the head of the list.
    #restoreFocus() {
        const refocus = this.#refocus;
        this.#refocus = null;
        if (refocus === null || document.activeElement !== document.body) {
            return;
        }
        const { groups, run } = this.#elements;
        const group = groups.querySelector(`[data-group="${refocus.group}"]`);
        const items = [...(group?.querySelectorAll('.finding') ?? [])];
        const item = refocus.at < 0 ? undefined : (items[refocus.at] ?? items.at(-1));
        (item ?? group?.querySelector('summary') ?? run).focus();
    }

    #groupBox(group) {
        const { name, title, total, items, all } = group;
        const isSmall = items.length <= MOST_OPEN && name !== 'components';
        const box = make(
            'details',
            {
                className: 'lens-group',
                open: !(this.#folded.get(name) ?? !isSmall) || this.#isIn(items),
                ontoggle: () => this.#folded.set(name, !box.open),
            },
            make(
                'summary',
                {},
                make('span', {}, title),
                make('span', { className: 'count' }, formatCount(total)),
            ),
        );
        box.dataset.group = name;
        if (all !== null) {
            box.append(this.#allBox(name, all));
        }
        const list = make('ul', { 'aria-label': title });
        box.append(list);
        this.#append(list, items, 0);
        const rest = restOf(group);
        if (rest !== '') {
            box.append(make('p', { className: 'small' }, rest));
        }
        return box;
    }

    // Whether the open item is one of these.
    #isIn(items) {
        return items.some(({ key }) => key === this.#open);
    }

    #append(list, items, from) {
        const to = this.#isIn(items.slice(from + MOST_SHOWN)) ? items.length : from + MOST_SHOWN;
        list.append(...items.slice(from, to).map((item) => this.#row(item)));
        if (to < items.length) {
            const more = make(
                'button',
                {
                    type: 'button',
                    className: 'quiet',
                    onclick: () => {
                        more.parentElement.remove();
                        this.#append(list, items, to);
                        list.children[to].querySelector('button').focus();
                    },
                },
                'Show more',
            );
            list.append(make('li', {}, more));
        }
    }

    // Returns the button that offers to mend all findings of a group, and the trial that it shows.
    #allBox(name, all) {
        const isOpen = this.#all === name;
        const button = make(
            'button',
            {
                type: 'button',
                'aria-expanded': `${isOpen}`,
                onclick: () => {
                    this.#all = isOpen ? null : name;
                    this.#open = null;
                    this.#rerender(`[data-group="${name}"] .lens-all > button`);
                },
            },
            `${all.title}\u2026`,
        );
        return make(
            'div',
            { className: 'lens-all edits' },
            button,
            ...(isOpen ? this.#offer([all]) : []),
        );
    }

    #row(item) {
        const isOpen = this.#open === item.key;
        const place = wordsOfPlace(item.place);
        const button = make(
            'button',
            {
                type: 'button',
                className: 'finding',
                'aria-expanded': `${isOpen}`,
                onclick: () => {
                    this.#open = isOpen ? null : item.key;
                    this.#all = null;
                    this.#rerender(`[data-key="${item.key}"]`);
                    if (!isOpen) {
                        this.#show(item).then(() => this.#bringBack()).catch(this.#acts.onError);
                    }
                },
            },
            make('span', {}, item.text),
            ...(place === '' ? [] : [make('span', { className: 'small' }, place)]),
        );
        button.dataset.key = item.key;
        const row = make('li', {}, button);
        if (isOpen) {
            const none = make('p', { className: 'small' }, 'There is no way to mend this here.');
            const ways = item.mends.length > 0 ? this.#offer(item.mends) : [none];
            row.append(make('div', { className: 'mends edits' }, ...ways));
        }
        return row;
    }

    // Shows the list with another item open, and keeps the focus on the button that was pressed.
    #rerender(selector) {
        const { scrollTop } = this.#elements.section.parentElement;
        this.#render();
        this.#refocus = null;
        this.#elements.groups.querySelector(selector)?.focus({ preventScroll: true });
        this.#elements.section.parentElement.scrollTop = scrollTop;
    }

    // Scrolls the open item into sight: what the panel shows above about the elements that are now
    // selected may have moved it.
    #bringBack() {
        const open = this.#elements.groups.querySelector('.finding[aria-expanded="true"]');
        open?.parentElement.scrollIntoView({ block: 'nearest' });
    }

    // Selects what an item is about, and moves the camera there.
    async #show({ kind, ids, component, vertices, normal }) {
        const { mesh, shown } = this.#session;
        const elements = ids ?? (await api.getComponent(mesh, component));
        const { geometry } = shown;
        const seen = ids === null ? cornersOf(geometry, elements) : vertices;
        const ball = ballAround(geometry, seen);
        if (shown === this.#session.shown) {
            // More half-edges than the page reads cannot be selected: then their edges are.
            const isMany = kind === 'halfedge' && elements.length > MOST_READ;
            await this.#acts.show({
                kind: isMany ? 'edge' : kind,
                ids: isMany ? elements.map((halfedge) => halfedge >>> 1) : elements,
                ball: ball === null ? null : { ...ball, normal },
            });
        }
    }

    // --- mending ---

    // Makes the buttons for some mends and begins to try them; returns their nodes.
    #offer(mends) {
        const { mesh } = this.#session;
        const own = mends.map(
            (mend) =>
                new Mend(mend, this.#isReady, {
                    facesOf: (face, signal) => api.getComponent(mesh, face, signal),
                    attempt: (operations, signal) => this.#attempt(operations, signal),
                    run: (operations, done) => this.#run(operations, done),
                }),
        );
        this.#mends.push(...own);
        own.forEach((mend) => mend.attempt());
        return own.map(({ node }) => node);
    }

    async #attempt(operations, signal) {
        const { mesh, shown } = this.#session;
        const isDear = shown.summary.counts.faces > MOST_TRIED;
        const words = isDear ? null : wordsOf(await api.tryEdit(mesh, operations, signal));
        return words ?? 'This may take long on a mesh of this size, so it was not tried.';
    }

    async #run(operations, done) {
        this.#refocus = { ...this.#focused(), done };
        this.#work.start('Mending', false);
        try {
            const work = this.#session.shown.isLarge ? this.#work : null;
            await this.#session.run(operations, work);
        } catch (error) {
            this.#refocus = null;
            this.#acts.onError(error);
        } finally {
            this.#work.end();
        }
    }
}
