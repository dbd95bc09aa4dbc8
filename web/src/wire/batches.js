// batches.js - decides which of the files that a user chose are uploaded together.

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

// Returns a list with one `{ file, beside }` for each upload: `file` is the file that the server
// reads, `beside` are the files that it refers to. If one of the mesh files has a format that
// refers to other files, it is sent with all files that are not meshes; if several have, each is
// sent with the files whose names occur in its text. Images are left out, because the server does
// not read them. A file that no mesh file refers to is sent alone, so that the server says what is
// wrong with it.
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
