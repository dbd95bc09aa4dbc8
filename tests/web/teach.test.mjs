// Tests of what the page teaches: operations step by step, and examples with a guide.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { EXAMPLES, turnAround } from '../../web/src/teach/examples.js';
import { nextFlip } from '../../web/src/teach/flips.js';
import { checkAccessible, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { chooseOperation, goTo } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const GRID = { name: 'grid', shape: 'grid', columns: 3, rows: 3 };
const WIDTHS = [360, 1280];

const lesson = (page) => page.getByRole('dialog', { name: /step by step/ });
const guide = (page) => page.getByRole('region', { name: / of \d/ });

async function openLesson(page) {
    await page.getByRole('button', { name: 'Show step by step' }).click();
    await lesson(page).waitFor();
}

// Returns the number of steps that the title of the shown step says.
async function stepsOf(page) {
    const text = await lesson(page).getByRole('heading', { level: 3 }).textContent();
    return text.match(/^(\d+) of (\d+): (.*)$/).slice(1);
}

test('an operation is shown step by step on the mesh, which stays as it was until it is applied', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await goTo(page, 'edge', 5);
    await chooseOperation(page, 'edge_split');
    await openLesson(page);
    const [at, count, title] = await stepsOf(page);
    assert.deepEqual([at, title], ['1', 'Before']);
    const before = await lesson(page).locator('.halfedge').count();
    await lesson(page).getByRole('button', { name: 'Next' }).click();
    assert.deepEqual(await stepsOf(page), ['2', count, 'Vertex 16 made']);
    const cells = async (row) =>
        lesson(page).locator('tr').filter({ has: page.getByRole('rowheader', { name: row }) }).locator('td').allTextContents();
    assert.deepEqual(await cells('Before'), ['16', '24', '9', '1']);
    assert.deepEqual(await cells('Now'), ['17', '24', '9', '2']);
    assert.deepEqual(await cells('Change'), ['+1', '+3', '+2', '0']);
    // Links are drawn where a step changes them.
    await lesson(page).getByRole('slider', { name: 'Step' }).fill(`${Number(count) - 4}`);
    assert.match((await stepsOf(page))[2], /^(Next of half-edge|The loop of face) \d+$/);
    await lesson(page).getByRole('slider', { name: 'Step' }).press('End');
    assert.deepEqual(await stepsOf(page), [count, count, 'After']);
    assert.ok(await lesson(page).getByRole('button', { name: 'Next' }).isDisabled());
    await page.waitForFunction((least) => document.querySelectorAll('.lesson .halfedge').length > least, before);
    // The copy on which the operation was tried is gone, and the mesh is as it was.
    assert.deepEqual((await get(daemon, '')).items.map(({ id }) => id), [mesh]);
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    await lesson(page).getByRole('button', { name: 'Apply to the mesh' }).click();
    await waitForFrame(page, { mesh, revision: 2 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.vertices, 17);
});

test('steps are played, and the last one is not passed', async (t) => {
    const { page } = await openMesh(t, { name: 'cube', shape: 'cube' });
    await page.clock.install();
    await goTo(page, 'face', 0);
    await chooseOperation(page, 'face_poke');
    await page.clock.runFor(1000);
    await openLesson(page);
    await lesson(page).getByRole('button', { name: 'Play' }).click();
    const [, count] = await stepsOf(page);
    await page.clock.runFor(2500);
    assert.equal((await stepsOf(page))[0], '2');
    await lesson(page).getByRole('button', { name: 'Pause' }).click();
    await page.clock.runFor(60_000);
    assert.equal((await stepsOf(page))[0], '2');
    await lesson(page).getByRole('button', { name: 'Play' }).click();
    await page.clock.runFor(200_000);
    assert.equal((await stepsOf(page))[0], count);
    await lesson(page).getByRole('button', { name: 'Play' }).waitFor();
});

test('only what is possible and not too large is shown', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, { allowed: [/status of 4\d\d/] });
    await chooseOperation(page, 'edge_split');
    const open = page.getByRole('button', { name: 'Show step by step' });
    assert.ok(await open.isDisabled());
    await page.locator('#param-edge').fill('99');
    await page.locator('#verdict.refused').waitFor();
    assert.ok(await open.isDisabled());
    await chooseOperation(page, 'subdivide');
    await page.locator('#verdict').filter({ hasText: 'Would' }).waitFor();
    await open.click();
    await page.getByRole('alert').filter({ hasText: 'at most 60 edges' }).waitFor();
    assert.deepEqual((await get(daemon, '')).items.map(({ id }) => id), [mesh]);
});

