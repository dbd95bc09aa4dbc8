// Tests in Chromium, with the real daemon, that the page shows what the API answers.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible,
    isBackground,
    isChosen,
    isSurface,
    projector,
    readCanvas,
    waitForFrame,
} from './browser.mjs';
import { get, getAll, post, startDaemon } from './daemon.mjs';
import { checkInspector, click, expectToast, isEdit, setMode } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const SQUARE = {
    name: 'square',
    vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
    faces: [[0, 1, 2, 3]],
};
const PRISM_OBJ = `
v 0 0 0
v 2 0 0
v 0 2 0
v 0 0 1
v 2 0 1
v 0 2 1
f 1 3 2
f 4 5 6
f 1 2 5 4
f 2 3 6 5
f 3 1 4 6
`;

async function checkStatistics({ daemon, mesh, page }) {
    const summary = await get(daemon, `/${mesh}`);
    await waitForFrame(page, { mesh, revision: summary.revision });
    for (const kind of ['vertices', 'edges', 'faces']) {
        const shown = await page.locator(`[data-statistic="${kind}"]`).textContent();
        assert.equal(shown.replaceAll(',', ''), `${summary.counts[kind]}`, kind);
    }
    const euler = await page.locator('[data-statistic="euler"]').textContent();
    assert.equal(euler, `${summary.euler}`);
    return summary;
}

test('the page comes with its policy, its licences, and nothing inline', async (t) => {
    const daemon = await startDaemon(t);
    const answer = await fetch(`${daemon.url}/`);
    const html = await answer.text();
    const policy = answer.headers.get('content-security-policy');
    assert.match(policy, /default-src 'none'; script-src 'self'; style-src 'self'/);
    assert.match(policy, /require-trusted-types-for 'script'/);
    assert.doesNotMatch(html, /<style|style=|\son\w+=|<script(?![^>]*\ssrc=)/i);
    const assets = [...html.matchAll(/(?:src|href)="(assets\/[^"]+)"/g)].map(([, name]) => name);
    assert.ok(assets.length >= 3);
    for (const name of assets.filter((asset) => asset !== 'assets/LICENSES.txt')) {
        assert.match(name, /-[A-Z0-9]{8}\.(js|css|svg)$/);
        const asset = await fetch(`${daemon.url}/${name}`);
        assert.equal(asset.status, 200, name);
        assert.match(asset.headers.get('cache-control'), /immutable/, name);
    }
    const licences = await (await fetch(`${daemon.url}/assets/LICENSES.txt`)).text();
    assert.match(licences, /three 0\.187/);
});

test('without meshes the page says what to do', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
    assert.equal(await page.locator('#meshes li').count(), 0);
    for (const name of ['Split', 'Undo', 'Redo', 'Fit view']) {
        assert.ok(await page.getByRole('button', { name }).isDisabled(), name);
    }
    await checkAccessible(page, 'empty');
});

test('the list shows all meshes and opens the one that is clicked', async (t) => {
    const daemon = await startDaemon(t);
    const names = ['one', 'two', 'three', '<img src=x onerror="document.title=1">'];
    for (const name of names) {
        await post(daemon, '', { name, shape: name === 'two' ? 'torus' : 'cube' });
    }
    const page = await openPage(t, daemon);
    const { items } = await get(daemon, '?sort=modified');
    await waitForFrame(page, { mesh: items[0].id, revision: 1 });
    assert.deepEqual(
        await page.locator('.mesh-name').allTextContents(),
        items.map(({ name }) => name),
    );
    for (const { id, name } of items) {
        await page.locator(`#meshes button[data-mesh="${id}"]`).click();
        await checkStatistics({ daemon, mesh: id, page });
        assert.equal(await page.locator('#mesh-title').textContent(), name);
        assert.equal(await page.title(), `${name} \u2013 hedge`);
        assert.equal(await page.locator('[aria-current="true"] .mesh-name').textContent(), name);
    }
    assert.equal(await page.locator('img:not(h1 img)').count(), 0);
    await checkAccessible(page, 'open');
});

