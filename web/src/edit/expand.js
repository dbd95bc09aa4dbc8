// expand.js - puts the selected elements into an operation that names the selection.

import * as api from '../wire/api.js';
import { SELECTION } from '../kit/controls.js';
import { PLURALS } from '../geometry/kinds.js';
import { slip } from '../kit/numbers.js';

// If more elements are selected than this, their ids are not sent: they become a set named SENT, which
// the operation takes. The page keeps this name to itself, so that no set of the user is replaced.
const MOST_SENT = 500000;
const SENT = 'hedge_page_selection';

// Returns whether a parameter of an operation names the selection.
export function namesSelection(operation) {
    return Object.values(operation).includes(SELECTION);
}

// Returns an operation in which the ids of the selected elements are in place of SELECTION. Throws a
// Problem if the operation does not take elements of the selected kind.
export async function expanded(operation, session) {
    const members = Object.entries(operation).map(async ([name, value]) => [
        name,
        value === SELECTION ? await selected(name, session) : value,
    ]);
    return Object.fromEntries(await Promise.all(members));
}

// Returns the selected elements, or their vertices, as the value of the parameter `name`.
async function selected(name, session) {
    const { selection, shown } = session;
    const isVertices = name === 'vertices' && selection.asCrowd !== null;
    if (PLURALS[selection.kind] !== name && !isVertices) {
        const what = selection.kind === null ? 'Nothing is' : `${PLURALS[selection.kind]} are`;
        throw slip(name, 'Other elements', `${what} selected, but ${name} are needed.`);
    }
    const ids = isVertices
        ? selection.asCrowd.verticesIn(shown.geometry)
        : await selection.ids();
    if (ids.length <= MOST_SENT) {
        return ids;
    }
    const set = { domain: name, name: SENT };
    if ((await session.saveSet(set, ids)) === null) {
        throw new api.Problem({
            title: 'Not sent',
            detail: 'Another edit is in progress. Try again when it is done.',
        });
    }
    return { [set.name]: true };
}
