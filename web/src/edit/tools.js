// tools.js - shows a form for the operation that the user chooses, filled with the selected
// elements. The forms are made from the server's list of operations, so that a new operation
// appears without a change here.

import { slip } from '../kit/numbers.js';
import { Chooser } from './chooser.js';
import { SELECTION } from '../kit/controls.js';
import { enable, make, prose } from '../kit/dom.js';
import {
    KINDS,
    isAbout,
    isList,
    isOpen,
    isPlace,
    kindOf,
    marksOf,
    missingOf,
    readField,
    roomFor,
    wantOf,
} from './fields.js';
import { Offered } from './offered.js';
import { fieldsOf, pageOf } from './rows.js';

export class Tools {
    #chooser;
    #form;
    #verdict;
    #onRun;
    #onTouch;
    #onRefuse;
    #onArm;
    #onDraw;
    #meshes;
    #armed = null; // {param, control, button} of the field that waits for a click
    #offered = new Offered();
    #isEnabled = true;
    #isChosen = false; // the user chose an operation, so that it stays when the selection changes
    // name of the parameter -> its field, see rows.js
    #fields = new Map();

    // `onRun(operation)` runs the operation of the form and shows errors. `onTouch(operation,
    // error)` is called after a change of the form: `operation` is null if the form is incomplete
    // or has an error. `onRefuse(error, isPlain)` shows an error in `verdict`, see refuse().
    // `onArm({name, kind, isList})` is called when a field begins to wait for
    // clicks in the view, and with undefined when it stops. `onDraw()` is called when the user wants
    // to draw a lasso for the form, see takeLasso(). `meshes()` returns the list of meshes. `verdict`
    // is the element that says what the edit in the form would do; it is placed below the field in
    // which the user types.
    constructor(
        { select, form, search, all, verdict },
        { onRun, onTouch, onRefuse, onArm, onDraw, meshes, onError },
    ) {
        this.#form = form;
        this.#verdict = verdict;
        this.#onRun = onRun;
        this.#onTouch = onTouch;
        this.#onRefuse = onRefuse;
        this.#onArm = onArm;
        this.#onDraw = onDraw;
        this.#meshes = () => meshes().catch((error) => (onError(error), []));
        this.#chooser = new Chooser(
            { select, search, all },
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
                if (this.#hasAll()) {
                    this.#onRun(this.#read());
                }
            } catch (error) {
                if (!this.refuse(error)) {
                    onError(error);
                }
            }
        });
    }

    setOperations(operations) {
        this.#chooser.setOperations(operations);
    }

    // Fills the form with the selected elements, a Selection. If the last call had the same elements,
    // the text that the user has typed into the form stays.
    setSelection(selection) {
        const before = this.#offered;
        this.#offered = new Offered(selection);
        if (this.#offered.isSame(before)) {
            return;
        }
        this.#chooser.setFilter(this.#offered.filter);
        const fitting = this.#fitting();
        if (!this.#isChosen && fitting !== undefined && !this.#fits(this.#chooser.operation)) {
            this.#chooser.set(fitting.name);
            this.#build();
        } else {
            this.#fill();
            this.#touch();
        }
    }

    // --- clicks ---

    // Whether a field waits for a click in the view.
    get isArmed() {
        return this.#armed !== null;
    }

    // The kind of elements for which a field waits.
    get wantedKind() {
        return this.#armed === null ? null : kindOf(this.#armed.param);
    }

    disarm() {
        if (this.isArmed) {
            this.#arm(null);
        }
    }

    // Puts a clicked element into the field that waits for it; `place` is the position of the
    // element if it is a vertex.
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
            // On a narrow page the view is above the form, so the form may have been scrolled away.
            this.#armed.button.scrollIntoView({ block: 'nearest' });
        }
        this.#armed = armed;
        armed?.button.setAttribute('aria-pressed', 'true');
        const { param } = armed ?? {};
        this.#onArm(param && { name: param.name, kind: kindOf(param), isList: isList(param) });
    }

    // Called when the user has typed into a field. If the parameter of the field is one of several
    // alternatives, the fields of the other alternatives are cleared.
    #typed(target) {
        const field = this.#fields.get(target.closest('.field').dataset.name);
        field.row.after(this.#verdict);
        const { group, selects } = field.param;
        if (group !== undefined && field.control.isSaid) {
            for (const other of this.#fields.values()) {
                if (other !== field && other.param.group === group) {
                    other.control.clear();
                }
            }
        }
        if (selects) {
            this.disarm();
            this.#unfold();
            this.#fill(true);
        }
        this.#touch();
    }

    // The value of the operation's selector, a choice on which other parameters depend, or undefined
    // if the operation has none.
    get #selected() {
        return [...this.#fields.values()].find(({ param }) => param.selects)?.control.read();
    }

    // The fields of the parameters that may be given.
    get #open() {
        const selected = this.#selected;
        return [...this.#fields.values()].filter(({ param }) => isOpen(param, selected));
    }

    // Shows the rows of the parameters that may be given, and hides the others.
    #unfold() {
        const open = this.#open;
        for (const field of this.#fields.values()) {
            const isHidden = !open.includes(field);
            field.row.hidden = isHidden;
            field.marks.textContent = marksOf(field.param, this.#selected);
            if (field.or !== null) {
                field.or.hidden = isHidden;
            }
        }
    }

    // Puts a lasso that the user has drawn into the form, if it still has fields for one: a matrix of
    // 16 numbers and a polygon of points [x, y].
    takeLasso({ matrix, polygon }) {
        const find = (type) => this.#open.find(({ param }) => param.type === type);
        const [ofMatrix, ofPolygon] = [find('matrix_projective'), find('polygon')];
        if (ofMatrix !== undefined && ofPolygon !== undefined) {
            ofMatrix.control.set([0, 4, 8, 12].map((row) => matrix.slice(row, row + 4)));
            ofPolygon.control.set(polygon);
            this.#touch();
        }
    }

    // Reports the operation of the form to onTouch(), if the user has chosen an operation.
    #touch() {
        this.mark('');
        if (!this.#isChosen || this.#chooser.operation === undefined) {
            return;
        }
        try {
            const isReady = missingOf(this.#open, this.#selected) === undefined;
            this.#onTouch(isReady ? this.#read() : null, null);
        } catch (error) {
            this.mark(error.pointer ?? '');
            this.#onTouch(null, error);
        }
    }

    // The elements that the form's fields name, {kind, id} each; the list is empty until the user
    // has chosen an operation.
    get elements() {
        const fields = this.#isChosen ? this.#open : [];
        return fields
            .filter(({ param }) => kindOf(param) !== null && !isPlace(param))
            .flatMap(({ param, control }) =>
                control.ids.map((id) => ({ kind: kindOf(param), id })),
            );
    }

    // Returns whether every parameter has a value or needs none. If not, says so beside the first one
    // that needs a value.
    #hasAll() {
        const missing = missingOf(this.#open, this.#selected);
        if (missing === undefined) {
            return true;
        }
        const { name } = missing.param;
        this.refuse(slip(name, 'A value is missing', wantOf(missing, this.#open)), true);
        return false;
    }

    // Shows an error beside the field to which its pointer refers, and moves the focus there. Returns
    // false if there is no such field. `isPlain` says that the error is a sentence by itself.
    refuse(error, isPlain = false) {
        const field = this.#open.find((one) => isAbout(one, error.pointer ?? ''));
        if (field === undefined) {
            return false;
        }
        this.mark(error.pointer);
        field.row.after(this.#verdict);
        field.control.main.focus();
        this.#onRefuse(error, isPlain);
        return true;
    }

    // Marks the field to which the pointer of a problem refers as wrong; if the pointer is '', no
    // field is marked.
    mark(pointer) {
        for (const field of this.#fields.values()) {
            const isWrong = isAbout(field, pointer);
            field.row.classList.toggle('wrong', isWrong);
            field.control.main.setAttribute('aria-invalid', isWrong);
        }
    }

    // Returns whether the first parameter of an operation takes elements of the selected kind.
    #fits({ params } = { params: [] }) {
        return params.length > 0 && params[0].type === this.#offered.kind;
    }

    // Returns the operation whose form is shown when the user has chosen none: one that takes all
    // selected elements, else one that takes some of them, or undefined.
    #fitting() {
        const { kind, count } = this.#offered;
        const some = this.#chooser.all.filter((one) => this.#fits(one) && !isDeletion(one));
        return some.find((one) => roomFor(one, [kind]) >= count) ?? some[0];
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of this.#form.querySelectorAll('button[type="submit"]')) {
            enable(button, enabled);
        }
    }

    // Returns the request for an operation on all selected elements, or only on the one selected
    // last if the operation takes one element; null if the operation cannot take the selection.
    operationOn(name) {
        const { kind, last, crowd, ids } = this.#offered;
        const row = this.#chooser.find(name);
        const { plural } = row?.params.find(({ type }) => type === kind) ?? {};
        if (crowd !== null) {
            return plural === undefined ? null : { op: name, [plural]: SELECTION };
        }
        return plural && ids.length > 1 ? { op: name, [plural]: ids } : { op: name, [kind]: last.id };
    }

    get operations() {
        return this.#chooser.all;
    }

    // Returns the row of an operation in the server's table, or undefined.
    rowOf(name) {
        return this.#chooser.find(name);
    }

    // Returns whether the operation works on the whole mesh, so that it may take long.
    isWhole(name) {
        return this.#chooser.find(name)?.size === 'whole';
    }

    // Returns whether the server has an operation with this name.
    has(name) {
        return this.#chooser.find(name) !== undefined;
    }

    // Shows the form of an operation, which must exist.
    show(name) {
        this.#chooser.set(name);
        this.#isChosen = true;
        this.#build();
    }

    // Shows the form of an operation and moves the focus there: to the first empty field, else to
    // the first field, else to the button.
    open(name) {
        this.show(name);
        const controls = this.#open.map(({ control }) => control);
        const { main } = controls.find(({ isSaid }) => !isSaid) ?? controls[0] ?? {};
        (main ?? this.#form.querySelector('button')).focus();
    }

    // Ticks the field of a flag of the form, if the form has it.
    tick(name) {
        const node = this.#fields.get(name)?.control.node;
        if (node?.type === 'checkbox') {
            node.checked = true;
        }
    }

    // Moves the focus to the field of a parameter of the form; returns false if there is none.
    focus(name) {
        const main = this.#fields.get(name)?.control.main;
        main?.focus();
        main?.select();
        return main !== undefined;
    }

    #build() {
        const { operation } = this.#chooser;
        this.disarm();
        this.#fields.clear();
        const fields = fieldsOf(operation?.params ?? [], {
            meshes: this.#meshes,
            onArm: (armed) => this.#arm(this.#armed === armed ? null : armed),
            onDraw: this.#onDraw,
        });
        fields.forEach((field) => this.#fields.set(field.param.name, field));
        this.#form.replaceChildren(
            make('p', { className: 'small' }, ...prose(operation?.doc ?? ''), ' ', ...pageOf(operation)),
            ...fields.flatMap(({ or, row }) => (or === null ? [row] : [or, row])),
            this.#verdict,
            make(
                'button',
                { type: 'submit', className: 'primary wide', disabled: !this.#isEnabled },
                'Apply',
            ),
        );
        this.#form.hidden = operation === undefined;
        this.#unfold();
        this.#fill();
        this.#touch();
    }

    // Fills each field with selected elements of the kind that its parameter takes, in the order of
    // selection; an element goes into one field only. A Crowd goes into the first field that takes
    // sets of its kind. Of several alternative parameters only the
    // first that fits is filled. Fields that the user filled by clicks stay as they are; if
    // `isEmptyOnly` is true, all fields that are not empty do.
    #fill(isEmptyOnly = false) {
        const isAtBoundary = this.#chooser.operation?.refusals.includes('not_boundary') ?? false;
        const left = new Map(KINDS.map((kind) => [kind, this.#offered.idsOf(kind, isAtBoundary)]));
        const fields = this.#open;
        let isNamed = false; // a field names the selection
        const isKept = ({ control, isTaken }) => isTaken || (isEmptyOnly && control.isSaid);
        const groups = new Set(fields.filter(isKept).map(({ param }) => param.group));
        groups.delete(undefined);
        for (const field of fields) {
            const { param, control } = field;
            const kind = kindOf(param);
            if (kind === null || isPlace(param) || isKept(field)) {
                continue;
            }
            if (kind === this.#offered.crowd?.kind && isList(param) && param.set && !isNamed) {
                control.setSelection();
                isNamed = true;
                groups.add(param.group);
                groups.delete(undefined);
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

    #read() {
        const operation = { op: this.#chooser.operation.name };
        for (const field of this.#open) {
            const [name, value] = readField(field);
            if (value !== undefined) {
                operation[name] = value;
            }
        }
        return operation;
    }
}

// Returns whether an operation deletes elements; the page never selects such an operation by
// itself.
function isDeletion({ name }) {
    return name.endsWith('_delete');
}