test('steps are read by keyboard at each width, and fit', async (t) => {
    for (const width of WIDTHS) {
        const { page } = await openMesh(t, GRID, { viewport: { width, height: 740 } });
        await goTo(page, 'edge', 5);
        await chooseOperation(page, 'edge_collapse');
        await openLesson(page);
        await page.keyboard.press('Enter');
        assert.equal((await stepsOf(page))[0], '2', `${width}`);
        const box = await lesson(page).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width && box.y >= 0 && box.y + box.height <= 740);
        await checkAccessible(page, `step by step, ${width} wide`);
        await page.keyboard.press('Escape');
        await lesson(page).waitFor({ state: 'detached' });
    }
});

// Goes through an example by its buttons. `check(page, mesh, step)` is called at each step.
async function follow(t, title, check = async () => {}) {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.getByRole('button', { name: 'Examples' }).click();
    await page.getByRole('dialog', { name: 'Examples with a guide' }).getByRole('button', { name: title }).click();
    await guide(page).waitFor();
    const { items } = await get(daemon, '');
    const mesh = items[0].id;
    const next = guide(page).getByRole('button', { name: /^Next/ });
    const heading = guide(page).getByRole('heading');
    for (let step = 1, presses = 0; ; presses += 1) {
        assert.ok(presses < 60, 'the example does not end');
        await check(page, mesh, step, daemon);
        if (await next.isHidden()) {
            break;
        }
        const { revision } = await get(daemon, `/${mesh}`);
        await next.click();
        await page.locator('#guide-next:not([disabled])').waitFor({ state: 'attached' });
        step = Number(/: (\d+) of/.exec(await heading.textContent())[1]);
        assert.ok((await get(daemon, `/${mesh}`)).revision >= revision);
    }
    return { daemon, mesh, page };
}

test('a sheet is folded, and keeps its links', async (t) => {
    const { daemon, mesh } = await follow(t, 'Fold a sheet');
    const { bbox, counts, area } = await get(daemon, `/${mesh}`);
    assert.ok(bbox.max[2] > 1 && bbox.min[2] > -1e-12, JSON.stringify(bbox));
    assert.equal(counts.components, 1);
    // Folding keeps all lengths, so it keeps the area.
    assert.ok(Math.abs(area - 12) < 1e-9, `${area}`);
});

test('a board gets bow-ties, the check lists them, and they are parted', async (t) => {
    const { daemon, mesh, page } = await follow(t, 'A chessboard', async (page, mesh, step, daemon) => {
        if (step === 4) {
            const { totals } = await get(daemon, `/${mesh}/check`);
            assert.equal(totals.bowtie, 25);
        }
    });
    assert.equal((await get(daemon, `/${mesh}/check`)).totals.bowtie, 0);
    assert.equal((await get(daemon, `/${mesh}`)).counts.components, 18);
    await guide(page).getByRole('button', { name: 'End the guide' }).click();
    assert.equal(await guide(page).count(), 0);
});

test('flips spread until the triangulation is Delaunay', async (t) => {
    const { daemon, mesh } = await follow(t, 'Flips that spread');
    const { revision, counts } = await get(daemon, `/${mesh}`);
    assert.ok(revision > 5, `${revision} revisions`);
    assert.equal(counts.faces, 10);
    // The server's own operation agrees that no flip is left.
    const { results } = await post(daemon, `/${mesh}/edits`, { dry_run: true, ops: [{ op: 'delaunay' }] });
    assert.equal(results[0].flips, 0);
});

