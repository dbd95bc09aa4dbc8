// exporting.js - the dialog that saves the open mesh as a file. What can be chosen is what the
// server's OpenAPI document names; the table below adds words, and says which choices a format has.

import * as api from '../wire/api.js';
import { Ask, field } from '../kit/ask.js';
import { Choice } from '../kit/controls.js';
import { formatCount, make } from '../kit/dom.js';
import { fileNameOf, formatBytes, save } from '../kit/download.js';
import { nameInText } from '../wire/names.js';
import { parametersOf } from '../wire/schema.js';

// By format: its name, what it is for, and the values of the other parameters that it has.
const FORMATS = {
    obj: { label: 'OBJ', doc: 'Text with whole polygons. Nearly every program reads it.' },
    mtl: { label: 'MTL', doc: 'The material library of the OBJ file: save it beside that file.' },
    off: { label: 'OFF', doc: 'Short text with vertices and polygons, usual in geometry courses.' },
    ply: {
        label: 'PLY',
        doc: 'Polygons with attributes, usual for scans.',
        encoding: ['binary', 'ascii', 'binary_big_endian'],
    },
    stl: {
        label: 'STL',
        doc: 'Triangles only, for 3D printing.',
        encoding: ['binary', 'ascii'],
    },
    glb: {
        label: 'GLB (glTF)',
        doc: 'Triangles with materials, for viewers and game engines.',
        compress: ['meshopt'],
    },
    json: { label: 'JSON', doc: 'hedge\u2019s own document, with all ids and attributes.' },
};

const WORDS = {
    encoding: 'Encoding',
    compress: 'Compression',
    binary: 'Binary (small)',
    ascii: 'Text',
    binary_big_endian: 'Binary, big-endian',
    meshopt: 'Meshopt (smaller, without loss)',
};

// The parameters that have a control of their own.
const OWN = ['format', 'revision'];

let lastFormat = 'obj'; // the format that was chosen last, or that of the file that was read last

// Returns the format in which a file with this name is written again, null if there is none. Pure.
export function formatOf(name) {
    const [, end = ''] = /\.([^.]+)$/.exec(name.toLowerCase()) ?? [];
    const format = end === 'gltf' ? 'glb' : end;
    return format in FORMATS && format !== 'mtl' ? format : null;
}

// Returns the label of a format in a sentence, such as "STL".
export const labelOf = (format) => FORMATS[format].label;

// Says that the dialog opens with this format when it is opened next.
export function preferFormat(format) {
    lastFormat = format;
}

// Returns the choices of a format for a parameter of which the server names `values`. The first is
// what the server does if the parameter is not given. Pure.
export function choicesOf(format, parameter, values) {
    const known = FORMATS[format];
    const own = known === undefined ? values : (known[parameter] ?? []);
    const some = own.filter((value) => values.includes(value));
    return parameter === 'compress' && some.length > 0 ? ['', ...some] : some;
}

// Returns the sentences in the header Export-Warnings. Pure.
export function sentencesOf(header) {
    return header
        .split('; ')
        .filter((text) => text !== '')
        .map((text) => `${text[0].toUpperCase()}${text.slice(1)}.`);
}

// Opens the dialog for the mesh that `content`, a Content, shows.
export async function askExport(content, toasts) {
    const choices = parametersOf(await api.getDescription(), 'export_mesh').filter(
        (parameter) => parameter.values !== undefined || parameter.name === 'revision',
    );
    const dialog = new Exporting(content, choices, toasts);
    dialog.showFormat();
}

// Saves a mesh, given by its summary, in a format without asking, and says what was saved and what
// the file lacks.
export async function exportNow({ id: mesh, name }, format, toasts) {
    const { file, size, sentences } = await saveAs({ mesh, name }, { format }, () => {});
    toasts.tell('Exported', [`${file}, ${formatBytes(size)}.`, ...sentences].join(' '));
}

// Gets a mesh as the server writes it with the parameters `choices`, and saves it as a file. Returns
// {file, size, sentences}: the file's name, its bytes, and what it lacks.
async function saveAs({ mesh, name }, choices, onBytes, signal) {
    const { format, revision } = choices;
    const { blob, suggested, warnings } = await api.getFile(mesh, choices, onBytes, signal);
    const title = revision === undefined ? '' : ` r${revision}`;
    // An OBJ file refers to its material library by the name that the server suggests.
    const file =
        format === 'mtl' && suggested !== null
            ? suggested
            : fileNameOf(`${name || mesh}${title}`, format);
    save(blob, file);
    return { file, size: blob.size, sentences: sentencesOf(warnings) };
}

