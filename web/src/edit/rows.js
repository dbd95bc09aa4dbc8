// rows.js - makes the rows of the form of an operation: for each parameter its name, its control, and
// what it is for.

import { Flag } from '../kit/controls.js';
import { make, prose } from '../kit/dom.js';
import { controlFor, kindOf } from './fields.js';

// Returns a link to the page of an operation in the manual, which opens beside the mesh.
export function pageOf(operation) {
    if (operation === undefined) {
        return [];
    }
    const page = { href: operation.docs.slice(1), target: '_blank', rel: 'noopener' };
    return [make('a', page, 'Drawing and example', make('span', { className: 'unseen' }, ' (in a new tab)'))];
}

// Makes the fields of some parameters, {param, control, row, or, marks, isTaken} each: `or` is the line
// above the row of an alternative or null, `marks` the note in the row, and `isTaken` is false until a
// click in the view has filled the field. `meshes()` is as in controlFor(); onArm({param, control,
// button}) is called when the user wants to fill a control by clicks, and onDraw() when the user wants
// to draw a polygon.
export function fieldsOf(params, acts) {
    return params.map((param, i) => fieldOf(param, isOtherOf(params.slice(0, i), param), acts));
}

function fieldOf(param, isOther, acts) {
    const { name, doc } = param;
    const id = `param-${name}`;
    const pickable = (part, control) => pickableOf(part, control, acts);
    const control = controlFor(param, acts.meshes, pickable);
    const marks = make('span', { className: 'small' });
    const or = isOther ? make('p', { className: 'or' }, 'or') : null;
    // If a control consists of several inputs, they form a group and the first has the id.
    const isGroup = control.main !== control.node;
    const help = make('p', { id: `${id}-doc`, className: 'small' }, ...prose(doc));
    control.main.id = id;
    control.main.setAttribute('aria-describedby', help.id);
    const label = isGroup
        ? make('span', { id: `${id}-name`, className: 'name' }, name)
        : make('label', { htmlFor: id, className: 'name' }, name);
    const head = make('div', { className: 'head' }, label, marks);
    const box = kindOf(param) === null ? drawableOf(param, control, acts) : pickable(param, control);
    const className = control instanceof Flag ? 'field flag' : 'field';
    const row = make('div', { className }, head, box, help);
    row.dataset.name = name;
    if (isGroup) {
        row.setAttribute('role', 'group');
        row.setAttribute('aria-labelledby', label.id);
    }
    return { param, control, row, or, marks, isTaken: false };
}

// Returns the node of a control; that of a polygon with a button, after which the user draws the
// polygon in the view.
function drawableOf({ name, type }, control, { onDraw }) {
    if (type !== 'polygon') {
        return control.node;
    }
    const button = make(
        'button',
        {
            type: 'button',
            'aria-label': `Draw ${name} in the view`,
            onclick: () => onDraw(),
        },
        'Draw',
    );
    return make('div', { className: 'drawn' }, control.node, button);
}

// Returns an element with a control and a button: after a click on the button, a click in the
// view fills the control.
function pickableOf(param, control, { onArm }) {
    const armed = { param, control };
    armed.button = make(
        'button',
        {
            type: 'button',
            'aria-label': `Pick ${param.name} in the view`,
            'aria-pressed': 'false',
            onclick: () => onArm(armed),
        },
        'Pick',
    );
    return make('div', { className: 'picked' }, control.node, armed.button);
}

// Returns whether a parameter is an alternative to one of the parameters before it.
function isOtherOf(before, { group }) {
    return group !== undefined && before.some((other) => other.group === group);
}
