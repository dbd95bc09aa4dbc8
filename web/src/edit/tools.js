// tools.js - shows a form for the operation that the user chooses, filled with the selected
// elements. The forms are made from the server's list of operations, so that a new operation
// appears without a change here.

import { slip } from '../kit/numbers.js';
import { Chooser } from './chooser.js';
import { Flag, SELECTION } from '../kit/controls.js';
import { enable, formatCount, make, prose } from '../kit/dom.js';
import {
    KINDS,
    controlFor,
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

// By kind of element: the function that returns the ids of the elements of this kind to which a
// selected element of another kind refers.
const LINKS = {
    vertex: (element) => (element.origin === undefined ? [] : [element.origin]),
    edge: (element) => (element.edge === undefined ? [] : [element.edge]),
    face: (element) => (typeof element.face === 'number' ? [element.face] : []),
    halfedge: (element) => element.halfedges?.slice(0, 1) ?? [],
};

// Returns the boundary half-edge that a selected element means, or null: its own, that of its edge, or
// the only one beside it. `near` are the half-edges around the element, see around.js.
function boundaryOf({ kind, id, element }, near) {
    if (kind === 'vertex') {
        return element.boundary ? element.halfedge : null;
    }
    if (kind === 'edge') {
        const side = element.faces.indexOf(null);
        return side < 0 ? null : element.halfedges[side];
    }
    if (kind === 'halfedge') {
        const isInner = near.some((one) => one.id === id && one.across === null);
        return element.boundary ? id : isInner ? element.twin : null;
    }
    const beside = near.filter(({ face }) => face === null);
    return beside.length === 1 ? beside[0].id : null;
}

// The kinds of parameters that a selected element fills, and its name for one and for several.
const TAKEN = {
    vertex: { kinds: ['vertex'], names: ['vertex', 'vertices'] },
    edge: { kinds: ['edge'], names: ['edge', 'edges'] },
    face: { kinds: ['face'], names: ['face', 'faces'] },
    halfedge: { kinds: ['halfedge', 'edge'], names: ['half-edge', 'half-edges'] },
};

// Returns a link to the page of an operation in the manual, which opens beside the mesh.
function pageOf(operation) {
    if (operation === undefined) {
        return [];
    }
    const page = { href: operation.docs.slice(1), target: '_blank', rel: 'noopener' };
    return [make('a', page, 'Drawing and example', make('span', { className: 'unseen' }, ' (in a new tab)'))];
}

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
    #selection = [];
    #crowd = null;
    #around = []; // half-edges around the element selected last
    #isEnabled = true;
    #isChosen = false; // the user chose an operation, so that it stays when the selection changes
    // name of the parameter -> {param, control, row, or, marks, isTaken}; `or` is the line above the
    // row of an alternative, and `marks` the note in the row
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
    setSelection({ chosen, crowd, around }) {
        const isSame = keyOf(chosen) === keyOf(this.#selection) && crowd === this.#crowd;
        [this.#selection, this.#crowd, this.#around] = [chosen, crowd, around?.halfedges ?? []];
        if (isSame) {
            return;
        }
        this.#chooser.setFilter(this.#filter());
        const fitting = this.#fitting();
        if (!this.#isChosen && fitting !== undefined && !this.#fits(this.#chooser.operation)) {
            this.#chooser.set(fitting.name);
            this.#build();
        } else {
            this.#fill();
            this.#touch();
        }
    }

    // Returns which operations take all selected elements, see Chooser.setFilter(); null if nothing
    // is selected.
    #filter() {
        const count = this.#count;
        if (count === 0) {
            return null;
        }
        const { kinds, names } = TAKEN[this.#kind];
        return {
            title: count === 1 ? `For the selected ${names[0]}` : `For ${formatCount(count)} ${names[1]}`,
            takes: (operation) => roomFor(operation, kinds) >= count,
        };
    }

    // The kind and the number of the selected elements.
    get #kind() {
        return this.#crowd?.kind ?? this.#selection.at(-1)?.kind;
    }

    get #count() {
        return this.#crowd?.count ?? this.#selection.length;
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
        return params.length > 0 && params[0].type === this.#kind;
    }

    // Returns the operation whose form is shown when the user has chosen none: one that takes all
    // selected elements, else one that takes some of them, or undefined.
    #fitting() {
        const [kind, count] = [this.#kind, this.#count];
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
        const [kind, last] = [this.#kind, this.#selection.at(-1)];
        const row = this.#chooser.find(name);
        const { plural } = row?.params.find(({ type }) => type === kind) ?? {};
        if (this.#crowd !== null) {
            return plural === undefined ? null : { op: name, [plural]: SELECTION };
        }
        const ids = this.#selection.map((chosen) => chosen.id);
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
        const params = operation?.params ?? [];
        const rows = params.flatMap((param, i) =>
            this.#rows(param, isOtherOf(params.slice(0, i), param)),
        );
        this.#form.replaceChildren(
            make('p', { className: 'small' }, ...prose(operation?.doc ?? ''), ' ', ...pageOf(operation)),
            ...rows,
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

    // Returns the rows of a parameter in the form; `isOther` says that the parameter is an
    // alternative to the parameter before it.
    #rows(param, isOther) {
        const { name, doc } = param;
        const id = `param-${name}`;
        const pickable = (part, control) => this.#pickable(part, control);
        const control = controlFor(param, this.#meshes, pickable);
        const marks = make('span', { className: 'small' });
        const or = isOther ? make('p', { className: 'or' }, 'or') : null;
        const field = { param, control, row: null, or, marks, isTaken: false };
        this.#fields.set(name, field);
        // If a control consists of several inputs, they form a group and the first has the id.
        const isGroup = control.main !== control.node;
        const help = make('p', { id: `${id}-doc`, className: 'small' }, ...prose(doc));
        control.main.id = id;
        control.main.setAttribute('aria-describedby', help.id);
        const label = isGroup
            ? make('span', { id: `${id}-name`, className: 'name' }, name)
            : make('label', { htmlFor: id, className: 'name' }, name);
        const head = make('div', { className: 'head' }, label, marks);
        const box = kindOf(param) === null ? this.#drawable(param, control) : pickable(param, control);
        const className = control instanceof Flag ? 'field flag' : 'field';
        field.row = make('div', { className }, head, box, help);
        field.row.dataset.name = name;
        if (isGroup) {
            field.row.setAttribute('role', 'group');
            field.row.setAttribute('aria-labelledby', label.id);
        }
        return isOther ? [or, field.row] : [field.row];
    }

    // Returns the node of a control; that of a polygon with a button, after which the user draws the
    // polygon in the view.
    #drawable({ name, type }, control) {
        if (type !== 'polygon') {
            return control.node;
        }
        const button = make(
            'button',
            {
                type: 'button',
                'aria-label': `Draw ${name} in the view`,
                onclick: () => this.#onDraw(),
            },
            'Draw',
        );
        return make('div', { className: 'drawn' }, control.node, button);
    }

    // Returns an element with a control and a button: after a click on the button, a click in the
    // view fills the control.
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

    // Fills each field with selected elements of the kind that its parameter takes, in the order of
    // selection; an element goes into one field only. A Crowd goes into the first field that takes
    // sets of its kind. Of several alternative parameters only the
    // first that fits is filled. Fields that the user filled by clicks stay as they are; if
    // `isEmptyOnly` is true, all fields that are not empty do.
    #fill(isEmptyOnly = false) {
        const left = new Map(KINDS.map((kind) => [kind, this.#ids(kind)]));
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
            if (kind === this.#crowd?.kind && isList(param) && param.set && !isNamed) {
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

    // Whether the operation takes only half-edges of the boundary.
    get #isAtBoundary() {
        return this.#chooser.operation?.refusals.includes('not_boundary') ?? false;
    }

    #ids(kind) {
        if (kind === 'halfedge' && this.#isAtBoundary) {
            const ids = this.#selection.map((chosen) => boundaryOf(chosen, this.#around));
            const found = ids.filter((id) => id !== null);
            if (found.length > 0) {
                return [...new Set(found)];
            }
        }
        const direct = this.#selection.filter((chosen) => chosen.kind === kind);
        return direct.length > 0
            ? direct.map(({ id }) => id)
            : [...new Set(this.#selection.flatMap(({ element }) => LINKS[kind](element)))];
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

function keyOf(selection) {
    return selection.map(({ kind, id }) => `${kind}:${id}`).join();
}

// Returns whether an operation deletes elements; the page never selects such an operation by
// itself.
function isDeletion({ name }) {
    return name.endsWith('_delete');
}

// Returns whether a parameter is an alternative to one of the parameters before it.
function isOtherOf(before, { group }) {
    return group !== undefined && before.some((other) => other.group === group);
}
