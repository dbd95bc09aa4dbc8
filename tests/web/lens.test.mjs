// Tests of the check lens: findings, boundary loops and components are listed, shown in the view and
// mended on the spot, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { mendsOfDefect } from '../../web/src/lens/mends.js';
import { checkAccessible, isChosen, readCanvas, waitForFrame } from './browser.mjs';
import { get, post } from './daemon.mjs';
import { cameraOf, expectToast, isEdit, press } from './page.mjs';
import { openMesh } from './visit.mjs';

// A grid of 10 x 10 squares whose rim and three holes are boundary loops: of 40, 4, 6 and 8 edges.
const GRID = { shape: 'grid', columns: 10, rows: 10 };
const HOLES = [[11], [14, 15], [62, 63, 64]];

// Two tetrahedra without a face that share vertex 0 (a bow-tie), an isolated vertex, and a tiny
// tetrahedron, inside out, of which one vertex lies where vertex 1 does.
const tetrahedron = (a, b, c, d) => [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
const DEFECTS = {
    name: 'defects',
    vertices: [
        [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1],
        [-1, 0, 0], [0, -1, 0], [0, 0, -1],
        [0.5, 2, 0.5],
        [1, 0, 0], [1.005, 0, 0], [1, 0.005, 0], [1, 0, 0.005],
    ],
    faces: [
        ...tetrahedron(0, 1, 2, 3).slice(1),
        ...tetrahedron(0, 5, 4, 6).slice(1),
        ...tetrahedron(8, 9, 10, 11).map((corners) => corners.reverse()),
    ],
};

async function openGrid(t, options) {
    const context = await openMesh(t, GRID, options);
    const { daemon, mesh, page } = context;
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces: HOLES.flat() });
    await waitForFrame(page, { revision: 2 });
    return context;
}

const check = (page) => page.getByRole('button', { name: 'Check', exact: true }).click();
const group = (page, name) => page.locator(`.lens-group[data-group="${name}"]`);
const findings = (page, name) => group(page, name).locator('.finding');
const said = (page, pattern) => page.locator('#lens-said').filter({ hasText: pattern }).waitFor();

const texts = (page, name) =>
    findings(page, name).evaluateAll((all) =>
        all.map(({ children: [text] }) => text.textContent),
    );

// Waits until the trial of a mend says what it would do, and returns its button.
async function tried(page, name, pattern = /^Would/) {
    const mend = page.locator('.mend', { has: page.getByRole('button', { name, exact: true }) });
    await mend.locator('p').filter({ hasText: pattern }).waitFor();
    return mend.getByRole('button');
}

test('boundary loops are listed, the longest first, with count and place', async (t) => {
    const { daemon, mesh, page } = await openGrid(t);
    await check(page);
    await said(page, /^No defects, 4 boundary loops, 1 component\.$/);
    assert.equal(await group(page, 'loops').locator('.count').textContent(), '4');
    assert.deepEqual(await texts(page, 'loops'), [
        '40 edges, perimeter 4',
        '8 edges, perimeter 0.8',
        '6 edges, perimeter 0.6',
        '4 edges, perimeter 0.4',
    ]);
    const [, , third] = await findings(page, 'loops').locator('.small').allTextContents();
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    const { vertices } = loops.find(({ length }) => length === 6);
    const points = await Promise.all(vertices.map((id) => get(daemon, `/${mesh}/vertices/${id}`)));
    const place = [0, 1, 2].map((axis) => {
        const values = points.map(({ position }) => position[axis]);
        return (Math.min(...values) + Math.max(...values)) / 2;
    });
    const numbers = third.replace('at ', '').split(', ').map(Number);
    place.forEach((value, axis) => assert.ok(Math.abs(value - numbers[axis]) < 1e-3, third));
    await checkAccessible(page, 'checked');
});

