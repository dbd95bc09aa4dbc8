// restart.test.mjs - tests what a new user may do first: edit a mesh in the page, stop the daemon
// with Ctrl-C, start it again on the same folder, and undo the edit in the page.

import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';

import { projector, waitForFrame } from './browser.mjs';
import { get, getAll, startDaemon } from './daemon.mjs';
import { chooseOperation, click } from './page.mjs';
import { openPage } from './visit.mjs';

async function open(t, daemon, name, revision) {
    const page = await openPage(t, daemon);
    await page.locator('#meshes button').filter({ hasText: name }).click();
    await waitForFrame(page, { mesh: name, revision });
    return page;
}

// Returns everything about the mesh except its revision, so that states can be compared.
async function stateOf(daemon, mesh) {
    const { counts, bounds } = await get(daemon, `/${mesh}`);
    const lists = await Promise.all(
        ['vertices', 'edges', 'faces'].map((kind) => getAll(daemon, mesh, kind)),
    );
    return { counts, bounds, lists };
}

async function leave(daemon) {
    await Promise.all(daemon.closers.splice(0).map((close) => close()));
    assert.equal(await daemon.stop('SIGINT'), 0);
}

test('what was edited before a stop is undone in the page after it', async (t) => {
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-restart-'));
    t.after(() => rm(folder, { recursive: true }));
    const flags = ['--store', `sqlite:${folder}/store`, '--samples'];

    let daemon = await startDaemon(t, ...flags);
    let page = await open(t, daemon, 'cube', 1);
    const before = await stateOf(daemon, 'cube');
    const place = await projector(page, daemon, 'cube');
    const [face] = before.lists[2].filter((one) => place.isSeen(one));
    await click(page, place.at(face.vertices));
    await waitForFrame(page, { selection: `face:${face.id}` });
    await chooseOperation(page, 'face_poke');
    await page.locator('#param-face').fill(`${face.id}`);
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
    const edited = await stateOf(daemon, 'cube');
    assert.notDeepEqual(edited, before);
    await leave(daemon);

    daemon = await startDaemon(t, ...flags);
    page = await open(t, daemon, 'cube', 2);
    assert.deepEqual(await stateOf(daemon, 'cube'), edited);
    const picture = process.env.RESTART_PICTURE;
    if (picture) {
        await writeFile(`${picture}-edited.png`, await page.screenshot());
    }
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await waitForFrame(page, { revision: 3 });
    assert.deepEqual(await stateOf(daemon, 'cube'), before);
    if (picture) {
        await writeFile(`${picture}-undone.png`, await page.screenshot());
    }
    await page.getByRole('button', { name: 'Redo' }).click();
    await waitForFrame(page, { revision: 4 });
    assert.deepEqual(await stateOf(daemon, 'cube'), edited);
    await leave(daemon);
});
