// kinds.js - the kinds of elements, and what they are called. Pure.

// In words, by kind: one element, and several.
export const SINGULARS = { vertex: 'vertex', halfedge: 'half-edge', edge: 'edge', face: 'face' };
export const PLURALS = { vertex: 'vertices', halfedge: 'half-edges', edge: 'edges', face: 'faces' };

// What the API calls several elements of a kind, and the kind by this name.
export const API_PLURALS = { vertex: 'vertices', halfedge: 'halfedges', edge: 'edges', face: 'faces' };
export const KIND_OF = Object.fromEntries(Object.entries(API_PLURALS).map(([kind, many]) => [many, kind]));
