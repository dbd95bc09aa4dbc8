// Tests of the panels around the view: they must show what the server says about a mesh, and send
// what the user puts into a form.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { chooseOperation, fillVector, goTo, isEdit, press, setMode } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
// Two triangles that share only a vertex, and an isolated vertex.
const BOW_TIE = {
    name: 'bow-tie',
    vertices: [[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [-1, 0, 0], [-0.5, -1, 0], [0, 0, 1]],
    faces: [[0, 1, 2], [0, 3, 4]],
};

function statistics(page) {
    return page.locator('[data-statistic]').evaluateAll((all) =>
        Object.fromEntries(all.map((dd) => [dd.dataset.statistic, dd.textContent])),
    );
}

test('every statistic is what the summary says', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, BOW_TIE);
    const summary = await get(daemon, `/${mesh}`);
    assert.equal(summary.manifold, false);
    assert.deepEqual(await statistics(page), {
        vertices: '6',
        edges: '6',
        faces: '2',
        euler: `${summary.euler}`,
        genus: 'none, because parts of the mesh touch only at a vertex (a bow-tie)',
        components: `${summary.counts.components}`,
        boundary_loops: `${summary.counts.boundary_loops}`,
        isolated_vertices: '1',
        closed: 'no',
        manifold: 'no',
        degrees: '2 \u00d7 3',
        area: `${summary.area}`,
        volume: 'not closed',
        revision: '1',
    });
    await checkAccessible(page, 'bow-tie');
    const { id: torus } = await post(daemon, '', { shape: 'torus', name: 'torus' });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator(`#meshes button[data-mesh="${torus}"]`).click();
    await waitForFrame(page, { mesh: torus, revision: 1 });
    const whole = await get(daemon, `/${torus}`);
    const shown = await statistics(page);
    assert.equal(shown.genus, '1');
    assert.equal(shown.closed, 'yes');
    assert.equal(shown.degrees, `${whole.counts.faces} \u00d7 4`);
    assert.equal(shown.volume, `${Number(whole.volume.toPrecision(6))}`);
});

test('the genus says of what it is the genus', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const shown = async () => (await statistics(page)).genus;
    assert.equal(await shown(), '0');
    const { id: torus } = await post(daemon, '', { shape: 'torus' });
    await post(daemon, `/${mesh}/edits`, { op: 'append', mesh: torus });
    await waitForFrame(page, { revision: 2 });
    assert.equal(await shown(), '1, the sum of 2 components');
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: 0 });
    await waitForFrame(page, { revision: 3 });
    assert.equal(await shown(), '1, the sum of 2 components, as if the 1 hole were filled');
    assert.equal((await get(daemon, `/${mesh}`)).genus, 1);
});

test('measures are rounded for the eye, and whole in their titles', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'icosphere', subdivisions: 1 });
    await goTo(page, 'face', 3);
    const { centroid, area } = await get(daemon, `/${mesh}/faces/3`);
    const spans = page.locator('[data-member="centroid"] span');
    assert.deepEqual(
        await spans.allTextContents(),
        centroid.map((value) => `${Number(value.toPrecision(5))}`),
    );
    assert.equal(await spans.first().getAttribute('title'), `${centroid[0]}`);
    const [shown] = await page.locator('[data-member="area"] span').allTextContents();
    assert.ok(shown.length < 9 && Math.abs(Number(shown) - area) < 1e-5, shown);
});

// Presses the form's button Apply, and returns the operation that the page has sent.
async function apply(page) {
    const sent = page.waitForRequest(isEdit);
    await page.getByRole('button', { name: 'Apply' }).click();
    const { ops } = (await sent).postDataJSON();
    assert.equal(ops.length, 1);
    return ops[0];
}

test('a field that is left empty is left out, whatever its type', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    const choose = (name) => chooseOperation(page, name);
    const fill = (name, text) => page.locator(`#param-${name}`).fill(text);
    await choose('plane_split');
    await fillVector(page, 'point', [0, 0, 0.25]);
    await fillVector(page, 'normal', [0, 0, 1]);
    const tolerance = page.locator('#param-tolerance');
    assert.equal(await tolerance.getAttribute('placeholder'), 'default');
    assert.deepEqual(await apply(page), {
        op: 'plane_split',
        point: [0, 0, 0.25],
        normal: [0, 0, 1],
    });
    await waitForFrame(page, { revision: 2 });
    await fillVector(page, 'point', [0, 0, -0.25]);
    await fill('tolerance', ' 1e-3 ');
    assert.equal((await apply(page)).tolerance, 1e-3);
    await waitForFrame(page, { revision: 3 });
    await choose('edge_collapse');
    await fill('edge', '0');
    assert.deepEqual(await apply(page), { op: 'edge_collapse', edge: 0 });
    await waitForFrame(page, { revision: 4 });
    // Text that the user typed must stay as long as the selection is the same.
    assert.equal(await page.locator('#param-edge').inputValue(), '0');
    await choose('face_poke');
    await fill('face', '0');
    assert.deepEqual(await apply(page), { op: 'face_poke', face: 0 });
});