test('a file is uploaded by the button, with its progress', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    let release;
    const held = new Promise((resolve) => {
        release = resolve;
    });
    let sent;
    await page.route('**/v1/meshes?name=*', async (route) => {
        sent = route.request();
        await held;
        await route.continue();
    });
    await page.locator('#file').setInputFiles({
        name: 'my prism.obj',
        mimeType: '',
        buffer: Buffer.from(PRISM_OBJ),
    });
    await page.getByText('my prism.obj').waitFor();
    assert.ok(await page.locator('#upload-progress').isVisible());
    await checkAccessible(page, 'uploading');
    release();
    await page.locator('#canvas[data-revision="1"]').waitFor();
    assert.equal(sent.headers()['content-type'], 'model/obj');
    assert.ok(await page.locator('#upload-progress').isHidden());
    const { items } = await get(daemon, '');
    assert.equal(items.length, 1);
    assert.equal(items[0].name, 'my prism');
    const { counts } = await checkStatistics({ daemon, mesh: items[0].id, page });
    assert.deepEqual([counts.vertices, counts.edges, counts.faces], [6, 9, 5]);
});

test('files are uploaded by dropping them, one after another', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
    const transfer = await page.evaluateHandle((text) => {
        const files = new DataTransfer();
        files.items.add(new File([text], 'a.obj'));
        files.items.add(new File(['OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'], 'b.OFF'));
        return files;
    }, PRISM_OBJ);
    await page.dispatchEvent('body', 'dragenter', { dataTransfer: transfer });
    assert.ok(await page.getByText('Drop to upload').isVisible());
    await page.dispatchEvent('body', 'dragleave', { dataTransfer: transfer });
    assert.ok(await page.getByText('Drop to upload').isHidden());
    await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
    await page.locator('#mesh-title').filter({ hasText: /^b$/ }).waitFor();
    const { items } = await get(daemon, '');
    assert.deepEqual(items.map(({ name }) => name).sort(), ['a', 'b']);
    const { id: mesh } = items.find(({ name }) => name === 'b');
    await checkStatistics({ daemon, mesh, page });
});

test('polygons are drawn with their edges and without diagonals', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, SQUARE);
    // A second square beside the first one is added, so that an edge lies inside the surface.
    const { id: other } = await post(daemon, '', {
        name: 'two squares',
        vertices: [[-1, -1, 0], [0, -1, 0], [1, -1, 0], [1, 1, 0], [0, 1, 0], [-1, 1, 0]],
        faces: [[0, 1, 4, 5], [1, 2, 3, 4]],
    });
    const blank = (canvas) => canvas.countOf(isSurface) === 0;
    const square = await readCanvas(page);
    assert.ok(!blank(square));
    assert.ok(square.countOf(isBackground) > square.count / 4);
    const place = await projector(page, daemon, mesh);
    // The square consists of two triangles. Their common side is a diagonal that must not be drawn:
    // all pixels around the middle must have the colour of the surface.
    const { x, y } = place.at([0, 1, 2, 3]);
    const fill = square.colour(x, y);
    assert.ok(isSurface(fill), `${fill}`);
    for (let dx = -6; dx <= 6; dx++) {
        for (let dy = -6; dy <= 6; dy++) {
            const colour = square.colour(x + dx, y + dy);
            colour.forEach((value, i) => {
                assert.ok(Math.abs(value - fill[i]) < 6, `${colour} beside ${fill}`);
            });
        }
    }

    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator('#meshes button').filter({ hasText: 'two squares' }).click();
    await waitForFrame(page, { mesh: other, revision: 1 });
    const middle = (await projector(page, daemon, other)).at([1, 4]);
    const two = await readCanvas(page);
    // the middle of the line may lie between two pixels
    const red = Math.min(...[-1, 0, 1].map((dx) => two.colour(middle.x + dx, middle.y)[0]));
    assert.ok(red < fill[0] / 2, `the edge is ${red} on ${fill}`);
});

test('a click picks the face under it, and it alone changes colour', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const seen = (await getAll(daemon, mesh, 'faces')).filter((face) => place.isSeen(face));
    assert.equal(seen.length, 3);
    assert.equal((await readCanvas(page)).countOf(isChosen), 0);
    for (const face of seen) {
        await click(page, place.at(face.vertices));
        await checkInspector(context, 'face', face.id);
        const canvas = await readCanvas(page);
        for (const other of seen) {
            const { x, y } = place.at(other.vertices);
            assert.equal(isChosen(canvas.colour(x, y)), other.id === face.id);
        }
    }
    await checkAccessible(page, 'face selected');
    await click(page, { x: 4, y: 4 });
    await waitForFrame(page, { selection: '' });
    assert.equal((await readCanvas(page)).countOf(isChosen), 0);
});

