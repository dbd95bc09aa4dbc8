// tools.js - a form for each operation of the server's table, filled with the selected elements. No
// operation is known here: a new row of the table appears automatically.

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

// Links from a selected element to elements of other kinds.
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
    #armed = null; // {param, control, button} of the field that waits for a click
    #selection = [];
    #isEnabled = true;
    #isChosen = false; // the user chose an operation, which is kept when the selection changes
    #fields = new Map(); // name of the parameter -> {param, control, row, isTaken}

    // `onRun(operation)` is called with the operation of the form, and shows errors.
    // `onTouch(operation, error)` is called after a change of the form: null if it is incomplete,
    // or the error in it. `onArm({name, kind, isList})` is called when a field waits for elements,
    // and with undefined when none does any more. `meshes()` lists meshes.
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

    // Fills in the selection: {kind, id, element}, in the order of selection. While it stays the
    // same, text that the user typed in its place stays, too.
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

    // --- clicks ---

    // Whether a field waits for a click.
    get isArmed() {
        return this.#armed !== null;
    }

    disarm() {
        if (this.isArmed) {
            this.#arm(null);
        }
    }

    // Puts a clicked element into the field that waits; `place` is the position of a vertex.
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
            // On a narrow page the view is above the form, so the click scrolled away from it.
            this.#armed.button.scrollIntoView({ block: 'nearest' });
        }
        this.#armed = armed;
        armed?.button.setAttribute('aria-pressed', 'true');
        const { param } = armed ?? {};
        this.#onArm(param && { name: param.name, kind: kindOf(param), isList: isList(param) });
    }

    // Only the last one typed of several alternative parameters is kept.
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

    // Reports the operation of the form, once an operation was chosen.
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

    // Marks the field that a problem's pointer refers to, or none ('').
    mark(pointer) {
        for (const field of this.#fields.values()) {
            const isWrong = isAbout(field, pointer);
            field.row.classList.toggle('wrong', isWrong);
            field.control.main.setAttribute('aria-invalid', isWrong);
        }
    }

    // Returns whether the first parameter takes elements of the selected kind.
    #fits({ params } = { params: [] }) {
        return params.length > 0 && params[0].type === this.#selection.at(-1)?.kind;
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#form.querySelectorAll('button[type="submit"]')) {
            enable(button, enabled);
        }
    }

    // Makes an operation on the selection: on all of it if the operation takes several elements,
    // else on the last one.
    operationOn(name, selection) {
        const { kind, id } = selection.at(-1);
        const row = this.#chooser.find(name);
        const { plural } = row?.params.find(({ type }) => type === kind) ?? {};
        const ids = selection.map((chosen) => chosen.id);
        return plural && ids.length > 1 ? { op: name, [plural]: ids } : { op: name, [kind]: id };
    }

    // Returns whether the operation works on the whole mesh, so that it may take long.
    isWhole(name) {
        return this.#chooser.find(name)?.size === 'whole';
    }

    // Returns whether the server has an operation with this name.
    has(name) {
        return this.#chooser.find(name) !== undefined;
    }

    // Shows the form of an existing operation.
    show(name) {
        this.#chooser.set(name);
        this.#isChosen = true;
        this.#build();
    }

    // Shows the form and puts the focus into its first empty field, or on the button if there is
    // none.
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

    // Returns the rows of a parameter in the form; `isOther`: it is an alternative to the one
    // before it.
    #rows(param, isOther) {
        const { name, doc } = param;
        const id = `param-${name}`;
        const pickable = (part, control) => this.#pickable(part, control);
        const control = controlFor(param, this.#meshes, pickable);
        const field = { param, control, row: null, isTaken: false };
        this.#fields.set(name, field);
        // Several inputs form a group, of which the first has the id.
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

    // Returns a control with a button that lets the next click fill it.
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

    // Fills in selected elements of the parameter's kind, in the order of selection; several
    // parameters of one kind share them. Of alternatives only the first that fits is filled, and
    // elements that were clicked for a field stay.
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

// Deleting operations are never preselected.
function isDeletion({ name }) {
    return name.endsWith('_delete');
}

// Returns whether a parameter is an alternative to one of those before it.
function isOtherOf(before, { group }) {
    return group !== undefined && before.some((other) => other.group === group);
}
