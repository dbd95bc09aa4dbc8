// words.js - explains technical terms: each term in the panels is a button that shows its meaning.

import { make } from './dom.js';

// The distance in pixels that an explanation keeps from its term and from the edge of the window.
const GAP = 6;

const WORDS = {
    halfedge: 'One of the two directed sides of an edge. It runs from its origin to its target, with its face on the left.',
    halfedges: 'Directed sides of edges. Each edge has two, which run in opposite directions.',
    twin: 'The other half-edge of the same edge. It runs in the opposite direction.',
    next: 'The half-edge that follows on the way around the face, or around the hole.',
    prev: 'The half-edge that comes before on the way around the face, or around the hole.',
    origin: 'The vertex at which the half-edge begins.',
    target: 'The vertex at which the half-edge ends. It is the origin of its twin.',
    edge: 'The line between two vertices. It consists of two half-edges, which are twins.',
    face: 'A polygon of the surface. The half-edges around it run counter-clockwise, seen from outside.',
    boundary: 'At a boundary, a half-edge has no face: there is a hole, or the surface ends.',
    isolated: 'An isolated vertex belongs to no edge.',
    degree: 'The number of edges that meet at a vertex, or of corners of a face.',
    loop: 'The half-edges around one face or one hole, each the next of the one before.',
    ring: 'The half-edges that leave the same vertex, in the order around it: from one to the next by prev, then twin.',
    outgoing: 'The half-edges that begin at this vertex.',
    normal: 'The direction in which the face looks, as a vector of length 1.',
    centroid: 'The mean position of the surface of the face.',
};

let shown = null; // the box of the explanation that is open, or of the last one

// Returns a node for a word: a button if WORDS explains it, else a text.
export function explained(word) {
    const meaning = WORDS[word];
    if (meaning === undefined) {
        return document.createTextNode(word);
    }
    const button = make('button', { type: 'button', className: 'word', 'aria-expanded': 'false' }, word);
    button.addEventListener('click', () => show(button, meaning));
    return button;
}

function show(button, meaning) {
    shown?.remove();
    const box = make('div', { className: 'meaning', popover: 'auto', role: 'status' }, meaning);
    shown = box;
    box.addEventListener('beforetoggle', ({ newState }) => {
        button.setAttribute('aria-expanded', `${newState === 'open'}`);
    });
    box.addEventListener('toggle', ({ newState }) => {
        if (newState === 'closed') {
            box.remove();
        }
    });
    // The explanation follows the term in the document, so that a screen reader reads it next.
    button.after(box);
    box.showPopover();
    const { left, top, bottom } = button.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = box;
    const below = bottom + GAP;
    const y = below + height > window.innerHeight ? top - GAP - height : below;
    box.style.left = `${Math.max(GAP, Math.min(left, window.innerWidth - width - GAP))}px`;
    box.style.top = `${Math.max(GAP, y)}px`;
}
