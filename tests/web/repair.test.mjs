// Tests of the dialog that offers repairs for a file that was refused or has defects: it must say
// what is wrong, what each repair does, and leave no mesh behind that the user did not take.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { defectsIn, defectsOf, doneBy, sizesOf } from '../../web/src/meshes/defects.js';
import { checkAccessible, waitForFrame, waitForTold } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openPage } from './visit.mjs';

const WIDTHS = [360, 800, 1440];
const BROKEN_OBJ = `
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
v 1 1 1
f 1 2 3
f 2 1 4
f 1 2 5
f 1 1 2
`;
// Two triangles side by side that share no vertices, and an isolated vertex.
const SEAM_OBJ = `
v 0 0 0
v 1 0 0
v 0 1 0
v 1 0 0
v 0 1 0
v 1 1 0
v 2 2 0
f 1 2 3
f 5 4 6
`;

const upload = (page, name, text) =>
    page.locator('#file').setInputFiles({ name, mimeType: '', buffer: Buffer.from(text) });
const dialog = (page, name = 'broken.obj') => page.getByRole('dialog', { name: `Repair ${name}` });
const outcome = (page, pattern) => page.locator('.outcome').filter({ hasText: pattern });
const take = (page) => page.getByRole('button', { name: 'Import repaired mesh' });
const repair = (page, label) => page.getByRole('dialog').getByLabel(label, { exact: true });
const mend = 'Mend faces that use a vertex twice';
const separate = 'Separate surfaces that only touch';

async function didOf(page, label) {
    const row = page.locator('.field', { has: page.getByLabel(label, { exact: true }) });
    return row.locator('.did').textContent();
}

const namesOf = async (daemon) => (await get(daemon, '')).items.map(({ name }) => name).sort();

// Asks the server until it has meshes with these names only. It fails only by the limit of time
// that the program which runs the tests has.
async function waitForNames(daemon, wanted) {
    while (`${await namesOf(daemon)}` !== `${wanted}`) {
        // The next answer may be another one.
    }
}

async function openOffer(t, options = {}) {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/], ...options });
    await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
    await upload(page, 'broken.obj', BROKEN_OBJ);
    await dialog(page).waitFor();
    return { daemon, page };
}

async function refusalOf(daemon, body) {
    const answer = await fetch(`${daemon.url}/v1/meshes`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(body),
    });
    assert.equal(answer.status, 422);
    return answer.json();
}

test('each defect for which a file is refused is said in plain words', async (t) => {
    const daemon = await startDaemon(t);
    const vertices = Array.from({ length: 8 }, (_, i) => [i % 2, (i >> 1) % 2, i >> 2]);
    const cases = [
        [[[0, 1, 1]], /^1 face uses a vertex twice$/],
        [[[0, 1]], /^1 face has fewer than three corners$/],
        [[[0, 1, 2], [0, 1, 3]], /^1 edge lies between faces that disagree/],
        [[[0, 1, 2], [1, 0, 3], [0, 1, 4]], /^1 edge has more than two faces$/],
        [[[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 5]], /more than two faces|disagree/],
    ];
    for (const [faces, words] of cases) {
        const problem = await refusalOf(daemon, { vertices, faces });
        const found = defectsOf(problem);
        assert.ok(found.some(({ text }) => words.test(text)), `${JSON.stringify(found)}`);
        assert.ok(found.every(({ text }) => !text.includes('_')), JSON.stringify(found));
        assert.ok(found[0].where.length > 0);
    }
    const many = { elements: [{ code: 'orientation', detail: 'a' }], total: 40, detail: 'line 7: x' };
    assert.deepEqual(defectsOf(many), [
        {
            text: '1 edge lies between faces that disagree about which side is out',
            where: ['first at line 7 of the file', 'a'],
            more: 0,
        },
        { text: '39 more places', where: [], more: 0 },
    ]);
    assert.deepEqual(defectsOf({ elements: [], total: 0, detail: 'It is wrong.' }), [
        { text: 'It is wrong.', where: [], more: 0 },
    ]);
});

