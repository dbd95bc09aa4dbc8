// element_links.js - buttons that lead to elements of the mesh.

import { make } from './dom.js';

export const TITLES = { vertex: 'Vertex', halfedge: 'Half-edge', edge: 'Edge', face: 'Face' };

// If a list has more ids than this, the rest is shown after a click on a button.
const MOST = 16;

// Returns a button with an id, which calls `onFollow(kind, id)`.
export function linkTo(kind, id, onFollow) {
    return make(
        'button',
        {
            type: 'button',
            className: 'link',
            'aria-label': `${TITLES[kind]} ${id}`,
            onclick: () => onFollow(kind, id),
        },
        `${id}`,
    );
}

// Returns the first items of a list, made by `show(item)`, and, if there are more, a button that
// shows the rest.
export function shortened(items, show) {
    const rest = items.slice(MOST);
    const shown = items.slice(0, MOST).map(show);
    if (rest.length === 0) {
        return shown;
    }
    const button = make(
        'button',
        {
            type: 'button',
            className: 'rest',
            onclick: () => button.replaceWith(...rest.map(show)),
        },
        `${rest.length} more`,
    );
    return [...shown, button];
}
