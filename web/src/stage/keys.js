// keys.js - the keys of the 3D view, and the list of keys that `?` shows. The keys work only while
// the canvas has the focus, because letters typed elsewhere are text.

import { make } from '../kit/dom.js';

// Each row is [the keys as the list shows them, with spaces between; the key in the notation of listenToKeys(),
// description, name of the function in `acts`]. A row without a function only informs.
const KEYS = [
    ['1', '1', 'Pick vertices', 'pickVertex'],
    ['2', '2', 'Pick edges', 'pickEdge'],
    ['3', '3', 'Pick faces', 'pickFace'],
    ['4', '4', 'Pick half-edges', 'pickHalfedge'],
    ['N', 'n', 'Next half-edge', 'next'],
    ['P', 'p', 'Previous half-edge', 'prev'],
    ['T', 't', 'Twin half-edge', 'twin'],
    ['F', 'f', 'Show the selection, or the whole mesh', 'frame'],
    ['+', '+', 'Zoom in', 'zoomIn'],
    ['-', '-', 'Zoom out', 'zoomOut'],
    ['V', 'v', 'Open or close the View panel (shading, section, theme, grid, units)', 'view'],
    ['Z', 'z', 'Draw the mesh solid, as X-ray, as wires or as points', 'nextWay'],
    ['B', 'b', 'Select by drawing a box', 'box'],
    ['L', 'l', 'Select by drawing a lasso', 'lasso'],
    ['D', 'd', 'Select by painting', 'paint'],
    ['A', 'a', 'Select all', 'all'],
    ['Y', 'y', 'Invert the selection', 'invert'],
    [']', ']', 'Grow the selection', 'grow'],
    ['[', '[', 'Shrink the selection', 'shrink'],
    ['K', 'k', 'Select everything connected to the selection', 'connected'],
    ['O', 'o', 'Select the edge loop. With the mouse: Alt+click', 'loop'],
    ['R', 'r', 'Select the edge ring. With the mouse: Ctrl+Alt+click', 'ring'],
    ['G', 'g', 'Move the selection by dragging', 'move'],
    ['E', 'e', 'Extrude faces or boundary edges by dragging', 'extrude'],
    ['I', 'i', 'Inset faces by dragging', 'inset'],
    ['W', 'w', 'Show handles that move, rotate and scale', 'gizmo'],
    ['0 to 9', null, 'While you move, extrude or inset: type the exact amount, then press Enter', null],
    ['S', 's', 'Split the selected edge or face, or the face between two selected vertices', 'split'],
    ['X', 'x', 'Delete the selected face or vertex, or collapse the selected edge', 'remove'],
    ['M', 'm', 'Start or stop measuring', 'measure'],
    ['C', 'c', 'Check the mesh: list defects, holes and components', 'check'],
    ['Ctrl Z', 'ctrl+z', 'Undo', 'undo'],
    ['Ctrl Shift Z', 'ctrl+shift+z', 'Redo', 'redo'],
    ['Ctrl K', null, 'Find any command by its name, wherever the focus is', null],
    ['?', '?', 'Show this list', 'help'],
    ['Esc', 'escape', 'Cancel, or clear the selection', 'clear'],
];

// Listens to the keys; `acts` has the functions that the keys call. Its function type(key) is asked
// first; if it returns true, the key is part of a number and not a command.
export function listenToKeys(canvas, acts) {
    canvas.addEventListener('keydown', (event) => {
        if (!event.ctrlKey && !event.metaKey && !event.altKey && acts.type(event.key)) {
            return;
        }
        const control = event.ctrlKey || event.metaKey;
        const shift = control && event.shiftKey;
        const name = `${control ? 'ctrl+' : ''}${shift ? 'shift+' : ''}${event.key.toLowerCase()}`;
        const row = KEYS.find(([, key]) => key === name);
        if (row !== undefined && !event.altKey) {
            event.preventDefault();
            acts[row[3]]();
        }
    });
}

export function keyList() {
    return KEYS.flatMap(([keys, , text]) => [
        make('dt', {}, ...keys.split(' ').map((key) => (key === 'to' ? ' to ' : make('kbd', {}, key)))),
        make('dd', {}, text),
    ]);
}