test('what repairs have done, and what a mesh has, are said in plain words', () => {
    const lines = [1, 2, 3, 4, 5, 6, 7];
    for (const [report, words] of [
        [{ repair: 'weld', count: 0 }, 'nothing to do'],
        [{ repair: 'weld', count: 7, lines }, '7 vertices joined to others (lines 1, 2, 3, 4, 5, 6, \u2026)'],
        [{ repair: 'drop_degenerate', count: 1, mended: 2, lines: [9] }, '1 face removed, 2 faces mended (line 9)'],
        [{ repair: 'drop_duplicates', count: 2 }, '2 faces removed'],
        [{ repair: 'orient', count: 1, not_orientable: 1 }, '1 face turned, 1 part has no inside'],
        [{ repair: 'split', count: 2 }, '2 vertices made'],
        [{ repair: 'fill', count: 1, left: 3 }, '1 hole closed, 3 left open'],
        [{ repair: 'new_one', count: 1 }, '1 change'],
    ]) {
        assert.equal(doneBy(report), words);
    }
    const counts = { vertices: 1234, faces: 1, components: 2, boundary_loops: 1 };
    assert.equal(sizesOf({ counts, closed: false }), '1,234 vertices, 1 face, 2 parts, 1 hole or open border');
    assert.equal(
        sizesOf({ counts: { ...counts, components: 1, boundary_loops: 0 }, closed: true }),
        '1,234 vertices, 1 face, closed',
    );
    const check = { totals: { bowtie: 2, isolated_vertex: 0 }, defects: [{ code: 'bowtie', detail: 'vertex 3 has 2 fans' }] };
    assert.deepEqual(defectsIn({ counts: { boundary_loops: 0 } }, check), [
        {
            code: 'bowtie',
            text: '2 vertices join parts that only touch there',
            where: ['vertex 3 has 2 fans'],
            more: 1,
            mender: 'split',
        },
    ]);
});

test('a refused file is imported with the repairs that were tried', async (t) => {
    const { daemon, page } = await openOffer(t);
    const found = page.locator('.found > li');
    assert.deepEqual(
        await found.locator('summary').allTextContents(),
        ['1 face uses a vertex twice \u2013 where?', '1 edge has more than two faces \u2013 where?'],
    );
    await found.locator('summary').first().click();
    assert.ok(await page.getByText('first at line 10 of the file').isVisible());
    await outcome(page, /7 vertices, 3 faces, 2 parts, 2 holes or open borders/).waitFor();
    assert.ok(await repair(page, mend).isChecked());
    assert.ok(await repair(page, separate).isChecked());
    assert.ok(!(await repair(page, 'Close small holes').isChecked()));
    assert.equal(await didOf(page, mend), '1 face removed (line 10)');
    assert.equal(await didOf(page, separate), '2 vertices made');
    await checkAccessible(page, 'repairs');
    await take(page).click();
    await waitForTold(page, /Read broken\.obj with repairs.*7 vertices, 3 faces/);
    await dialog(page).waitFor({ state: 'detached' });
    const { items } = await get(daemon, '');
    assert.deepEqual(items.map(({ name }) => name), ['broken']);
    assert.deepEqual([items[0].counts.vertices, items[0].counts.faces], [7, 3]);
    await waitForFrame(page, { mesh: items[0].id, revision: 1 });
});

test('each choice is tried anew, and only the last trial is kept', async (t) => {
    const { daemon, page } = await openOffer(t);
    await outcome(page, /3 faces/).waitFor();
    await repair(page, separate).uncheck();
    await outcome(page, /not enough.*edge.*Also needed: Separate surfaces that only touch\.$/).waitFor();
    assert.ok(await take(page).isDisabled());
    assert.equal(await didOf(page, separate), '');
    await checkAccessible(page, 'repairs that are not enough');
    await repair(page, mend).uncheck();
    await outcome(page, /Choose a repair/).waitFor();
    assert.ok(await take(page).isDisabled());
    await waitForNames(daemon, []);
    await repair(page, mend).check();
    await repair(page, separate).check();
    await repair(page, 'Close small holes').check();
    await outcome(page, /4 faces, 2 parts, 1 hole/).waitFor();
    assert.equal(await didOf(page, 'Close small holes'), '1 hole closed, 1 left open');
    const sent = page.waitForRequest(/hole_edges=3&|hole_edges=3$/);
    await page.getByLabel('Most edges of a hole').fill('3');
    await sent;
    await outcome(page, /\d faces/).waitFor();
    await take(page).click();
    await dialog(page).waitFor({ state: 'detached' });
    await waitForNames(daemon, ['broken']);
});

test('who cancels, or leaves the page, leaves no mesh behind', async (t) => {
    const { daemon, page } = await openOffer(t);
    await outcome(page, /3 faces/).waitFor();
    assert.deepEqual(await namesOf(daemon), ['broken']);
    const gone = page.waitForResponse((answer) => answer.request().method() === 'DELETE');
    await page.keyboard.press('Escape');
    assert.equal((await gone).status(), 204);
    assert.deepEqual(await namesOf(daemon), []);
    await upload(page, 'broken.obj', BROKEN_OBJ);
    await outcome(page, /3 faces/).waitFor();
    assert.deepEqual(await namesOf(daemon), ['broken']);
    await page.goto(`${daemon.url}/docs`);
    await waitForNames(daemon, []);
});

