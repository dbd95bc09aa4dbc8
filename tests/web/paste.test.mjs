// Tests of pasting meshes into the page: files, and texts that are recognised by how they begin.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { fileOf } from '../../web/src/meshes/paste.js';
import { waitForTold } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const OBJ = '# a triangle\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n';

// Pastes into the element that has the focus.
async function paste(page, { text, name }) {
    await page.evaluate(
        ([pasted, file]) => {
            const clipboardData = new DataTransfer();
            if (file === undefined) {
                clipboardData.setData('text/plain', pasted);
            } else {
                clipboardData.items.add(new File([pasted], file));
            }
            const how = { clipboardData, bubbles: true, cancelable: true };
            document.activeElement.dispatchEvent(new ClipboardEvent('paste', how));
        },
        [text, name],
    );
}

const namesOf = async (daemon) => (await get(daemon, '')).items.map(({ name }) => name).sort();

test('texts of the server\u2019s formats are recognised, and other texts are not', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    for (const [format, encoding] of [
        ['obj', ''],
        ['off', ''],
        ['ply', '&encoding=ascii'],
        ['stl', '&encoding=ascii'],
        ['json', ''],
    ]) {
        const path = `${daemon.url}/v1/meshes/${mesh}/content?format=${format}${encoding}`;
        const text = await (await fetch(path)).text();
        assert.equal(fileOf(text)?.name, `pasted.${format}`);
    }
    assert.equal(fileOf('{"asset":{"version":"2.0"}}').name, 'pasted.gltf');
    assert.equal(fileOf(OBJ).name, 'pasted.obj');
    for (const text of ['', 'hello', 'a solid idea', 'https://example.org', 'vertex 3', '# title\n\nvery']) {
        assert.equal(fileOf(text), null, text);
    }
});

test('a pasted file and a pasted text are imported', async (t) => {
    const { daemon, page } = await openMesh(t, CUBE);
    await paste(page, { text: OBJ, name: 'part.obj' });
    await waitForTold(page, /Read part\.obj.*3 vertices, 1 face/);
    await page.locator('#canvas').focus();
    await paste(page, { text: OBJ });
    await waitForTold(page, /Read pasted\.obj.*3 vertices, 1 face/);
    assert.deepEqual(await namesOf(daemon), ['cube', 'part', 'pasted']);
    await page.locator('#mesh-title').filter({ hasText: 'pasted' }).waitFor();
});

test('a text that is no mesh is said, and what is pasted into a field stays there', async (t) => {
    const { daemon, page } = await openMesh(t, CUBE);
    await paste(page, { text: 'hello' });
    await expectToast(page, /Nothing to paste.*not a mesh/);
    await page.locator('#operation-search').focus();
    await paste(page, { text: OBJ });
    await page.getByRole('button', { name: 'Export', exact: true }).click();
    await page.getByRole('dialog').waitFor();
    await paste(page, { text: OBJ });
    await page.keyboard.press('Escape');
    assert.deepEqual(await namesOf(daemon), ['cube']);
    assert.equal(await page.getByRole('alert').count(), 1);
});