test('a click on a hole flies to it, and fills it after a trial', async (t) => {
    const { daemon, mesh, page } = await openGrid(t);
    await check(page);
    await said(page, /4 boundary loops/);
    const before = await cameraOf(page);
    await findings(page, 'loops').nth(2).click();
    await page.locator('#canvas[data-selection^="halfedge"]').waitFor();
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    const { halfedges } = loops.find(({ length }) => length === 6);
    assert.equal(
        await page.locator('#canvas').getAttribute('data-selection'),
        halfedges.map((id) => `halfedge:${id}`).join(' '),
    );
    assert.notEqual(await cameraOf(page), before);
    // The panel says more about the selected half-edges above the list, which stays in sight.
    const { height } = page.viewportSize();
    const box = await page.locator('.finding[aria-expanded="true"]').boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height <= height, `${JSON.stringify(box)}`);
    assert.ok((await readCanvas(page)).countOf(isChosen) > 500, 'the rim is large in the view');
    // Both ways are tried, and nothing is changed by that.
    await tried(page, 'Fill with triangles', /^Would make: \+3 E \+4 F$/);
    await tried(page, 'Fill smoothly', /^Would make: .*F$/);
    const fill = await tried(page, 'Fill with one face', /^Would make: \+1 F$/);
    assert.equal((await get(daemon, `/${mesh}`)).revision, 2);
    await checkAccessible(page, 'hole open');
    const sent = page.waitForRequest(isEdit);
    await fill.click();
    const { ops } = (await sent).postDataJSON();
    assert.equal(ops[0].op, 'hole_fill');
    await said(page, /^The hole is filled\. No defects, 3 boundary loops, 1 component\.$/);
    assert.deepEqual(await texts(page, 'loops'), [
        '40 edges, perimeter 4',
        '8 edges, perimeter 0.8',
        '4 edges, perimeter 0.4',
    ]);
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 3);
});

test('all holes are filled in one step, which is undone by one', async (t) => {
    const { daemon, mesh, page } = await openGrid(t);
    await check(page);
    await said(page, /4 boundary loops/);
    await group(page, 'loops').getByRole('button', { name: /^Fill all/ }).click();
    const fill = await tried(page, 'Fill them', /^Would make: \+4 F$/);
    await checkAccessible(page, 'fill all');
    await fill.click();
    await said(page, /^The holes are filled\. No defects, no boundary, 1 component\.$/);
    await waitForFrame(page, { revision: 3 });
    assert.equal((await get(daemon, `/${mesh}`)).closed, true);
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await said(page, /4 boundary loops/);
    await waitForFrame(page, { revision: 4 });
});

test('a hole that cannot be filled is left out, and why is said', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, { allowed: [/status of 422/] });
    // Face 55 hangs by one corner in a hole, which therefore passes this corner twice.
    const faces = [44, 45, 46, 54, 56, 64, 65];
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces });
    await waitForFrame(page, { revision: 2 });
    await check(page);
    await said(page, /boundary loops/);
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    const twice = loops.filter(({ vertices }) => new Set(vertices).size < vertices.length);
    assert.equal(twice.length, 1);
    await group(page, 'loops').getByRole('button', { name: /^Fill all/ }).click();
    const fill = await tried(page, 'Fill them', /^Would make: \+1 F\. 1 hole stays open \(touching itself: 1\)\.$/);
    await fill.click();
    await said(page, /^The holes are filled\./);
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 1);
    // The one that is left is refused with the reason, and its button stays off.
    await findings(page, 'loops').first().click();
    const refused = await tried(page, 'Fill with one face', /^Not possible: .+/);
    assert.ok(await refused.isDisabled());
    await checkAccessible(page, 'mend refused', '#lens');
});