test('a mesh of a trial that another client has edited stays', async (t) => {
    const { daemon, page } = await openOffer(t, { allowed: [/status of 4(22|12)/] });
    await outcome(page, /3 faces/).waitFor();
    const [{ id }] = (await get(daemon, '')).items;
    await post(daemon, `/${id}/edits`, { op: 'face_poke', face: 0 });
    const refused = page.waitForResponse((answer) => answer.request().method() === 'DELETE');
    await page.keyboard.press('Escape');
    assert.equal((await refused).status(), 412);
    assert.deepEqual(await namesOf(daemon), ['broken']);
});

test('several refused files are offered one after another', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    await page.locator('#file').setInputFiles(
        ['one.obj', 'two.obj'].map((name) => ({ name, mimeType: '', buffer: Buffer.from(BROKEN_OBJ) })),
    );
    await dialog(page, 'one.obj').waitFor();
    await outcome(page, /3 faces/).waitFor();
    assert.equal(await page.getByRole('dialog').count(), 1);
    await take(page).click();
    await dialog(page, 'two.obj').waitFor();
    await outcome(page, /3 faces/).waitFor();
    await take(page).click();
    await page.getByRole('dialog').waitFor({ state: 'detached' });
    assert.deepEqual(await namesOf(daemon), ['one', 'two']);
});

test('a file that was read says its defects, and can be replaced by a repaired mesh', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await upload(page, 'seam.obj', SEAM_OBJ);
    const toast = page.locator('.toast').filter({ hasText: 'Read seam.obj' });
    await toast.filter({ hasText: /7 vertices, 2 faces.*1 vertex belongs to no face.*1 edge lies on/ }).waitFor();
    await checkAccessible(page, 'defects');
    const [{ id: first }] = (await get(daemon, '')).items;
    await toast.getByRole('button', { name: 'Repair' }).click();
    await dialog(page, 'seam.obj').waitFor();
    await outcome(page, /5 vertices, 2 faces, 1 hole or open border/).waitFor();
    assert.equal(
        await didOf(page, 'Join vertices in the same place'),
        '2 vertices joined to others (lines 5, 6)',
    );
    await checkAccessible(page, 'repairs of a mesh');
    await page.getByRole('button', { name: 'Use repaired mesh' }).click();
    await waitForTold(page, /Repaired seam\.obj/);
    const { items } = await get(daemon, '');
    assert.equal(items.length, 1);
    assert.notEqual(items[0].id, first);
    assert.equal(items[0].counts.vertices, 5);
    await waitForFrame(page, { mesh: items[0].id, revision: 1 });
});

test('the unrepaired mesh stays if it was edited meanwhile', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 412/] });
    await upload(page, 'seam.obj', SEAM_OBJ);
    await page.locator('.toast').getByRole('button', { name: 'Repair' }).click();
    await outcome(page, /5 vertices/).waitFor();
    const first = (await get(daemon, '')).items.find(({ counts }) => counts.vertices === 7);
    await post(daemon, `/${first.id}/edits`, { op: 'face_poke', face: 0 });
    await page.getByRole('button', { name: 'Use repaired mesh' }).click();
    await waitForTold(page, /Repaired seam\.obj.*stays, too/);
    assert.deepEqual(await namesOf(daemon), ['seam', 'seam']);
});

test('a file without defects is offered no repairs', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    const answer = await post(daemon, '', { name: 'cube', shape: 'cube' });
    const obj = await (await fetch(`${daemon.url}/v1/meshes/${answer.id}/content?format=obj`)).text();
    await upload(page, 'good.obj', obj);
    await waitForTold(page, /Read good\.obj.*8 vertices, 6 faces, closed\./);
    assert.equal(await page.getByRole('button', { name: 'Repair' }).count(), 0);
});

test('what no repair mends is not offered', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    await upload(page, 'broken.obj', 'v 0 0 0\nf 1 2 3\n');
    await expectToast(page, /line 2/);
    assert.equal(await page.getByRole('dialog').count(), 0);
});

test('repairs are chosen by keyboard at each width, and the buttons are always seen', async (t) => {
    for (const width of WIDTHS) {
        const { daemon, page } = await openOffer(t, { viewport: { width, height: 640 } });
        await outcome(page, /3 faces/).waitFor();
        const box = await dialog(page).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width && box.height <= 640, `${width}`);
        const button = await take(page).boundingBox();
        assert.ok(button.y + button.height <= 640, `the button is at ${button.y} of ${width}`);
        assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Repair broken.obj');
        await checkAccessible(page, `repairs at ${width}`);
        await repair(page, 'Close small holes').focus();
        await page.keyboard.press('Space');
        await outcome(page, /4 faces/).waitFor();
        await page.keyboard.press('Enter');
        await dialog(page).waitFor({ state: 'detached' });
        assert.deepEqual(await namesOf(daemon), ['broken']);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} px at ${width}`);
    }
});
