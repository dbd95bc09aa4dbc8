// The forms of operations: fields filled by clicks, and what an edit would do said before it is
// sent, in Chromium against the real daemon.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { checkAccessible, launch, projector, waitForFrame } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { click, goTo, isEdit, openMesh as open, press } from './page.mjs';

let browser;
before(async () => {
    browser = await launch();
});
after(() => browser?.close());

const openMesh = (t, document, options) => open(t, browser, document, options);

const CUBE = { name: 'cube', shape: 'cube' };
const GRID = { name: 'grid', shape: 'grid', columns: 3, rows: 3 };

const choose = (page, name) => page.locator('#operation').selectOption(name);
const field = (page, name) => page.locator(`#param-${name}`);
const arm = (page, name) =>
    page.getByRole('button', { name: `Pick ${name} in the view`, exact: true }).click();

function expectValue(page, name, value) {
    return page.waitForFunction(
        ([id, wanted]) => document.getElementById(id).value === wanted,
        [`param-${name}`, value],
    );
}

const expectVerdict = (page, pattern) =>
    page.locator('#verdict').filter({ hasText: pattern }).waitFor();

test('a field that is armed takes the next click, the selection stays', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    await goTo(page, 'face', 0);
    await page.getByRole('button', { name: 'Fit view' }).click();
    const inner = (await getAll(daemon, mesh, 'edges')).filter((edge) => !edge.boundary);
    await choose(page, 'edge_flip');
    await arm(page, 'edge');
    assert.ok(await page.getByRole('radio', { name: 'Edge', exact: true }).isChecked());
    await checkAccessible(page, 'armed', '#details');
    await click(page, place.at(inner[3].vertices));
    await expectValue(page, 'edge', `${inner[3].id}`);
    assert.equal(await page.locator('[aria-pressed="true"]').count(), 0);
    await waitForFrame(page, { selection: 'face:0' });
    // What was clicked stays when something else is selected.
    await click(page, place.at(inner[1].vertices));
    await waitForFrame(page, { selection: `edge:${inner[1].id}` });
    assert.equal(await field(page, 'edge').inputValue(), `${inner[3].id}`);
});

test('a list collects clicks until Esc, and a second click takes one out', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    await choose(page, 'face_delete');
    await arm(page, 'face');
    for (const [id, value] of [[4, '4'], [2, '4 2'], [7, '4 2 7'], [2, '4 7']]) {
        await click(page, place.at(faces[id].vertices));
        await expectValue(page, 'face', value);
    }
    await press(page, 'Escape');
    assert.equal(await page.locator('[aria-pressed="true"]').count(), 0);
    await expectVerdict(page, '\u22122 F');
    const sent = page.waitForRequest(isEdit);
    await page.getByRole('button', { name: 'Apply' }).click();
    const { ops: [op] } = (await sent).postDataJSON();
    assert.deepEqual(op.faces, [4, 7]);
    await waitForFrame(page, { revision: 2 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 7);
});

test('a place is taken from a vertex, and alternatives drive each other out', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const { position } = await get(daemon, `/${mesh}/vertices/5`);
    await choose(page, 'vertex_move');
    await field(page, 'vertex').fill('3');
    await field(page, 'by').fill('0 0 1');
    await arm(page, 'to');
    await click(page, place.at([5]));
    await expectValue(page, 'to', position.join(' '));
    assert.equal(await field(page, 'by').inputValue(), '');
    await expectVerdict(page, 'Would change: 1 V');
});

test('what an edit would make or why not is said before it is sent', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await choose(page, 'face_poke');
    assert.equal(await page.locator('#verdict').textContent(), '');
    await field(page, 'face').fill('2');
    await expectVerdict(page, 'Would make: +1 V +4 E +3 F');
    await checkAccessible(page, 'tried', '#details');
    await field(page, 'face').fill('66');
    await expectVerdict(page, /Would be refused:.*66/);
    await checkAccessible(page, 'would be refused', '#details');
    await field(page, 'face').fill('six');
    await expectVerdict(page, /six.*not a number/);
    assert.equal(await page.getByRole('alert').filter({ visible: true }).count(), 0);
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    await field(page, 'face').fill('2');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
});

test('what an edit would make is asked again when another client has edited', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await choose(page, 'face_poke');
    await field(page, 'face').fill('2');
    await expectVerdict(page, 'Would make: +1 V +4 E +3 F');
    await post(daemon, `/${mesh}/edits`, { ops: [{ op: 'face_delete', face: 2 }] });
    await waitForFrame(page, { revision: 2 });
    await expectVerdict(page, /Would be refused/);
});

test('only the last of what is typed is tried', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const tried = [];
    page.on('request', (request) => {
        if (request.url().endsWith('/edits')) {
            tried.push(request.postDataJSON().ops[0].face);
        }
    });
    await choose(page, 'face_poke');
    // At once, as no key is: the clock of the page does not go on meanwhile.
    await field(page, 'face').evaluate((input) => {
        for (const text of ['0', '1', '2', '3']) {
            input.value = text;
            input.dispatchEvent(new Event('input', { bubbles: true }));
        }
    });
    await expectVerdict(page, 'Would make');
    assert.deepEqual(tried, [3]);
});

test('what works on all of a large mesh is not tried', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await page.route(`**/v1/meshes/${mesh}`, async (route) => {
        const answer = await route.fetch();
        const summary = await answer.json();
        summary.counts.faces = 100_001;
        await route.fulfill({ json: summary });
    });
    await post(daemon, `/${mesh}/edits`, { ops: [{ op: 'face_poke', face: 1 }] });
    await waitForFrame(page, { revision: 2 });
    await page.locator('#sizes').filter({ hasText: '100,001' }).waitFor();
    const tried = [];
    page.on('request', (request) => {
        if (request.url().endsWith('/edits')) {
            tried.push(request.postDataJSON().ops[0].op);
        }
    });
    await choose(page, 'triangulate');
    // Timers of one length end in the order they began: this one after that of the dry run.
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 300)));
    await choose(page, 'face_poke');
    await field(page, 'face').fill('2');
    await expectVerdict(page, 'Would make');
    assert.deepEqual(tried, ['face_poke']);
});

test('operations are grouped and searched, and a mesh is one of a list', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const { id: other } = await post(daemon, '', { name: 'other', shape: 'torus' });
    const groups = await page.locator('#operation optgroup').evaluateAll((all) =>
        all.map(({ label }) => label),
    );
    assert.deepEqual(groups, ['Vertex', 'Edge', 'Face', 'Loop', 'Mesh']);
    await page.getByRole('searchbox', { name: 'Search operations' }).fill('append');
    assert.ok((await page.locator('#operation option').count()) < 5);
    await choose(page, 'append');
    await field(page, 'mesh').selectOption(other);
    await expectVerdict(page, 'Would make: +');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
    const { counts } = await get(daemon, `/${other}`);
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 6 + counts.faces);
});
