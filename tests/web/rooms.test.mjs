// rooms.test.mjs - imports of the page run only downward through its rooms, and no room is too full.

import assert from 'node:assert/strict';
import { readFile, readdir } from 'node:fs/promises';
import path from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const web = fileURLToPath(new URL('../../web', import.meta.url));
const source = path.join(web, 'src');

// The most files that one room may have.
const MOST_FILES = 34;

// Returns the names of the rooms, lowest first. The last one is the folder of main.js itself.
async function roomsOfReadme() {
    const text = await readFile(path.join(web, 'README.md'), 'utf8');
    const names = [...text.matchAll(/^\| ([a-z]+) \|/gm)].map(([, name]) => name);
    return [...names.filter((name) => name !== 'room'), ''];
}

// Returns the paths of all scripts of the page, relative to their common folder.
async function scripts() {
    const names = await readdir(source, { recursive: true });
    return names.filter((name) => name.endsWith('.js'));
}

// Returns the room of a script.
function roomOf(file) {
    const folder = path.dirname(file);
    return folder === '.' ? '' : folder;
}

test('every file is in a room, and no room has too many', async () => {
    const rooms = await roomsOfReadme();
    const sizes = new Map();
    for (const file of await scripts()) {
        const room = roomOf(file);
        assert.ok(rooms.includes(room), `${file}: web/README.md lists no room ${room}`);
        sizes.set(room, (sizes.get(room) ?? 0) + 1);
    }
    for (const room of rooms) {
        assert.ok(sizes.has(room), `${room}: a room without files`);
        assert.ok(sizes.get(room) <= MOST_FILES, `${room}: more than ${MOST_FILES} files`);
    }
});

test('imports run downward', async () => {
    const rooms = await roomsOfReadme();
    let imports = 0;
    for (const file of await scripts()) {
        const text = await readFile(path.join(source, file), 'utf8');
        for (const [, name] of text.matchAll(/from '(\.[^']*)'/g)) {
            const target = path.normalize(path.join(path.dirname(file), name));
            assert.ok(
                rooms.indexOf(roomOf(target)) <= rooms.indexOf(roomOf(file)),
                `${file} imports ${target}, which is in a higher room`,
            );
            imports += 1;
        }
    }
    assert.ok(imports > 100, `only ${imports} imports were found`);
});