test('in edge mode a click picks the edge beside it', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    await setMode(page, 'Edge');
    let count = 0;
    for (const edge of await getAll(daemon, mesh, 'edges')) {
        const sides = edge.faces.map((id) => faces.find((face) => face.id === id));
        if (!sides.some((face) => place.isSeen(face))) {
            continue;
        }
        const { x, y } = place.at(edge.vertices);
        await click(page, { x: x + 2, y: y - 2 });
        await checkInspector(context, 'edge', edge.id);
        assert.ok(isChosen((await readCanvas(page)).colour(x, y)), `edge ${edge.id}`);
        count++;
    }
    assert.equal(count, 9);
});

test('in vertex mode a click picks the vertex beside it, isolated ones too', async (t) => {
    const context = await openMesh(t, {
        ...SQUARE,
        vertices: [...SQUARE.vertices, [0, 0, 1], [9, 9, 9]].slice(0, 5),
    });
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const alone = place.at([4]);
    const near = ({ x, y }) => ({ x: x + 3, y: y + 2 });
    assert.ok(!isBackground((await readCanvas(page)).colour(alone.x, alone.y)));
    await setMode(page, 'Vertex');
    for (const vertex of [0, 1, 2, 3, 4]) {
        const { x, y } = place.at([vertex]);
        await click(page, near({ x, y }));
        const { isolated } = await checkInspector(context, 'vertex', vertex);
        assert.equal(isolated, vertex === 4);
        assert.ok(isChosen((await readCanvas(page)).colour(x, y)), `vertex ${vertex}`);
    }
});

test('dragging orbits and picks nothing; Fit view comes back', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const box = await page.locator('#canvas').boundingBox();
    const start = await page.screenshot({ clip: box });
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 120, y + 40, { steps: 4 });
    await page.mouse.up();
    const turned = await page.screenshot({ clip: box });
    assert.notDeepEqual(turned, start);
    assert.equal(await page.locator('#canvas').getAttribute('data-selection'), '');
    await page.getByRole('button', { name: 'Fit view' }).click();
    await page.mouse.move(2, 2);
    assert.deepEqual(await page.screenshot({ clip: box }), start);
});

test('links are followed from element to element', async (t) => {
    const context = await openMesh(t, SQUARE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    await click(page, place.at([0, 1, 2, 3]));
    let { halfedge } = await checkInspector(context, 'face', 0);
    const follow = (member) =>
        page.locator(`#members dd[data-member="${member}"] button`).first().click();
    await follow('halfedge');
    for (let i = 0; i < 4; i++) {
        const { next } = await checkInspector(context, 'halfedge', halfedge);
        await follow('next');
        halfedge = next;
    }
    const inner = await checkInspector(context, 'halfedge', halfedge);
    await follow('twin');
    const outer = await checkInspector(context, 'halfedge', inner.twin);
    assert.equal(outer.face, null);
    assert.equal(outer.boundary, true);
    await follow('prev');
    await checkInspector(context, 'halfedge', outer.prev);
    await follow('target');
    await checkInspector(context, 'vertex', outer.origin);
    await follow('halfedge');
    await page.locator('#canvas[data-selection^="halfedge"]').waitFor();
    await follow('edge');
    await page.locator('#canvas[data-selection^="edge"]').waitFor();
    await follow('vertices');
    await page.locator('#canvas[data-selection^="vertex"]').waitFor();
});

test('splitting an edge changes the mesh, undo and redo take it back and forth', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((f) => place.isSeen(f));
    const split = page.getByRole('button', { name: 'Split' });
    const undo = page.getByRole('button', { name: 'Undo' });
    const redo = page.getByRole('button', { name: 'Redo' });
    assert.ok(await split.isDisabled());
    assert.ok(await undo.isDisabled());
    await setMode(page, 'Edge');
    await click(page, place.at(face.vertices.slice(0, 2)));
    await page.locator('#canvas[data-selection^="edge"]').waitFor();
    const edge = Number((await page.locator('#canvas').getAttribute('data-selection')).slice(5));

    const counts = async (revision) => {
        await waitForFrame(page, { mesh, revision });
        const summary = await checkStatistics(context);
        assert.equal(summary.revision, revision);
        const { vertices, edges, faces } = summary.counts;
        return [vertices, edges, faces];
    };
    assert.deepEqual(await counts(1), [8, 12, 6]);
    await split.click();
    assert.deepEqual(await counts(2), [9, 15, 8]);
    await checkInspector(context, 'edge', edge);
    assert.ok(await redo.isDisabled());
    await undo.click();
    assert.deepEqual(await counts(3), [8, 12, 6]);
    assert.ok(await undo.isDisabled());
    await checkInspector(context, 'edge', edge);
    await redo.click();
    assert.deepEqual(await counts(4), [9, 15, 8]);
    const row = page.locator('[aria-current="true"] .mesh-counts');
    assert.equal(await row.textContent(), '9 vertices, 8 faces');
});

