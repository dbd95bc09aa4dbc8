// tools.js - a form for each operation of the server's table, its elements taken from the
// selection. Nothing here knows any operation: a new row of the table appears by itself.

import { Chooser } from './chooser.js';
import { Flag } from './controls.js';
import { enable, make, prose } from './dom.js';
import {
    KINDS,
    controlFor,
    isAbout,
    isComplete,
    isList,
    isPlace,
    kindOf,
    marksOf,
    readField,
} from './fields.js';

// What an element that is selected says of elements of other kinds.
const LINKS = {
    vertex: (element) => (element.origin === undefined ? [] : [element.origin]),
    edge: (element) => (element.edge === undefined ? [] : [element.edge]),
    face: (element) => (typeof element.face === 'number' ? [element.face] : []),
    halfedge: (element) => element.halfedges?.slice(0, 1) ?? [],
};

export class Tools {
    #chooser;
    #form;
    #onRun;
    #onTouch;
    #onArm;
    #meshes;
    #armed = null; // {param, control, button} that takes what is clicked
    #selection = [];
    #isEnabled = true;
    #isChosen = false; // an operation was chosen, and is kept whatever is selected
    #fields = new Map(); // parameter's name -> {param, control, row, isTaken}

    // `onRun(operation)` is called with what the form says, and shows what goes wrong.
    // `onTouch(operation, error)` after the form was changed: null where it is not complete, or the
    // error in it. `onArm({name, kind, isList})` when a field waits for elements, and with
    // undefined when none does any more; `meshes()` lists meshes.
    constructor({ select, form, search }, { onRun, onTouch, onArm, meshes, onError }) {
        this.#form = form;
        this.#onRun = onRun;
        this.#onTouch = onTouch;
        this.#onArm = onArm;
        this.#meshes = () => meshes().catch((error) => (onError(error), []));
        this.#chooser = new Chooser(
            { select, search },
            {
                onChange: (isChosen) => {
                    this.#isChosen ||= isChosen;
                    this.#build();
                },
                onEnter: (name) => this.open(name),
            },
        );
        form.addEventListener('input', (event) => this.#typed(event.target));
        form.addEventListener('keydown', (event) => {
            if (event.key === 'Escape') {
                this.disarm();
            }
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
        this.#chooser.setOperations(operations);
    }

    // Fill in what is selected: {kind, id, element}, the last chosen last. While that stays the
    // same, what was typed in its place stays too.
    setSelection(selection) {
        const isSame = keyOf(selection) === keyOf(this.#selection);
        this.#selection = selection;
        if (isSame) {
            return;
        }
        const fitting = this.#chooser.all.find((one) => this.#fits(one) && !isDeletion(one));
        if (!this.#isChosen && fitting !== undefined && !this.#fits(this.#chooser.operation)) {
            this.#chooser.set(fitting.name);
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
        if (this.isArmed) {
            this.#arm(null);
        }
    }

    // An element that was clicked for the field that waits; `place` is where a vertex is.
    take(id, place) {
        const { param, control } = this.#armed;
        control.take(id, place);
        const field = this.#fields.get(param.name);
        if (field !== undefined) {
            field.isTaken = true;
        }
        control.main.dispatchEvent(new Event('input', { bubbles: true }));
        if (!isList(param)) {
            this.#arm(null);
        }
    }

    #arm(armed) {
        if (this.#armed !== null) {
            this.#armed.button.setAttribute('aria-pressed', 'false');
            // Where the view is above the form, one had to leave it.
            this.#armed.button.scrollIntoView({ block: 'nearest' });
        }
        this.#armed = armed;
        armed?.button.setAttribute('aria-pressed', 'true');
        const { param } = armed ?? {};
        this.#onArm(param && { name: param.name, kind: kindOf(param), isList: isList(param) });
    }

    // Of parameters that stand for each other only the last that was said is kept.
    #typed(target) {
        const field = this.#fields.get(target.closest('.field').dataset.name);
        const { group } = field.param;
        if (group !== undefined && field.control.isSaid) {
            for (const other of this.#fields.values()) {
                if (other !== field && other.param.group === group) {
                    other.control.clear();
                }
            }
        }
        this.#touch();
    }

    // Say what the form says, once an operation was chosen.
    #touch() {
        this.mark('');
        if (!this.#isChosen || this.#chooser.operation === undefined) {
            return;
        }
        try {
            const isReady = isComplete([...this.#fields.values()]);
            this.#onTouch(isReady ? this.#read() : null, null);
        } catch (error) {
            this.mark(error.pointer ?? '');
            this.#onTouch(null, error);
        }
    }

    // The elements in the fields, {kind, id} each; none until an operation was chosen.
    get elements() {
        const fields = this.#isChosen ? [...this.#fields.values()] : [];
        return fields
            .filter(({ param }) => kindOf(param) !== null && !isPlace(param))
            .flatMap(({ param, control }) =>
                control.ids.map((id) => ({ kind: kindOf(param), id })),
            );
    }

    // Mark the field that what is wrong is about, by a problem's pointer, or none ('').
    mark(pointer) {
        for (const field of this.#fields.values()) {
            const isWrong = isAbout(field, pointer);
            field.row.classList.toggle('wrong', isWrong);
            field.control.main.setAttribute('aria-invalid', isWrong);
        }
    }

    // Does it begin with an element of the kind that is selected?
    #fits({ params } = { params: [] }) {
        return params.length > 0 && params[0].type === this.#selection.at(-1)?.kind;
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#form.querySelectorAll('button[type="submit"]')) {
            enable(button, enabled);
        }
    }

    // An operation on what is selected: on all of it where the server's table says it takes
    // several, else on the last.
    operationOn(name, selection) {
        const { kind, id } = selection.at(-1);
        const row = this.#chooser.find(name);
        const { plural } = row?.params.find(({ type }) => type === kind) ?? {};
        const ids = selection.map((chosen) => chosen.id);
        return plural && ids.length > 1 ? { op: name, [plural]: ids } : { op: name, [kind]: id };
    }

    // May it cost the whole mesh, and take long?
    isWhole(name) {
        return this.#chooser.find(name)?.size === 'whole';
    }

    // Has the server an operation of this name?
    has(name) {
        return this.#chooser.find(name) !== undefined;
    }

    // Show the form of an operation that there is.
    show(name) {
        this.#chooser.set(name);
        this.#isChosen = true;
        this.#build();
    }

    // The same with the focus in its first field that is empty, or on the button where it has none.
    open(name) {
        this.show(name);
        const controls = [...this.#fields.values()].map(({ control }) => control);
        const { main } = controls.find(({ isSaid }) => !isSaid) ?? controls[0] ?? {};
        (main ?? this.#form.querySelector('button')).focus();
    }

    #build() {
        const { operation } = this.#chooser;
        this.disarm();
        this.#fields.clear();
        const params = operation?.params ?? [];
        const rows = params.flatMap((param, i) =>
            this.#rows(param, isOtherOf(params.slice(0, i), param)),
        );
        this.#form.replaceChildren(
            make('p', { className: 'small' }, ...prose(operation?.doc ?? '')),
            ...rows,
            make(
                'button',
                { type: 'submit', className: 'primary wide', disabled: !this.#isEnabled },
                'Apply',
            ),
        );
        this.#form.hidden = operation === undefined;
        this.#fill();
        this.#touch();
    }

    // `isOther` where it may be given in place of the one before it.
    #rows(param, isOther) {
        const { name, doc } = param;
        const id = `param-${name}`;
        const pickable = (part, control) => this.#pickable(part, control);
        const control = controlFor(param, this.#meshes, pickable);
        const field = { param, control, row: null, isTaken: false };
        this.#fields.set(name, field);
        // Several inputs are a group, of which the first has the id.
        const isGroup = control.main !== control.node;
        const help = make('p', { id: `${id}-doc`, className: 'small' }, ...prose(doc));
        control.main.id = id;
        control.main.setAttribute('aria-describedby', help.id);
        const label = isGroup
            ? make('span', { id: `${id}-name`, className: 'name' }, name)
            : make('label', { htmlFor: id, className: 'name' }, name);
        const head = make(
            'div',
            { className: 'head' },
            label,
            make('span', { className: 'small' }, marksOf(param)),
        );
        const box = kindOf(param) === null ? control.node : pickable(param, control);
        const className = control instanceof Flag ? 'field flag' : 'field';
        field.row = make('div', { className }, head, box, help);
        field.row.dataset.name = name;
        if (isGroup) {
            field.row.setAttribute('role', 'group');
            field.row.setAttribute('aria-labelledby', label.id);
        }
        return isOther ? [make('p', { className: 'or' }, 'or'), field.row] : [field.row];
    }

    // A control beside a button that lets the next click fill it.
    #pickable(param, control) {
        const armed = { param, control };
        armed.button = make(
            'button',
            {
                type: 'button',
                'aria-label': `Pick ${param.name} in the view`,
                'aria-pressed': 'false',
                onclick: () => this.#arm(this.#armed === armed ? null : armed),
            },
            'Pick',
        );
        return make('div', { className: 'picked' }, control.node, armed.button);
    }

    // Elements of a parameter's kind, in the order they were selected; parameters of one kind share
    // them out. Of a group only the first that fits is filled, and what was clicked for a field
    // stays.
    #fill() {
        const left = new Map(KINDS.map((kind) => [kind, this.#ids(kind)]));
        const fields = [...this.#fields.values()];
        const groups = new Set(fields.filter((one) => one.isTaken).map(({ param }) => param.group));
        groups.delete(undefined);
        for (const { param, control, isTaken } of fields) {
            const kind = kindOf(param);
            if (kind === null || isPlace(param) || isTaken) {
                continue;
            }
            const ids = groups.has(param.group) ? [] : left.get(kind);
            const taken = ids.splice(0, isList(param) ? ids.length : 1);
            control.set(taken);
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
        const operation = { op: this.#chooser.operation.name };
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

// Not to be offered unasked.
function isDeletion({ name }) {
    return name.endsWith('_delete');
}

// May it be given in place of one of those before it?
function isOtherOf(before, { group }) {
    return group !== undefined && before.some((other) => other.group === group);
}
