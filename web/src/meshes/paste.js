// paste.js - recognises a mesh in the text that the user pastes.

// How a text of each format begins, the surest first.
const BEGINNINGS = [
    ['gltf', /^\s*\{[^]*"asset"\s*:/],
    ['json', /^\s*\{/],
    ['ply', /^ply\s/],
    ['stl', /^\s*solid\b[^]*\bfacet\b/],
    ['off', /^\s*(ST)?C?N?4?n?OFF\b/],
    ['obj', /^(\s*#[^\n]*\n|\s*\n)*\s*(v|vn|vt|o|g|mtllib|usemtl|s)\s+\S/],
];

// Returns the file that a text is, or null if it does not look like a mesh.
export function fileOf(text) {
    const [extension] = BEGINNINGS.find(([, pattern]) => pattern.test(text)) ?? [];
    return extension === undefined ? null : new File([text], `pasted.${extension}`);
}
