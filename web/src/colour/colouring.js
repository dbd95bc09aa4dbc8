// colouring.js - colours the mesh by a measure or an attribute that the user chooses, and says what the
// colours mean.
//
// The values are read again when the mesh has changed, with one request at a time. Until they have
// arrived, the elements keep their colours, and new elements are grey.

import { formatCount, make } from '../kit/dom.js';
import { onUnit } from '../kit/units.js';
import { MOST_READ } from '../open/selection.js';
import { BINS } from './bars.js';
import { Column } from './column.js';
import { Key } from './key.js';
import { mapOf } from './maps.js';
import { readValues } from './reading.js';
import { Scale, missingNote, nounOf } from './scale.js';
import { showingOf } from './showing.js';
import { KINDS, keyOf, numbersOf, partsOf, readSources, usualPart } from './sources.js';
import { scalingOf, texelsOfCategories, texelsOfNumbers, texelsOfVectors } from './texels.js';
import { relatedTo } from './related.js';
import { ValueText } from './value_text.js';

// At most so many values are listed for the selected elements.
const MOST_VALUES = 8;

// How often values are read again because the mesh has changed meanwhile, until an error is shown.
const TRIES = 5;

// The pointer rests if it has not moved for this many milliseconds.
const REST = 120;

// The kinds of elements in the words of Selection and choose().
const ELEMENTS = { vertices: 'vertex', faces: 'face', edges: 'edge', halfedges: 'halfedge' };

export class Colouring {
    #elements;
    #session;
    #stage;
    #acts;
    #scale;
    #key;
    #sources = [];
    #source = null; // what the user has chosen, or null
    #part = null; // what of a vector is shown, see partsOf()
    #read = null; // the result of readValues()
    #column = null; // null if vectors are shown
    #map = null; // chosen by the user, or null
    #range = null; // chosen by the user, or null
    #reading = null; // AbortController of the present reading
    #isWanted = false; // the values must be read again
    #isBehind = false; // the connection was lost while they were read again
    #timer = 0;