test('each defect is listed in words, and mended', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, DEFECTS, { allowed: [/status of 422/] });
    await check(page);
    await said(page, /defects/);
    const report = await get(daemon, `/${mesh}/check`);
    assert.deepEqual(
        Object.fromEntries(Object.entries(report.totals).filter(([, total]) => total > 0)),
        {
            bowtie: 1, isolated_vertex: 1, duplicate_position: 1, small_component: 1,
            inside_out_component: 1,
        },
    );
    for (const { code, detail } of report.defects) {
        const [text] = await texts(page, code);
        assert.equal(text.toLowerCase(), `${detail}.`.toLowerCase());
    }
    await checkAccessible(page, 'defects');
    const mend = async (name, label, words) => {
        await findings(page, name).first().click();
        await (await tried(page, label)).click();
        await said(page, words);
    };
    await mend('bowtie', 'Split the vertex', /^Each fan of faces has a vertex of its own now\./);
    await mend('isolated_vertex', 'Delete the vertex', /^The vertex is deleted\./);
    await mend('inside_out_component', 'Turn it over', /look the other way now\./);
    assert.equal(await group(page, 'inside_out_component').count(), 0);
    await findings(page, 'small_component').first().click();
    await page.locator('#canvas[data-selection^="face:6 "]').waitFor();
    await (await tried(page, 'Delete the component')).click();
    await said(page, /^The component is deleted\./);
    // The vertex that was in the place of another is gone with it; the bow-tie has left two vertices
    // in one place.
    const after = await get(daemon, `/${mesh}/check`);
    assert.equal(after.totals.duplicate_position, 1);
    assert.equal(after.totals.bowtie, 0);
    assert.equal((await get(daemon, `/${mesh}`)).counts.components, 2);
});

