// batches.js - which of the files that were chosen together belong in one upload.

const MESHES = ['obj', 'off', 'ply', 'stl', 'glb', 'gltf', 'json'];
const REFERRING = ['obj', 'glb', 'gltf'];
const IMAGES = ['png', 'jpg', 'jpeg', 'webp', 'ktx2', 'tga', 'bmp', 'gif', 'dds'];

function extensionOf(file) {
    return file.name.slice(file.name.lastIndexOf('.') + 1).toLowerCase();
}

function has(list, file) {
    return list.includes(extensionOf(file));
}

function names(text, file) {
    return text.includes(file.name) || text.includes(encodeURI(file.name));
}

// What goes in each request: `[{ file, beside }]`, a file that the server is to read and those that
// it refers to. A mesh alone gets all that came with it; of several each gets what it names. Images,
// which no mesh holds, stay behind. What belongs to no mesh is sent alone, for the server to say why
// it is none.
export async function batchesOf(files) {
    const meshes = files.filter((file) => has(MESHES, file));
    const referring = meshes.filter((file) => has(REFERRING, file));
    if (referring.length === 0) {
        return files.map((file) => ({ file, beside: [] }));
    }
    const others = files.filter((file) => !has(MESHES, file) && !has(IMAGES, file));
    const batches = meshes.map((file) => ({ file, beside: [] }));
    if (others.length === 0) {
        return batches;
    }
    const left = new Set(others);
    for (const batch of batches.filter(({ file }) => has(REFERRING, file))) {
        const text = referring.length > 1 ? await batch.file.text() : '';
        batch.beside = referring.length > 1 ? others.filter((file) => names(text, file)) : others;
        batch.beside.forEach((file) => left.delete(file));
    }
    return [...batches, ...[...left].map((file) => ({ file, beside: [] }))];
}
