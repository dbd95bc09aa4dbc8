// tools.js - a form for each operation of the server's table, its elements taken from the
// selection. Nothing here knows any operation: a new row of the table appears by itself.

import { Problem } from './api.js';
import { make } from './dom.js';

const PLURALS = { vertices: 'vertex', halfedges: 'halfedge', edges: 'edge', faces: 'face' };
const KINDS = Object.values(PLURALS);

const HINTS = {
    point: 'x y z',
    points: 'x y z, one or more',
    matrix: '16 numbers',
    mesh: 'id of a mesh',
};

// What an element that is selected says of elements of other kinds.
const LINKS = {
    vertex: (element) => (element.origin === undefined ? [] : [element.origin]),
    edge: (element) => (element.edge === undefined ? [] : [element.edge]),
    face: (element) => (typeof element.face === 'number' ? [element.face] : []),
    halfedge: (element) => element.halfedges?.slice(0, 1) ?? [],
};

export class Tools {
    #select;
    #form;
    #onRun;
    #operations = [];
    #selection = [];
    #isEnabled = true;
    #isChosen = false; // an operation was chosen, and is kept whatever is selected
    #fields = new Map(); // parameter's name -> {param, read(), input}

    // `onRun(operation)` is called with what the form says, and shows what goes wrong.
    constructor({ select, form }, { onRun, onError }) {
        this.#select = select;
        this.#form = form;
        this.#onRun = onRun;
        select.addEventListener('change', () => {
            this.#isChosen = true;
            this.#build();
        });
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            try {
                this.#onRun(this.#read());
            } catch (error) {
                onError(error);
            }
        });
    }

    setOperations(operations) {
        this.#operations = operations;
        this.#select.replaceChildren(
            ...operations.map(({ name }) => make('option', { value: name }, name)),
        );
        this.#build();
    }

    // Fill in what is selected: {kind, id, element}, the last chosen last. While that stays the
    // same, what was typed in its place stays too.
    setSelection(selection) {
        const isSame = keyOf(selection) === keyOf(this.#selection);
        this.#selection = selection;
        if (isSame) {
            return;
        }
        const fitting = this.#operations.find((operation) => this.#fits(operation));
        if (!this.#isChosen && fitting !== undefined && !this.#fits(this.#operation)) {
            this.#select.value = fitting.name;
            this.#build();
        } else {
            this.#fill();
        }
    }

    // Does it begin with an element of the kind that is selected?
    #fits({ params }) {
        return params.length > 0 && params[0].type === this.#selection.at(-1)?.kind;
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#form.querySelectorAll('button')) {
            button.disabled = !enabled;
        }
    }

    // An operation on what is selected: on all of it where the server's table says it takes
    // several, else on the last.
    operationOn(name, selection) {
        const { kind, id } = selection.at(-1);
        const row = this.#operations.find((operation) => operation.name === name);
        const { plural } = row?.params.find(({ type }) => type === kind) ?? {};
        const ids = selection.map((chosen) => chosen.id);
        return plural && ids.length > 1 ? { op: name, [plural]: ids } : { op: name, [kind]: id };
    }

    // May it cost the whole mesh, and take long?
    isWhole(name) {
        return this.#operations.find((operation) => operation.name === name)?.size === 'whole';
    }

    // Show the form of an operation with the focus in its first field that is empty. False when the
    // server has none of this name.
    open(name) {
        if (!this.#operations.some((operation) => operation.name === name)) {
            return false;
        }
        this.#isChosen = true;
        this.#select.value = name;
        this.#build();
        const inputs = [...this.#form.querySelectorAll('input, select')];
        (inputs.find((input) => input.value === '') ?? inputs[0])?.focus();
        return true;
    }

    get #operation() {
        return this.#operations.find(({ name }) => name === this.#select.value);
    }

    #build() {
        const operation = this.#operation;
        this.#fields.clear();
        const params = operation?.params ?? [];
        const rows = params.map((param) => this.#row(param, othersOf(params, param)));
        this.#form.replaceChildren(
            make('p', { className: 'small' }, operation?.doc ?? ''),
            ...rows,
            make(
                'button',
                { type: 'submit', className: 'wide', disabled: !this.#isEnabled },
                'Apply',
            ),
        );
        this.#form.hidden = operation === undefined;
        this.#fill();
    }

    // `others` are the parameters that may be given in its place.
    #row(param, others) {
        const input = inputFor(param);
        input.id = `param-${param.name}`;
        input.title = param.doc;
        this.#fields.set(param.name, { param, input });
        const isOptional = !param.required && param.type !== 'flag';
        const marks = [...others.map(({ name }) => `or ${name}`), isOptional && 'optional'];
        return make(
            'div',
            { className: 'field' },
            make('label', { htmlFor: input.id }, param.name),
            input,
            make('span', { className: 'small' }, marks.filter(Boolean).join(', ')),
        );
    }

    // Elements of a parameter's kind, in the order they were selected; parameters of one kind share
    // them out. Of a group only the first that fits is filled.
    #fill() {
        const left = new Map(KINDS.map((kind) => [kind, this.#ids(kind)]));
        const groups = new Set();
        for (const { param, input } of this.#fields.values()) {
            const kind = PLURALS[param.type] ?? param.type;
            if (!KINDS.includes(kind)) {
                continue;
            }
            const ids = groups.has(param.group) ? [] : left.get(kind);
            const many = param.plural !== undefined || param.type in PLURALS;
            const taken = ids.splice(0, many ? ids.length : 1);
            input.value = taken.join(' ');
            if (param.group !== undefined && taken.length > 0) {
                groups.add(param.group);
            }
        }
    }

    #ids(kind) {
        const direct = this.#selection.filter((chosen) => chosen.kind === kind);
        return direct.length > 0
            ? direct.map(({ id }) => id)
            : [...new Set(this.#selection.flatMap(({ element }) => LINKS[kind](element)))];
    }

    #read() {
        const operation = { op: this.#operation.name };
        for (const { param, input } of this.#fields.values()) {
            const [name, value] = readField(param, input);
            if (value !== undefined) {
                operation[name] = value;
            }
        }
        return operation;
    }
}

function keyOf(selection) {
    return selection.map(({ kind, id }) => `${kind}:${id}`).join();
}

function othersOf(params, { name, group }) {
    return group === undefined
        ? []
        : params.filter((other) => other.group === group && other.name !== name);
}

function inputFor(param) {
    if (param.type === 'flag') {
        return make('input', { type: 'checkbox', checked: param.default === true });
    }
    if (param.type === 'choice') {
        const options = param.choices.map((choice) => make('option', { value: choice }, choice));
        const select = make('select', {}, ...options);
        select.value = param.default ?? param.choices[0];
        return select;
    }
    const input = make('input', { type: 'text', autocomplete: 'off', spellcheck: false });
    input.placeholder = hintFor(param);
    return input;
}

// What stands in an empty field. A number that is left out is the server's to choose.
function hintFor({ type, default: usual, required, nullable }) {
    if (type === 'number') {
        return usual === undefined ? (required ? 'number' : 'left out') : `${usual}`;
    }
    return HINTS[type] ?? (nullable ? 'id or none' : 'id');
}

// [member, value] of a field; undefined where it is left out. The server judges what is missing or
// out of range: it knows better and says why.
function readField(param, input) {
    const { name, type } = param;
    if (type === 'flag') {
        return [name, input.checked];
    }
    const text = input.value.trim();
    if (type === 'choice') {
        return [name, text];
    }
    if (text === '') {
        return [name, param.nullable ? null : undefined];
    }
    if (type === 'mesh') {
        return [name, text];
    }
    if (param.nullable && text === 'none') {
        return [name, null];
    }
    const numbers = text
        .split(/[\s,;]+/)
        .filter((word) => word !== '')
        .map((word) => toNumber(word, name));
    if (type === 'points') {
        const points = [];
        for (let i = 0; i < numbers.length; i += 3) {
            points.push(numbers.slice(i, i + 3));
        }
        return [name, points.length === 1 ? points[0] : points];
    }
    if (type === 'point' || type === 'matrix' || type in PLURALS) {
        return [name, numbers];
    }
    if (numbers.length === 1) {
        return [name, numbers[0]];
    }
    if (param.plural === undefined) {
        throw new Problem({
            title: 'One number',
            detail: `${name} is one number, not \u201c${text}\u201d.`,
        });
    }
    return [param.plural, numbers];
}

// Digits as people write them: what else JavaScript reads, such as 0x10, is a slip.
function toNumber(word, name) {
    const value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(word) ? Number(word) : NaN;
    if (!Number.isFinite(value)) {
        throw new Problem({
            title: 'Not a number',
            detail: `${name}: \u201c${word}\u201d is not a number.`,
        });
    }
    return value;
}