test('what lies in one place is welded, and faces that intersect are found on request', async (t) => {
    const square = (z) => [[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]];
    const { daemon, mesh, page } = await openMesh(t, {
        // Two triangles that could share an edge, and two squares that cross.
        vertices: [
            [0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
            ...square(3), [0.5, -1, 2], [0.5, 2, 2], [0.5, 2, 4], [0.5, -1, 4],
        ],
        faces: [[0, 1, 2], [3, 4, 5], [6, 7, 8, 9], [10, 11, 12, 13]],
    });
    await check(page);
    await said(page, /^2 defects, 4 boundary loops, 4 components\.$/);
    assert.equal(await group(page, 'self_intersection').count(), 0);
    await page.getByRole('checkbox', { name: 'Also find faces that intersect' }).check();
    await said(page, /^3 defects/);
    assert.deepEqual(await texts(page, 'self_intersection'), ['Faces 2 and 3 meet.']);
    await findings(page, 'self_intersection').first().click();
    await page.locator('#lens').getByText('There is no way to mend this here.').waitFor();
    await waitForFrame(page, { selection: 'face:3 face:2' });
    await group(page, 'duplicate_position').getByRole('button', { name: /^Weld all/ }).click();
    await (await tried(page, 'Weld them')).click();
    await said(page, /^The vertices are welded\. 1 defect, 3 boundary loops, 3 components\.$/);
    assert.equal((await get(daemon, `/${mesh}`)).counts.vertices, 12);
});

test('the lens is used by keys alone, and the focus goes to the next finding', async (t) => {
    const { page } = await openGrid(t);
    await press(page, 'c');
    await said(page, /4 boundary loops/);
    assert.equal(await page.evaluate(() => document.activeElement.id), 'lens-run');
    const focused = () => page.evaluate(() => document.activeElement.textContent);
    const tabTo = async (pattern) => {
        for (let i = 0; i < 20 && !pattern.test(await focused()); i++) {
            await page.keyboard.press('Tab');
        }
        assert.match(await focused(), pattern);
    };
    await tabTo(/^8 edges/);
    await page.keyboard.press('Enter');
    await tried(page, 'Fill with one face');
    assert.match(await focused(), /^8 edges/);
    const expanded = page.locator('.finding[aria-expanded="true"]');
    assert.equal(await expanded.count(), 1);
    await tabTo(/Fill with one face/);
    await page.keyboard.press('Enter');
    await said(page, /^The hole is filled\./);
    await page.waitForFunction(() => /^6 edges/.test(document.activeElement.textContent));
});

test('the list follows the mesh, and is empty for another one', async (t) => {
    const { daemon, mesh, page } = await openGrid(t);
    await check(page);
    await said(page, /4 boundary loops/);
    await findings(page, 'loops').nth(1).click();
    await tried(page, 'Fill with one face');
    // Another client fills the hole of 4 edges: what is open stays open.
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    const { halfedge } = loops.find(({ length }) => length === 4);
    await post(daemon, `/${mesh}/edits`, { op: 'hole_fill', halfedge });
    await said(page, /3 boundary loops/);
    assert.match(await page.locator('.finding[aria-expanded="true"]').textContent(), /8 edges/);
    await tried(page, 'Fill with one face');
    const { id: other } = await post(daemon, '', { shape: 'cube', name: 'cube' });
    await page.evaluate((id) => {
        window.location.hash = `#mesh=${id}`;
    }, other);
    await waitForFrame(page, { mesh: other });
    assert.equal(await page.locator('.lens-group').count(), 0);
    assert.equal(await page.locator('#lens-said').textContent(), '');
    await check(page);
    await said(page, /^No defects, no boundary, 1 component\.$/);
});

test('a check that fails is said, and may be made again', async (t) => {
    const { page } = await openGrid(t, { allowed: [/status of 500/] });
    const problem = { status: 500, title: 'No', detail: 'It broke.' };
    await page.route('**/check', (route) => route.fulfill({ status: 500, json: problem }));
    await check(page);
    await expectToast(page, /It broke/);
    await page.unroute('**/check');
    await page.getByRole('button', { name: 'Check the mesh' }).click();
    await said(page, /4 boundary loops/);
});

test('many findings are shown in portions, and many loops filled at once', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'grid', columns: 40, rows: 40 });
    const faces = [];
    for (let row = 1; row < 39; row += 2) {
        for (let column = 1; column < 39; column += 2) {
            faces.push(40 * row + column);
        }
    }
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces });
    await waitForFrame(page, { revision: 2 });
    await check(page);
    await said(page, /362 boundary loops/);
    const loops = group(page, 'loops');
    await loops.locator('summary').click();
    assert.equal(await findings(page, 'loops').count(), 50);
    await loops.getByRole('button', { name: 'Show more' }).click();
    assert.equal(await findings(page, 'loops').count(), 100);
    await checkAccessible(page, 'many findings', '#lens');
    await loops.getByRole('button', { name: /^Fill all/ }).click();
    await (await tried(page, 'Fill them', /^Would make: \+362 F$/)).click();
    await said(page, /no boundary/);
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 0);
});

test('a face without area is mended as its shape asks', async () => {
    const face = { id: 3, degree: 3, halfedges: [0, 2, 4], vertices: [0, 1, 2] };
    const ways = (lengths, element = face) =>
        Promise.all(
            mendsOfDefect({ code: 'degenerate_face', id: 3 }, element, lengths).map(
                async ({ make }) => (await make())[0],
            ),
        );
    const dropped = { op: 'face_delete', faces: [3] };
    assert.deepEqual(await ways([1, 1e-6, 1]), [{ op: 'edge_collapse', edge: 1 }, dropped]);
    assert.deepEqual(await ways([0.5, 0.5, 1]), [{ op: 'edge_flip', edge: 2 }, dropped]);
    // A polygon has no edge whose flip would help, and a defect of a later server no known cure.
    const square = { ...face, degree: 4, halfedges: [0, 2, 4, 6] };
    assert.deepEqual(await ways([1, 1, 1, 1], square), [dropped]);
    assert.deepEqual(mendsOfDefect({ code: 'frayed', id: 3 }, undefined, []), []);
});