test('flags, choices, lists and no element at all are sent as such', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    const choose = (name) => chooseOperation(page, name);
    const fill = (name, text) => page.locator(`#param-${name}`).fill(text);
    await choose('face_delete');
    await fill('face', '0, 1; 2');
    await page.locator('#param-keep_isolated').check();
    const deleted = { op: 'face_delete', faces: [0, 1, 2], keep_isolated: true };
    assert.deepEqual(await apply(page), deleted);
    await waitForFrame(page, { revision: 2 });
    await choose('hole_fill');
    await fill('halfedge', '1');
    await page.locator('#param-method').selectOption('fan');
    assert.deepEqual(await apply(page), { op: 'hole_fill', halfedge: 1, method: 'fan' });
    await choose('vertex_split');
    await fill('vertex', '7');
    await fill('left', 'none');
    await fill('right', '3');
    await fillVector(page, 'to', [1, 1, 1]);
    assert.deepEqual(await apply(page), {
        op: 'vertex_split',
        vertex: 7,
        left: null,
        right: 3,
        to: [1, 1, 1],
    });
    await choose('face_add');
    await fill('vertices', '0 1 2');
    assert.deepEqual(await apply(page), { op: 'face_add', vertices: [0, 1, 2] });
    await choose('compact');
    assert.deepEqual(await apply(page), { op: 'compact' });
});

test('what only looks like a number is said', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    for (const [operation, name, text, words] of [
        ['edge_split', 'edge', '0x10', /0x10.*not a number/],
        ['edge_split', 'edge', '1 x', /x.*not a number/],
        ['edge_split', 'edge', '1e999', /not a number/],
    ]) {
        await chooseOperation(page, operation);
        await page.locator(`#param-${name}`).fill(text);
        await page.getByRole('button', { name: 'Apply' }).click();
        await page.locator(`[data-name="${name}"] + #verdict`).filter({ hasText: words }).waitFor();
    }
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
});

test('a list longer than a page is read on by a button', async (t) => {
    const daemon = await startDaemon(t);
    for (let i = 0; i < 203; i++) {
        const vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
        await post(daemon, '', { name: `mesh ${i}`, vertices, faces: [[0, 1, 2]] });
    }
    const page = await openPage(t, daemon);
    const rows = page.locator('#meshes li');
    await rows.nth(199).waitFor();
    assert.equal(await rows.count(), 200);
    const more = page.getByRole('button', { name: 'Show more' });
    await checkAccessible(page, 'long list');
    await more.click();
    await rows.nth(202).waitFor();
    assert.ok(await more.isHidden());
    assert.equal(new Set(await page.locator('.mesh-name').allTextContents()).size, 203);
});

test('the manual is one click away, and the viewer one click back', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await page.getByRole('link', { name: 'Manual' }).click();
    await page.waitForURL(`${daemon.url}/docs`);
    await page.getByRole('heading', { level: 1 }).waitFor();
    await page.getByRole('link', { name: 'Viewer', exact: true }).click();
    await waitForFrame(page, { mesh, revision: 1 });
    await fetch(`${daemon.url}/v1/meshes/${mesh}`, { method: 'DELETE' });
    await page.goto(`${daemon.url}/`);
    await page.getByRole('link', { name: 'manual', exact: true }).click();
    await page.waitForURL(`${daemon.url}/docs/routes/create_mesh`);
    await page.getByRole('heading', { level: 1 }).waitFor();
});

test('the page is dark if the system is, its controls too', async (t) => {
    const { page } = await openMesh(t, CUBE, { colorScheme: 'dark' });
    await setMode(page, 'Edge');
    const dark = await page.evaluate(() => {
        const brightest = (colour) => Math.max(...colour.match(/\d+/g).slice(0, 3).map(Number));
        const style = (selector) => getComputedStyle(document.querySelector(selector));
        return {
            scheme: style('html').colorScheme,
            grounds: ['body', '.bar', '.meshes', '#details', 'select', 'button'].map((selector) =>
                brightest(style(selector).backgroundColor),
            ),
            text: brightest(style('body').color),
        };
    });
    assert.equal(dark.scheme, 'light dark');
    assert.ok(dark.grounds.every((ground) => ground < 64), `${dark.grounds}`);
    assert.ok(dark.text > 200);
});

test('each pick mode and the hint for dropping are accessible', async (t) => {
    const { page } = await openMesh(t, BOW_TIE);
    const modes = { Edge: 'edge', Vertex: 'vertex', 'Half-edge': 'halfedge' };
    for (const [mode, kind] of Object.entries(modes)) {
        await setMode(page, mode);
        await goTo(page, kind, 1);
        await checkAccessible(page, mode);
    }
    const transfer = await page.evaluateHandle(() => {
        const files = new DataTransfer();
        files.items.add(new File(['x'], 'a.obj'));
        return files;
    });
    await page.dispatchEvent('body', 'dragenter', { dataTransfer: transfer });
    assert.ok(await page.getByText('Drop to upload').isVisible());
    await checkAccessible(page, 'dropping');
});

test('on a telephone the mesh is on the first screen, and the help fits', async (t) => {
    const { page } = await openMesh(t, CUBE, {
        viewport: { width: 360, height: 740 },
        hasTouch: true,
        isMobile: true,
    });
    const canvas = await page.locator('#canvas').boundingBox();
    assert.ok(canvas.y < 300 && canvas.y + 300 < 740, JSON.stringify(canvas));
    for (const button of await page.getByRole('button').all()) {
        const { height } = await button.boundingBox();
        assert.ok(height >= 32, `${await button.textContent()} is ${height} px high`);
    }
    await press(page, '?');
    const help = await page.getByRole('dialog').boundingBox();
    assert.ok(help.x >= 0 && help.x + help.width <= 360 && help.height <= 740);
    await checkAccessible(page, 'help on a telephone');
});

test('buttons leave room around their words', async (t) => {
    for (const width of [375, 1280]) {
        const { page } = await openMesh(t, CUBE, { viewport: { width, height: 800 } });
        const tight = await page.locator('#details button:visible').evaluateAll((buttons) =>
            buttons.flatMap((button) => {
                const range = document.createRange();
                range.selectNodeContents(button);
                const room = button.clientWidth - range.getBoundingClientRect().width;
                return room < 6 ? [`${button.textContent}: ${room}`] : [];
            }),
        );
        assert.deepEqual(tight, []);
    }
});