class Exporting {
    #content;
    #parameters;
    #toasts;
    #ask;
    #format;
    #revision;
    #doc = make('span');
    #more = make('div', { className: 'ask-rows' });
    #controls = new Map(); // name of a further parameter -> its control
    #lost = make('div', { className: 'lost', role: 'status' });

    constructor(content, parameters, toasts) {
        [this.#content, this.#parameters, this.#toasts] = [content, parameters, toasts];
        const { values } = parameters.find(({ name }) => name === 'format');
        const format = values.includes(lastFormat) ? lastFormat : values[0];
        this.#format = new Choice(values.map((name) => [name, FORMATS[name]?.label ?? name]), format);
        this.#format.node.addEventListener('change', () => this.showFormat());
        const revisions = this.#revisions();
        this.#revision = new Choice(revisions, '');
        const what = field('revision', 'What to export', this.#revision);
        what.hidden = revisions.length === 1;
        const { name } = content.summary;
        this.#ask = new Ask(
            { title: `Export ${nameInText(name || content.mesh)}`, go: 'Download', onGo: () => this.#download() },
            field('format', 'Format', this.#format, this.#doc),
            this.#more,
            what,
            this.#lost,
        );
    }

    // The revisions that the history shows, newest first.
    #revisions() {
        const { revision, history } = this.#content;
        const earlier = history.entries.map((entry) => [
            `${entry.revision - 1}`,
            `As before ${entry.ops.join(', ') || entry.action} (revision ${entry.revision - 1})`,
        ]);
        const known = earlier.filter(([id]) => id !== '0' && Number(id) < revision);
        return [['', `The mesh as it is now (revision ${revision})`], ...known];
    }

    // Shows the fields that the chosen format has.
    showFormat() {
        const format = this.#format.read();
        this.#doc.textContent = FORMATS[format]?.doc ?? '';
        this.#lost.replaceChildren();
        this.#ask.setLabels('Download', 'Cancel');
        this.#controls.clear();
        const rows = this.#parameters
            .filter(({ name }) => !OWN.includes(name))
            .flatMap(({ name, values }) => {
                const some = choicesOf(format, name, values);
                if (some.length === 0) {
                    return [];
                }
                const control = new Choice(
                    some.map((value) => [value, value === '' ? 'None' : (WORDS[value] ?? value)]),
                    some[0],
                );
                this.#controls.set(name, control);
                return [field(name, WORDS[name] ?? name, control)];
            });
        this.#ask.setRows(this.#more, rows);
    }

    async #download() {
        const format = this.#format.read();
        lastFormat = format;
        const revision = this.#revision.read();
        const chosen = Object.fromEntries(
            [...this.#controls].map(([name, control]) => [name, control.read()]),
        );
        this.#lost.replaceChildren();
        this.#ask.start('Exporting');
        const stop = new AbortController();
        this.#ask.begin(() => stop.abort());
        const { mesh, summary } = this.#content;
        const { file, size, sentences } = await saveAs(
            { mesh, name: summary.name },
            { format, revision, ...chosen },
            (bytes) => this.#ask.show({ phase: `Exporting: ${formatBytes(bytes)}` }),
            stop.signal,
        );
        return this.#tell(file, size, sentences);
    }

    // Says what was saved. If the file lacks something, the dialog stays open and lists that.
    #tell(file, size, sentences) {
        const words = `${file}, ${formatBytes(size)}`;
        if (sentences.length === 0) {
            this.#toasts.tell('Exported', words);
            return true;
        }
        const count = sentences.length === 1 ? 'one note' : `${formatCount(sentences.length)} notes`;
        this.#lost.replaceChildren(
            make('p', {}, make('strong', {}, 'Exported '), `${words}, with ${count}:`),
            make('ul', {}, ...sentences.map((text) => make('li', {}, text))),
        );
        this.#ask.setLabels('Download again', 'Close');
        return false;
    }
}