test('a face is split from its middle, or between two corners', async (t) => {
    const context = await openMesh(t, SQUARE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const split = page.getByRole('button', { name: 'Split' });
    await setMode(page, 'Vertex');
    await click(page, place.at([0]));
    await waitForFrame(page, { selection: 'vertex:0' });
    assert.ok(await split.isDisabled());
    await click(page, place.at([2]), ['Shift']);
    await waitForFrame(page, { selection: 'vertex:0 vertex:2' });
    await split.click();
    await waitForFrame(page, { mesh, revision: 2 });
    assert.equal((await checkStatistics(context)).counts.faces, 2);
    await setMode(page, 'Face');
    await click(page, place.at([0, 1, 2]));
    await page.locator('#canvas[data-selection^="face"]').waitFor();
    await split.click();
    await waitForFrame(page, { mesh, revision: 3 });
    const { counts } = await checkStatistics(context);
    assert.deepEqual([counts.vertices, counts.edges, counts.faces], [5, 8, 4]);
    // The page has fetched the mesh after the edit, so the new vertex can be picked where it is.
    await setMode(page, 'Vertex');
    const [made] = (await getAll(daemon, mesh, 'vertices')).slice(-1);
    await click(page, (await projector(page, daemon, mesh)).at([made.id]));
    await checkInspector(context, 'vertex', made.id);
});

test('what is selected and then deleted is no longer selected', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((f) => place.isSeen(f));
    await click(page, place.at(face.vertices));
    await waitForFrame(page, { selection: `face:${face.id}` });
    await page.getByRole('button', { name: 'Split' }).click();
    await waitForFrame(page, { revision: 2 });
    const child = (await getAll(daemon, mesh, 'faces')).at(-1);
    await click(page, (await projector(page, daemon, mesh)).at(child.vertices));
    await waitForFrame(page, { selection: `face:${child.id}` });
    await page.getByRole('button', { name: 'Undo' }).click();
    await waitForFrame(page, { revision: 3, selection: '' });
    assert.equal(await page.locator('#element-title').textContent(), 'Nothing selected');
});

test('a refusal is shown in the words of the server', async (t) => {
    const context = await openMesh(t, SQUARE, { allowed: [/status of 422/] });
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    await setMode(page, 'Vertex');
    await click(page, place.at([0]));
    await waitForFrame(page, { selection: 'vertex:0' });
    await click(page, place.at([1]), ['Shift']);
    await waitForFrame(page, { selection: 'vertex:0 vertex:1' });
    const refused = page.waitForResponse(isEdit);
    await page.getByRole('button', { name: 'Split' }).click();
    const problem = await (await refused).json();
    assert.equal(problem.status, 422);
    await expectToast(page, problem.detail);
    await checkAccessible(page, 'failure');
    assert.equal((await checkStatistics(context)).revision, 1);
    await page.getByRole('button', { name: 'Close message' }).click();
    assert.equal(await page.getByRole('alert').count(), 0);
});