    // `select` is the choice of what the colours show, `part` that of a part of a vector, `scale` gets
    // the legend, `said` says what goes on, `values` lists the values of the selected elements,
    // `shade` is a checkbox, and `key` a small legend over the view, `canvas`. `label()` returns the
    // label of the next frame.
    constructor(elements, session, stage, { label, onError }) {
        [this.#elements, this.#session, this.#stage] = [elements, session, stage];
        this.#acts = { label, onError };
        const { select, part, scale, shade, key, canvas } = elements;
        this.#scale = new Scale(scale, {
            onMap: (map) => {
                this.#map = map;
                this.#show();
            },
            onRange: (range) => {
                this.#range = range;
                this.#showRange();
            },
            onBin: (bin) => this.#selectWhere(this.#column.isInBin(bin, BINS)),
            onValue: (value) => this.#selectWhere((number) => number === value),
            onRangeSelect: () => this.#selectRange(),
        });
        this.#key = new Key(key);
        onUnit(() => this.#show());
        const readSoon = () => this.#readSources().catch(onError);
        select.addEventListener('focus', readSoon);
        select.addEventListener('pointerenter', readSoon);
        select.addEventListener('change', () => this.#choose(select.value).catch(onError));
        part.addEventListener('change', () => {
            [this.#part, this.#map, this.#range] = [part.value, null, null];
            this.#show();
        });
        shade.addEventListener('change', () => {
            stage.color((values) => {
                values.isShaded = shade.checked;
            }, label());
        });
        canvas.addEventListener('pointermove', (event) => this.#point(event));
        canvas.addEventListener('pointerleave', () => this.#point(null));
        canvas.addEventListener('click', ({ clientX, clientY }) => this.#showValueAt(clientX, clientY));
    }

    // Says what the colours of the frame show, for tests; undefined if they show nothing.
    get label() {
        return this.#read === null ? undefined : `${this.#source.key} ${this.#read.revision}`;
    }

    // Called when the session has changed; `what` is as in the constructor of Session.
    follow(what) {
        if (what === 'mesh') {
            this.clear();
            this.#sources = [];
        } else if ((what === 'change' || what === 'content') && this.#source !== null) {
            this.#load().catch(this.#acts.onError);
        } else if (what === 'selection') {
            this.#showValues();
        } else if (what === 'state' && this.#isBehind && this.#session.connection === 'on') {
            this.#load().catch(this.#acts.onError);
        }
    }

    // Colours the mesh by an attribute or ('measure' as `of`) a measure of elements of a kind.
    async colorBy(of, kind, name) {
        await this.#readSources();
        await this.#choose(keyOf(of, kind, name));
        this.#elements.select.scrollIntoView({ block: 'nearest' });
    }

    // What the colours show as the text of a link, or null if they show nothing: the choice, its part, the
    // colour map and the range.
    get shared() {
        if (this.#source === null) {
            return null;
        }
        const parts = [this.#source.key, this.#part ?? '', this.#map ?? '', ...(this.#range ?? [])];
        return parts.map((part) => encodeURIComponent(part).replaceAll('~', '%7E')).join('~');
    }

    // Shows what the text of a link says; null is nothing. What the mesh does not have is passed over.
    async show(text) {
        if (text === this.shared) {
            return;
        }
        const [key, part, map, ...range] = partsOfLink(text ?? '');
        await this.#readSources();
        await this.#choose(key);
        if (this.#read !== null) {
            const parts = partsOf(this.#source).map(([value]) => value);
            this.#part = parts.includes(part) ? part : this.#part;
            this.#map = map || null;
            const [low, high] = range.map((value) => Number(value || NaN));
            this.#range = low <= high && Number.isFinite(high - low) ? [low, high] : null;
            this.#show();
        }
    }

    // Takes the colours away.
    clear() {
        this.#reset();
        const { part, values, shade } = this.#elements;
        part.hidden = true;
        shade.parentElement.hidden = true;
        values.replaceChildren();
        this.#scale.clear();
        this.#key.hide();
        this.#stage.color((shown) => shown.hide(), this.#acts.label());
    }

    // Forgets the choice. The view and the legend stay as they are.
    #reset() {
        this.#reading?.abort();
        this.#reading = null;
        [this.#source, this.#part, this.#read] = [null, null, null];
        [this.#map, this.#range, this.#isWanted] = [null, null, false];
        this.#isBehind = false;
        this.#elements.select.value = '';
        this.#elements.said.textContent = '';
    }

    // --- the choice ---

    async #readSources() {
        const { mesh } = this.#session;
        if (mesh === null) {
            return;
        }
        const sources = await readSources(mesh);
        if (mesh !== this.#session.mesh) {
            return;
        }
        const isSame = sources.map(({ key }) => key).join() === this.#sources.map(({ key }) => key).join();
        this.#sources = sources;
        if (!isSame) {
            this.#listSources();
        }
    }

    #listSources() {
        const { select } = this.#elements;
        const groups = ['attribute', 'measure'].flatMap((of) =>
            Object.keys(KINDS).map((kind) => {
                const options = this.#sources
                    .filter((source) => source.kind === kind && source.key.startsWith(`${of}/`))
                    .map(({ key, title }) => make('option', { value: key }, title));
                const plural = { vertices: 'Vertices', faces: 'Faces', edges: 'Edges', halfedges: 'Corners' };
                const label = of === 'measure' ? plural[kind] : `${plural[kind]}, attributes`;
                return make('optgroup', { label }, ...options);
            }),
        );
        select.replaceChildren(
            make('option', { value: '' }, 'Nothing'),
            ...groups.filter((group) => group.children.length > 0),
        );
        select.value = this.#source?.key ?? '';
    }

    async #choose(key) {
        const source = this.#sources.find((one) => one.key === key);
        if (source === undefined) {
            this.clear();
            const { said } = this.#elements;
            said.textContent = key === '' ? '' : 'The mesh does not have this attribute.';
        } else {
            // The former colours stay until the values have arrived.
            this.#reset();
            this.#source = source;
            this.#part = usualPart(source);
            this.#elements.select.value = key;
            await this.#load();
        }
    }

    // --- reading ---

    // Reads the values until those of the newest revision are shown. A call during that only asks for
    // one more reading.
    async #load() {
        this.#isWanted = true;
        this.#isBehind = false;
        if (this.#reading !== null) {
            return;
        }
        const reading = new AbortController();
        this.#reading = reading;
        const { said, section } = this.#elements;
        section.setAttribute('aria-busy', 'true');
        said.textContent = this.#read === null ? 'Reading the values' : said.textContent;
        try {
            for (let tries = 1; this.#isWanted && !reading.signal.aborted; tries++) {
                this.#isWanted = false;
                await this.#loadOnce(reading, tries);
            }
        } catch (error) {
            if (!reading.signal.aborted) {
                this.#failed(error);
            }
        } finally {
            if (this.#reading === reading) {
                this.#reading = null;
                section.setAttribute('aria-busy', 'false');
            }
        }
    }

    async #loadOnce(reading, tries) {
        try {
            const content = this.#session.shown;
            const read = await readValues(this.#source, content, reading.signal);
            if (!reading.signal.aborted) {
                this.#read = read;
                this.#isWanted ||= this.#session.shown.revision > read.revision;
                this.#show();
            }
        } catch (error) {
            // With 410 the server says that the history no longer has the revision.
            if (error.status !== 410 || tries >= TRIES) {
                throw error;
            }
            this.#isWanted = true;
        }
    }

    #failed(error) {
        // Status 0 means a lost connection, which the page shows in its bar. The colours stay; when the
        // connection is back, the values are read again.
        if (error.status === 0 && this.#read !== null) {
            this.#isBehind = true;
            return;
        }
        const { title } = this.#source;
        this.clear();
        // An attribute can be deleted, for example by an undo.
        if (error.status === 404) {
            this.#elements.said.textContent = `The mesh does not have \u201c${title}\u201d any more.`;
            this.#sources = [];
        } else {
            this.#acts.onError(error);
        }
    }

    // --- showing ---

    get #isVector() {
        return ['direction', 'colour', 'checker'].includes(this.#part);
    }

    // Puts the values into the view and shows the legend.
    #show() {
        if (this.#read === null) {
            return;
        }
        this.#showParts();
        const { shade, said } = this.#elements;
        shade.parentElement.hidden = false;
        said.textContent = '';
        try {
            if (this.#isVector) {
                this.#showVectors();
            } else {
                this.#showNumbers();
            }
        } catch (error) {
            this.clear();
            this.#acts.onError(error);
            return;
        }
        this.#showValues();
    }

    #showParts() {
        const { part } = this.#elements;
        const options = partsOf(this.#source);
        part.hidden = options.length === 0;
        if (part.dataset.of !== this.#source.key) {
            part.dataset.of = this.#source.key;
            part.replaceChildren(
                ...options.map(([value, text]) => make('option', { value }, text)),
            );
        }
        part.value = this.#part;
    }

    // The half-edge at each corner of the triangles that are shown now.
    get #corners() {
        const { corners } = this.#read;
        const { kind } = this.#source;
        return kind === 'edges' || kind === 'halfedges'
            ? corners.ofTriangles(this.#session.shown.geometry)
            : null;
    }

    #showVectors() {
        const { ids, numbers } = this.#read;
        const { kind, components, title, isWhole } = this.#source;
        this.#column = null;
        // Colours that are whole numbers go from 0 to 255.
        const scale = this.#part === 'colour' && isWhole ? 1 / 255 : 1;
        const texels = texelsOfVectors(kind, { ids, numbers, components }, this.#corners, scale);
        this.#stage.color(
            (values) => values.show({ of: kind, as: this.#part, texels }),
            this.#acts.label(),
        );
        this.#scale.clear();
        const texts = this.#texts;
        const lost = ids.filter((id) => !texts.isKnown(id)).length;
        if (lost > 0) {
            this.#elements.scale.append(missingNote(this.#noun(lost)));
        }
        this.#key.show(title, null);
    }

    #showNumbers() {
        const { ids, numbers } = this.#read;
        const { kind, components } = this.#source;
        this.#column = new Column(numbersOf(numbers, components, this.#part), ids);
        const { map, categories } = this.#showing;
        const isCategorical = map === 'categorical';
        const texels = isCategorical
            ? texelsOfCategories(kind, this.#column, this.#corners, categories)
            : texelsOfNumbers(kind, this.#column, this.#corners);
        this.#stage.color((values) => {
            values.show({ of: kind, as: isCategorical ? 'category' : 'number', texels });
            values.setColours(mapOf(map));
        }, this.#acts.label());
        this.#showRange();
    }

    // Shows the legend, and the range in the view, after a change of the range only.
    #showRange() {
        if (this.#read === null) {
            return;
        }
        const legend = this.#showing;
        const { origin, factor } = scalingOf(this.#column);
        this.#stage.color((values) => {
            values.setRange(...legend.range.map((value) => (value - origin) * factor));
        }, this.#acts.label());
        const shown = {
            ...legend,
            column: this.#column,
            bytes: mapOf(legend.map),
            textOf: (number) => this.#texts.ofNumber(number),
            noun: (count) => this.#noun(count),
        };
        this.#scale.show(shown);
        this.#key.show(this.#title, shown);
    }

    // How the numbers are shown, see showing.js.
    get #showing() {
        return showingOf(this.#column, this.#source.isIndex, this.#map, this.#range);
    }

    // Writes the values as text.
    get #texts() {
        return new ValueText(this.#source, this.#read, this.#column);
    }

    get #title() {
        const { title, unit } = this.#source;
        const [, part] = partsOf(this.#source).find(([value]) => value === this.#part) ?? [];
        const name = part === undefined ? title : `${title}, ${part}`;
        return unit === '' ? name : `${name} (${unit})`;
    }

    #noun(count) {
        return nounOf(KINDS[this.#source.kind])(count);
    }

    // --- values of elements ---

    // Lists the values of the selected elements, or of the elements beside them that have values.
    #showValues() {
        const { values } = this.#elements;
        if (this.#read === null) {
            return;
        }
        const { kind } = this.#source;
        const ids = relatedTo(this.#session.selection.chosen, kind);
        const rows = ids.slice(0, MOST_VALUES).map((id) => {
            const dd = make('dd', {}, this.#texts.of(id));
            dd.dataset.value = id;
            return make('div', {}, make('dt', {}, `${TITLES[kind]} ${id}`), dd);
        });
        if (ids.length > MOST_VALUES) {
            rows.push(make('div', {}, make('dt', {}, `and ${ids.length - MOST_VALUES} more`)));
        }
        values.replaceChildren(...rows);
    }

    #point(event) {
        clearTimeout(this.#timer);
        if (this.#read === null || event === null || event.buttons !== 0) {
            this.#key.setValue('');
            return;
        }
        const { clientX, clientY } = event;
        this.#timer = setTimeout(() => this.#showValueAt(clientX, clientY), REST);
    }

    // Shows the value of the element at a place in the window.
    #showValueAt(x, y) {
        if (this.#read === null || this.#session.shown === null) {
            return;
        }
        const { kind } = this.#source;
        const found = this.#stage.elementAt(x, y, ELEMENTS[kind], true);
        const id = found === null ? null : this.#idOf(found);
        this.#key.setValue(id === null ? '' : `${TITLES[kind]} ${id}: ${this.#texts.of(id)}`);
    }

    #idOf({ kind, id, from, to }) {
        if (id !== undefined) {
            return id;
        }
        const halfedge = this.#read.corners.between(from, to);
        return halfedge === null ? null : kind === 'edge' ? halfedge >>> 1 : halfedge;
    }

    // --- selecting by values ---

    #selectRange() {
        if (this.#read === null) {
            return;
        }
        const [from, to] = this.#showing.range;
        this.#selectWhere((number) => number >= from && number <= to);
    }

    // Selects the elements whose numbers pass a test. Corners are half-edges, of which the page selects
    // only as many as it reads.
    #selectWhere(test) {
        if (this.#read === null) {
            return;
        }
        const ids = this.#column.find(test);
        const kind = ELEMENTS[this.#source.kind];
        const count = ids.length;
        const isTooMany = kind === 'halfedge' && count > MOST_READ;
        this.#elements.said.textContent =
            count === 0
                ? 'Nothing has such a value.'
                : isTooMany
                  ? `${this.#noun(count)}: too many to select, at most ${formatCount(MOST_READ)}.`
                  : `${this.#noun(count)} selected.`;
        if (count === 0 || isTooMany) {
            return;
        }
        this.#session.selection.selectAll(kind, ids).catch(this.#acts.onError);
    }
}

// Returns the parts of the text of a link, see Colouring.shared; [''] if it cannot be read.
function partsOfLink(text) {
    try {
        return text.split('~').map(decodeURIComponent);
    } catch {
        return [''];
    }
}

const TITLES = { vertices: 'Vertex', faces: 'Face', edges: 'Edge', halfedges: 'Half-edge' };
