// tools.js - a form for each operation of the server's table, its elements taken from the
// selection. Nothing here knows any operation: a new row of the table appears by itself.

import { make } from './dom.js';
import {
    KINDS,
    inputFor,
    isComplete,
    isList,
    isPlace,
    kindOf,
    readField,
    toggleWord,
} from './fields.js';

// What operations begin with, as groups of the list; what begins otherwise is of the whole mesh.
const GROUPS = { vertex: 'Vertex', edge: 'Edge', face: 'Face', loop: 'Loop', hole: 'Loop' };
const GROUP_NAMES = [...new Set(Object.values(GROUPS)), 'Mesh'];

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
    #onTouch;
    #onArm;
    #meshes;
    #search;
    #armed = null; // the field that takes what is clicked
    #operations = [];
    #selection = [];
    #isEnabled = true;
    #isChosen = false; // an operation was chosen, and is kept whatever is selected
    #fields = new Map(); // parameter's name -> {param, input, button, isTaken}

    // `onRun(operation)` is called with what the form says, and shows what goes wrong.
    // `onTouch(operation, error)` after the form was changed: null where it is not complete, or the
    // error in it. `onArm(kind)` when a field waits for elements of a kind, `meshes()` lists meshes.
    constructor({ select, form, search }, { onRun, onTouch, onArm, meshes, onError }) {
        this.#select = select;
        this.#form = form;
        this.#search = search;
        this.#onRun = onRun;
        this.#onTouch = onTouch;
        this.#onArm = onArm;
        this.#meshes = () => meshes().catch((error) => (onError(error), []));
        search.addEventListener('input', () => this.#list());
        search.addEventListener('keydown', (event) => {
            if (event.key === 'Enter' && this.#operation !== undefined) {
                this.open(this.#operation.name);
            }
        });
        select.addEventListener('change', () => {
            this.#isChosen = true;
            this.#build();
        });
        form.addEventListener('input', (event) => this.#typed(event.target));
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
        this.#list();
    }

    // The operations that what is searched for is in, by what they work on.
    #list() {
        const words = this.#search.value.toLowerCase().split(/\s+/);
        const chosen = this.#select.value;
        const found = this.#operations.filter(({ name, doc }) =>
            words.every((word) => `${name} ${doc}`.toLowerCase().includes(word)),
        );
        const groups = GROUP_NAMES.map((label) => {
            const names = found.map(({ name }) => name).filter((name) => groupOf(name) === label);
            return make(
                'optgroup',
                { label },
                ...names.map((name) => make('option', { value: name }, name)),
            );
        });
        this.#select.replaceChildren(...groups.filter((group) => group.children.length > 0));
        if (found.some(({ name }) => name === chosen)) {
            this.#select.value = chosen;
        }
        if (this.#select.value !== chosen || this.#fields.size === 0) {
            this.#build();
        }
    }

    #listAll() {
        if (this.#search.value !== '') {
            this.#search.value = '';
            this.#list();
        }
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
            this.#listAll();
            this.#select.value = fitting.name;
            this.#build();
        } else {
            this.#fill();
            this.#touch();
        }
    }

    // --- what is clicked ---

    // Does a field wait for what is clicked?
    get isArmed() {
        return this.#armed !== null;
    }

    disarm() {
        this.#arm(null);
    }

    // An element that was clicked for the field that waits; `place` is where a vertex is.
    take(id, place) {
        const { param, input } = this.#armed;
        this.#armed.isTaken = true;
        if (isPlace(param)) {
            input.value = place.join(' ');
        } else {
            input.value = isList(param) ? toggleWord(input.value, id) : `${id}`;
        }
        this.#typed(input);
        if (!isList(param)) {
            this.#arm(null);
        }
    }

    #arm(field) {
        this.#armed?.button.setAttribute('aria-pressed', 'false');
        this.#armed = field;
        if (field !== null) {
            field.button.setAttribute('aria-pressed', 'true');
            this.#onArm(kindOf(field.param));
        }
    }

    // Of parameters that stand for each other only the last that was said is kept.
    #typed(input) {
        const fields = [...this.#fields.values()];
        const { param } = fields.find((field) => field.input === input);
        const others = fields.filter((field) => field.input !== input);
        if (param.group !== undefined && input.value.trim() !== '') {
            for (const other of others.filter((one) => one.param.group === param.group)) {
                other.input.value = '';
            }
        }
        this.#touch();
    }

    // Say what the form says, once an operation was chosen.
    #touch() {
        if (!this.#isChosen || this.#operation === undefined) {
            return;
        }
        try {
            const isReady = isComplete([...this.#fields.values()]);
            this.#onTouch(isReady ? this.#read() : null, null);
        } catch (error) {
            this.#onTouch(null, error);
        }
    }

    // Does it begin with an element of the kind that is selected?
    #fits({ params }) {
        return params.length > 0 && params[0].type === this.#selection.at(-1)?.kind;
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#form.querySelectorAll('button[type="submit"]')) {
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

    // Has the server an operation of this name?
    has(name) {
        return this.#operations.some((operation) => operation.name === name);
    }

    // Show the form of an operation that there is.
    show(name) {
        this.#listAll();
        this.#isChosen = true;
        this.#select.value = name;
        this.#build();
    }

    // The same with the focus in its first field that is empty.
    open(name) {
        this.show(name);
        const inputs = [...this.#form.querySelectorAll('input, select')];
        (inputs.find((input) => input.value === '') ?? inputs[0])?.focus();
    }

    get #operation() {
        return this.#operations.find(({ name }) => name === this.#select.value);
    }

    #build() {
        const operation = this.#operation;
        this.#arm(null);
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
        this.#touch();
    }

    // `others` are the parameters that may be given in its place.
    #row(param, others) {
        const input = inputFor(param, this.#meshes);
        input.id = `param-${param.name}`;
        input.title = param.doc;
        const field = { param, input, button: null, isTaken: false };
        this.#fields.set(param.name, field);
        const isOptional = !param.required && param.type !== 'flag';
        const marks = [...others.map(({ name }) => `or ${name}`), isOptional && 'optional'];
        return make(
            'div',
            { className: 'field' },
            make('label', { htmlFor: input.id }, param.name),
            kindOf(param) === null ? input : this.#withButton(field),
            make('span', { className: 'small' }, marks.filter(Boolean).join(', ')),
        );
    }

    #withButton(field) {
        field.button = make(
            'button',
            {
                type: 'button',
                'aria-label': `Pick ${field.param.name} in the view`,
                'aria-pressed': 'false',
                onclick: () => this.#arm(this.#armed === field ? null : field),
            },
            'Pick',
        );
        return make('div', { className: 'picked' }, field.input, field.button);
    }

    // Elements of a parameter's kind, in the order they were selected; parameters of one kind share
    // them out. Of a group only the first that fits is filled, and what was clicked for a field
    // stays.
    #fill() {
        const left = new Map(KINDS.map((kind) => [kind, this.#ids(kind)]));
        const fields = [...this.#fields.values()];
        const groups = new Set(fields.filter((one) => one.isTaken).map(({ param }) => param.group));
        groups.delete(undefined);
        for (const { param, input, isTaken } of fields) {
            const kind = kindOf(param);
            if (kind === null || isPlace(param) || isTaken) {
                continue;
            }
            const ids = groups.has(param.group) ? [] : left.get(kind);
            const taken = ids.splice(0, isList(param) ? ids.length : 1);
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
        for (const field of this.#fields.values()) {
            const [name, value] = readField(field);
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

function groupOf(name) {
    return GROUPS[name.split('_')[0]] ?? 'Mesh';
}

function othersOf(params, { name, group }) {
    return group === undefined
        ? []
        : params.filter((other) => other.group === group && other.name !== name);
}
