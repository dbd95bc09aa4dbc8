// Tests of the list of meshes: its order, and the search by name.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

const WIDTHS = [360, 800, 1440];
// The subdivisions make sizes that differ in another order than names and times.
const MESHES = [
    ['delta', 2],
    ['Alpha', 1],
    ['echo', 0],
    ['bravo', 3],
    ['Charlie', 2],
];

const search = (page) => page.getByRole('searchbox', { name: 'Find meshes by name' });
const order = (page) => page.getByLabel('Order of the meshes');
const shown = (page) => page.locator('.mesh-name').allTextContents();

// Waits until the list shows these names in this order.
function waitForList(page, names) {
    return page.waitForFunction(
        (wanted) => {
            const all = [...document.querySelectorAll('.mesh-name')].map((one) => one.textContent);
            return `${all}` === `${wanted}`;
        },
        names,
    );
}

async function makeMeshes(t) {
    const daemon = await startDaemon(t);
    const ids = {};
    for (const [name, subdivisions] of MESHES) {
        const { id } = await post(daemon, '', { name, shape: 'icosphere', subdivisions });
        ids[name] = id;
    }
    return { daemon, ids };
}

test('the newest mesh is on top and is opened first', async (t) => {
    const { daemon, ids } = await makeMeshes(t);
    const page = await openPage(t, daemon);
    await waitForList(page, ['Charlie', 'bravo', 'echo', 'Alpha', 'delta']);
    await waitForFrame(page, { mesh: ids.Charlie, revision: 1 });
    await post(daemon, `/${ids.delta}/edits`, { op: 'face_poke', face: 0 });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await waitForList(page, ['delta', 'Charlie', 'bravo', 'echo', 'Alpha']);
});

test('the list is sorted by name and by size', async (t) => {
    const { daemon } = await makeMeshes(t);
    const page = await openPage(t, daemon);
    await order(page).selectOption('name');
    await waitForList(page, ['Alpha', 'bravo', 'Charlie', 'delta', 'echo']);
    await order(page).selectOption('bytes');
    await page.waitForFunction(() => document.querySelector('.mesh-name')?.textContent === 'bravo');
    const names = await shown(page);
    assert.deepEqual(names, (await get(daemon, '?sort=bytes')).items.map(({ name }) => name));
    assert.deepEqual([names[3], names[4]], ['Alpha', 'echo']);
});

test('meshes are found by a part of their names', async (t) => {
    const { daemon } = await makeMeshes(t);
    const page = await openPage(t, daemon);
    await search(page).fill('A');
    await waitForList(page, ['Charlie', 'bravo', 'Alpha', 'delta']);
    await search(page).fill('al');
    await waitForList(page, ['Alpha']);
    await search(page).fill('<zulu> & 100%');
    await page.getByText('No name contains \u201c<zulu> & 100%\u201d.').waitFor();
    assert.deepEqual(await shown(page), []);
    // The search goes on, although there is nothing in the list.
    assert.ok(await page.getByRole('heading', { name: 'No meshes yet' }).isHidden());
    await checkAccessible(page, 'nothing found');
    await search(page).fill('');
    await waitForList(page, ['Charlie', 'bravo', 'echo', 'Alpha', 'delta']);
    assert.equal(await page.locator('#no-mesh').textContent(), '');
});

test('a new mesh is seen although the list is sorted and searched', async (t) => {
    const { daemon, ids } = await makeMeshes(t);
    const page = await openPage(t, daemon);
    await order(page).selectOption('name');
    await search(page).fill('echo');
    await waitForList(page, ['echo']);
    await page.getByRole('button', { name: 'Actions for echo', exact: true }).click();
    await page.getByRole('menuitem', { name: 'Duplicate' }).click();
    await waitForList(page, ['echo', 'echo copy']);
    await page.locator('#mesh-title').filter({ hasText: 'echo copy' }).waitFor();
    await fetch(`${daemon.url}/v1/meshes/${ids.echo}`, { method: 'DELETE' });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await waitForList(page, ['echo copy']);
});

test('a long list is read on in its order', async (t) => {
    const daemon = await startDaemon(t);
    const vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
    for (let i = 0; i < 205; i++) {
        await post(daemon, '', { name: `mesh ${1000 + i}`, vertices, faces: [[0, 1, 2]] });
    }
    const page = await openPage(t, daemon);
    await order(page).selectOption('name');
    await page.waitForFunction(() => document.querySelector('.mesh-name')?.textContent === 'mesh 1000');
    await page.getByRole('button', { name: 'Show more' }).click();
    const wanted = Array.from({ length: 205 }, (_, i) => `mesh ${1000 + i}`);
    await waitForList(page, wanted);
    await search(page).fill('mesh 12');
    await waitForList(page, wanted.slice(200));
    assert.ok(await page.getByRole('button', { name: 'Show more' }).isHidden());
});

test('with few meshes there is nothing to search', async (t) => {
    const daemon = await startDaemon(t);
    await post(daemon, '', { name: 'cube', shape: 'cube' });
    const page = await openPage(t, daemon);
    await waitForList(page, ['cube']);
    assert.ok(await search(page).isHidden());
});

test('the search works by keyboard at each width', async (t) => {
    for (const width of WIDTHS) {
        const { daemon } = await makeMeshes(t);
        const page = await openPage(t, daemon, { viewport: { width, height: 740 } });
        await waitForList(page, ['Charlie', 'bravo', 'echo', 'Alpha', 'delta']);
        await page.getByRole('button', { name: 'Refresh' }).focus();
        await page.keyboard.press('Tab');
        await page.keyboard.type('BRA');
        await waitForList(page, ['bravo']);
        await checkAccessible(page, `search at ${width}`);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} px at ${width}`);
    }
});