test('a progressive mesh is played', async (t) => {
    const { page } = await follow(t, 'A progressive mesh');
    await page.locator('#levels').waitFor();
    await checkAccessible(page, 'guide and levels');
});

// On a telephone the button is in a menu.
async function openExamples(page) {
    const menu = page.getByRole('button', { name: 'Examples, manual and keys' });
    if (await menu.isVisible()) {
        await menu.click();
        await page.getByRole('menuitem', { name: 'Examples' }).click();
    } else {
        await page.getByRole('button', { name: 'Examples', exact: true }).click();
    }
}

test('the guide ends when another mesh is opened, and fits each width', async (t) => {
    for (const width of WIDTHS) {
        const daemon = await startDaemon(t);
        const { id: other } = await post(daemon, '', GRID);
        const page = await openPage(t, daemon, { viewport: { width, height: 740 } });
        await waitForFrame(page, { mesh: other, revision: 1 });
        await openExamples(page);
        await checkAccessible(page, `examples, ${width} wide`);
        await page.getByRole('button', { name: EXAMPLES[0].title }).click();
        await guide(page).waitFor();
        const box = await page.locator('#guide').boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width, JSON.stringify(box));
        await checkAccessible(page, `guide, ${width} wide`);
        await page.locator(`#meshes button[data-mesh="${other}"]`).click();
        await waitForFrame(page, { mesh: other, revision: 1 });
        assert.ok(await page.locator('#guide').isHidden());
    }
});

test('turning around an axis keeps its points', () => {
    const matrix = turnAround([1, 2, 3], [0, 0, 2], 90);
    const turned = (point) =>
        [0, 1, 2].map((row) =>
            [...point, 1].reduce((sum, value, i) => sum + value * matrix[4 * row + i], 0),
        );
    const isNear = (a, b) => a.forEach((value, i) => assert.ok(Math.abs(value - b[i]) < 1e-12, `${a} ${b}`));
    isNear(turned([1, 2, 9]), [1, 2, 9]);
    isNear(turned([2, 2, 3]), [1, 3, 3]);
});

test('an edge is flipped only if the circle of one triangle contains the far corner', () => {
    const mesh = (top) => ({
        points: new Map([[0, [-1, 0, 0]], [1, [1, 0, 0]], [2, [0, top, 0]], [3, [0, -top, 0]]]),
        faces: new Map([[0, [0, 1, 2]], [1, [1, 0, 3]]]),
        edges: new Map([[4, { vertices: [0, 1], faces: [0, 1] }], [5, { vertices: [1, 2], faces: [0, null] }]]),
    });
    assert.deepEqual(nextFlip(mesh(0.9)), [{ op: 'edge_flip', edge: 4 }]);
    assert.equal(nextFlip(mesh(1)), null);
    assert.equal(nextFlip(mesh(1.1)), null);
});

test('words are explained where they stand', async (t) => {
    for (const width of WIDTHS) {
        const { page } = await openMesh(t, GRID, { viewport: { width, height: 740 } });
        await goTo(page, 'halfedge', 4);
        const word = page.locator('#members').getByRole('button', { name: 'twin', exact: true });
        await word.focus();
        await page.keyboard.press('Enter');
        const meaning = page.locator('.meaning');
        await meaning.filter({ hasText: 'other half-edge of the same edge' }).waitFor();
        assert.equal(await word.getAttribute('aria-expanded'), 'true');
        const box = await meaning.boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width, JSON.stringify(box));
        await checkAccessible(page, `a word, ${width} wide`);
        await page.keyboard.press('Escape');
        await meaning.waitFor({ state: 'detached' });
        await page.locator('#around').getByRole('button', { name: 'ring', exact: true }).click();
        await meaning.filter({ hasText: 'leave the same vertex' }).waitFor();
        await page.locator('#around').getByRole('button', { name: 'loop', exact: true }).click();
        await meaning.filter({ hasText: 'around one face or one hole' }).waitFor();
        assert.equal(await meaning.count(), 1);
    }
});