test('an edit meant for an older revision is refused, and the page catches up', async (t) => {
    const context = await openMesh(t, CUBE, { allowed: [/status of 412/] });
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((f) => place.isSeen(f));
    await click(page, place.at(face.vertices));
    await waitForFrame(page, { selection: `face:${face.id}` });
    // Another client edits the mesh while the page's edit is on its way to the server.
    await page.route('**/edits', async (route) => {
        await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: face.id });
        await route.continue();
    }, { times: 1 });
    await page.getByRole('button', { name: 'Split' }).click();
    await expectToast(page, /revision.*another client made these changes.*: face_poke/);
    await waitForFrame(page, { mesh, revision: 2 });
    assert.equal((await checkStatistics(context)).counts.faces, 9);
    await page.getByRole('button', { name: 'Undo' }).click();
    await waitForFrame(page, { mesh, revision: 3 });
});

test('a file that cannot be read is refused with its line', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 4\d\d/] });
    const upload = (name, text) =>
        page.locator('#file').setInputFiles({ name, mimeType: '', buffer: Buffer.from(text) });
    await upload('broken.obj', 'v 0 0 0\nv 1 zero 0\n');
    await expectToast(page, /line 2/);
    await upload('picture.png', 'not a mesh');
    await page.locator('.toast').nth(1).waitFor();
    await upload('<b>.obj', 'f 1 2 3\n');
    await page.locator('.toast').nth(2).waitFor();
    assert.deepEqual((await get(daemon, '')).items, []);
    assert.ok(await page.getByRole('heading', { name: 'No meshes yet' }).isVisible());
});

test('a mesh that is gone and a server that is gone are said', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, {
        allowed: [/status of 404/, /ERR_CONNECTION_(REFUSED|RESET)/],
    });
    const { id: other } = await post(daemon, '', { name: 'other', shape: 'torus' });
    await page.getByRole('button', { name: 'Refresh' }).click();
    const row = page.locator(`#meshes button[data-mesh="${other}"]`);
    await row.waitFor();
    await fetch(`${daemon.url}/v1/meshes/${other}`, { method: 'DELETE' });
    await row.click();
    await expectToast(page, other);
    await waitForFrame(page, { mesh, revision: 1 });
    await daemon.stop();
    await page.getByRole('button', { name: 'Refresh' }).click();
    await expectToast(page, /cannot be reached/);
    // The mesh must still be shown, although the daemon has stopped.
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
});

test('without WebGL the page says so and still works', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const page = await openPage(t, daemon, {
        init: () => {
            HTMLCanvasElement.prototype.getContext = () => null;
        },
    });
    await page.getByRole('alert').filter({ hasText: 'No WebGL 2' }).waitFor();
    await page.locator('[data-statistic="faces"]').filter({ hasText: '6' }).waitFor();
    assert.equal(await page.locator(`[data-mesh="${mesh}"]`).count(), 1);
    await click(page, { x: 5, y: 5 });
    await checkAccessible(page, 'no WebGL');
});

test('everything is reached by keyboard, and the focus is seen', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const reached = [];
    for (let i = 0; i < 30; i++) {
        await page.keyboard.press('Tab');
        const { name, outline } = await page.evaluate(() => {
            const { activeElement: focused } = document;
            const ring = focused.matches('input[type="radio"]')
                ? focused.nextElementSibling
                : focused;
            return {
                name: focused.id || focused.name || focused.className || focused.tagName,
                outline: getComputedStyle(ring).outlineStyle,
            };
        });
        if (name !== 'BODY') {
            assert.equal(outline, 'solid', name);
            reached.push(name);
        }
    }
    for (const name of ['export', 'mesh-menu', 'pick', 'fit', 'refresh', 'mesh', 'upload wide', 'canvas']) {
        assert.ok(reached.includes(name), `${name} is not among ${reached}`);
    }
    await page.getByRole('radio', { name: 'Face' }).focus();
    await page.keyboard.press('ArrowRight');
    assert.ok(await page.getByRole('radio', { name: 'Edge', exact: true }).isChecked());
});

test('on a small screen the panels go around the view', async (t) => {
    const context = await openMesh(t, CUBE, { viewport: { width: 390, height: 800 } });
    const { daemon, mesh, page } = context;
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} px wide`);
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((f) => place.isSeen(f));
    await click(page, place.at(face.vertices));
    await checkInspector(context, 'face', face.id);
    await checkAccessible(page, 'small screen');
});
