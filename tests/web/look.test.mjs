// Tests of the look of the view in Chromium: ways of drawing, shading, matcaps, guides, units, themes.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible, isBackground, isChosen, isSurface, projector, readCanvas, waitForFrame,
} from './browser.mjs';
import { getAll, post, startDaemon } from './daemon.mjs';
import { click, expectToast, press } from './page.mjs';
import {
    isClay, isMarkedBack, isPaper, lookOf, openView, setLook, waitForDrawing,
} from './view_panel.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const CAN = { name: 'can', shape: 'cylinder', segments: 16 };
const TORUS = { name: 'torus', shape: 'torus', major_segments: 24, minor_segments: 12 };

const choose = (page, name) => page.locator('#view-form').getByRole('radio', { name, exact: true }).check();
const checkbox = (page, name) => page.locator('#view-form').getByRole('checkbox', { name, exact: true });
const surface = (page) => page.getByRole('combobox', { name: 'Surface', exact: true });

async function draw(page) {
    await waitForDrawing(page);
    return readCanvas(page);
}

const isEmpty = (colour) => isBackground(colour);
const brightness = ([r, g, b]) => r + g + b;

// Returns where the middle of each visible face of a convex mesh is on the canvas.
async function placesOfFaces({ page, daemon, mesh }) {
    const place = await projector(page, daemon, mesh);
    const faces = (await getAll(daemon, mesh, 'faces')).filter((face) => place.isSeen(face));
    return faces.map(({ vertices }) => place.at(vertices));
}

test('a mesh is drawn solid, as X-ray, as wires and as points', async (t) => {
    const context = await openMesh(t, TORUS);
    const { page } = context;
    const solid = await readCanvas(page);
    const counts = { solid: solid.count - solid.countOf(isEmpty) };
    assert.ok(solid.countOf(isSurface) > 20000);
    await openView(page);

    await choose(page, 'Wires');
    const wires = await draw(page);
    counts.wires = wires.count - wires.countOf(isEmpty);
    // between the lines the background is visible, and through it the lines of the far side
    assert.ok(counts.wires > 5000 && counts.wires < 0.75 * counts.solid, JSON.stringify(counts));
    assert.ok(wires.countOf((colour) => brightness(colour) > 400) > 500);

    await choose(page, 'X-ray');
    const xray = await draw(page);
    counts.xray = xray.count - xray.countOf(isEmpty);
    assert.ok(counts.xray > 0.9 * counts.solid, JSON.stringify(counts));
    // where two layers are seen through, the picture is darker than the surface, but not the background
    const mean = (canvas) => {
        let sum = 0;
        canvas.countOf((colour) => {
            sum += isEmpty(colour) ? 0 : brightness(colour);
            return false;
        });
        return sum;
    };
    assert.ok(mean(xray) / counts.xray < 0.75 * (mean(solid) / counts.solid));

    await choose(page, 'Points');
    const points = await draw(page);
    counts.points = points.count - points.countOf(isEmpty);
    assert.ok(counts.points > 500 && counts.points < 0.2 * counts.solid, JSON.stringify(counts));

    await choose(page, 'Solid');
    const again = await draw(page);
    assert.equal(again.countOf(isSurface), solid.countOf(isSurface));
});

test('without edges only the fill is drawn', async (t) => {
    const { page } = await openMesh(t, TORUS);
    const isLine = (colour) => !isEmpty(colour) && brightness(colour) < 110;
    const before = (await readCanvas(page)).countOf(isLine);
    await openView(page);
    await checkbox(page, 'Edges').uncheck();
    const after = (await draw(page)).countOf(isLine);
    assert.ok(before > 3000 && after < before / 10, `${before} dark pixels, then ${after}`);
});

test('smooth shading has no steps between the faces of a can, but keeps its rim sharp', async (t) => {
    const context = await openMesh(t, { ...CAN, segments: 32 });
    const { page, daemon, mesh } = context;
    await setLook(page, { hasEdges: false });
    const box = await page.locator('#canvas').boundingBox();
    const row = Math.round(0.62 * box.height);
    // Returns the largest difference between neighbouring pixels of one row on the side of the can.
    const largestStep = (canvas) => {
        let [most, inside] = [0, 0];
        for (let x = 4; x < box.width - 4; x++) {
            // not at the outline, where the background shows through
            const around = [-4, -1, 1, 4].map((away) => canvas.colour(x + away, row));
            if (around.every((colour) => !isEmpty(colour))) {
                inside++;
                most = Math.max(most, Math.abs(brightness(around[2]) - brightness(around[1])));
            }
        }
        assert.ok(inside > 200, `${inside} pixels`);
        return most;
    };
    const flat = await readCanvas(page);
    await setLook(page, { isSmooth: true });
    const smooth = await readCanvas(page);
    const [before, after] = [flat, smooth].map(largestStep);
    assert.ok(after < before / 2, `steps of ${before}, then ${after}`);
    // the top is flat: its colour is the same as before
    const place = await projector(page, daemon, mesh);
    const lid = (await getAll(daemon, mesh, 'faces'))
        .find((face) => face.vertices.length === 32 && place.isSeen(face));
    const { x, y } = place.at(lid.vertices);
    smooth.colour(x, y).forEach((value, i) => assert.ok(Math.abs(value - flat.colour(x, y)[i]) <= 2));
    // with a crease angle of 180 degrees, the rim is smooth, so that the lid changes near it
    await setLook(page, { crease: 180 });
    const round = await readCanvas(page);
    const [edge] = lid.vertices;
    const near = place.at([...Array(6).fill(edge), ...lid.vertices.slice(0, 1), ...lid.vertices.slice(15, 17)]);
    assert.notDeepEqual(round.colour(near.x, near.y), smooth.colour(near.x, near.y));
});

test('smooth shading follows an edit', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, TORUS);
    await setLook(page, { isSmooth: true, hasEdges: false });
    const before = await readCanvas(page);
    // a subdivision replaces all faces; smoothly shaded, it looks nearly as before
    await post(daemon, `/${mesh}/edits`, { op: 'subdivide', scheme: 'catmull_clark' });
    await waitForFrame(page, { mesh, revision: 2 });
    await waitForDrawing(page);
    const after = await readCanvas(page);
    assert.ok(Math.abs(after.countOf(isSurface) - before.countOf(isSurface)) < before.count / 20);
});

test('matcaps colour the surface by its direction, and keep selected faces visible', async (t) => {
    const context = await openMesh(t, CUBE);
    const { page } = context;
    const places = await placesOfFaces(context);
    const colours = async () => {
        const canvas = await draw(page);
        return places.map(({ x, y }) => canvas.colour(x, y));
    };
    const plain = await colours();
    assert.ok(plain.every(isSurface));
    await openView(page);
    const seen = new Set([JSON.stringify(plain)]);
    for (const name of ['clay', 'metal', 'pearl']) {
        await surface(page).selectOption(`Matcap: ${name}`);
        const now = await colours();
        assert.ok(!now.some(isEmpty), `${name}: ${now}`);
        assert.equal(now.every(isClay), name === 'clay', `${name}: ${now}`);
        // sides with other directions have other colours
        assert.equal(new Set(now.map(String)).size, 3, name);
        seen.add(JSON.stringify(now));
    }
    assert.equal(seen.size, 4);
    await click(page, places[0]);
    await page.locator('#canvas[data-selection^="face"]').waitFor();
    assert.ok(isChosen((await colours())[0]));
});

test('the backs of faces are marked', async (t) => {
    const context = await openMesh(t, CUBE);
    const { page, daemon, mesh } = context;
    const places = await placesOfFaces(context);
    await openView(page);
    await checkbox(page, 'Mark the backs of faces').check();
    const front = await draw(page);
    assert.equal(front.countOf(isMarkedBack) > 300, false);
    await post(daemon, `/${mesh}/edits`, { op: 'reverse' });
    await waitForFrame(page, { mesh, revision: 2 });
    const back = await draw(page);
    assert.ok(back.countOf(isMarkedBack) > 20000, `${back.countOf(isMarkedBack)}`);
    places.forEach(({ x, y }) => assert.ok(isMarkedBack(back.colour(x, y))));
});

test('axes, grid and bounding box are drawn, and the box says its sizes in the chosen unit', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, {
        name: 'brick',
        vertices: [
            [0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0], [0, 0, 1], [4, 0, 1], [4, 2, 1], [0, 2, 1],
        ],
        faces: [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    });
    const isRed = ([r, g, b]) => r > 180 && g < 140 && b < 140;
    const plain = await readCanvas(page);
    assert.equal(plain.countOf(isRed), 0);
    await openView(page);
    await checkbox(page, 'Axes').check();
    const axes = await draw(page);
    assert.ok(axes.countOf(isRed) > 20, `${axes.countOf(isRed)} red pixels`);
    assert.ok(await page.locator('#view-cross').isVisible());
    await checkbox(page, 'Grid').check();
    const grid = await draw(page);
    assert.ok(grid.countOf(isEmpty) < axes.countOf(isEmpty) - 500);
    assert.equal(await page.locator('#view-grid').textContent(), 'Grid 0.5');
    await checkbox(page, 'Bounding box').check();
    await draw(page);
    const sizes = () => page.locator('#view-labels .size').allTextContents();
    assert.deepEqual(await sizes(), ['4', '2', '1']);
    await page.getByRole('combobox', { name: 'Unit' }).selectOption('mm');
    assert.deepEqual(await sizes(), ['4\u00a0mm', '2\u00a0mm', '1\u00a0mm']);
    assert.equal(await page.locator('#view-grid').textContent(), 'Grid 0.5\u00a0mm');
    const fact = (name) => page.locator(`[data-statistic="${name}"]`).textContent();
    assert.deepEqual([await fact('area'), await fact('volume')], ['28\u00a0mm\u00b2', '8\u00a0mm\u00b3']);
    await checkAccessible(page, 'guides');
    // the sizes follow an edit, and each label is near the middle of an edge of the box
    const matrix = [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    await post(daemon, `/${mesh}/edits`, { op: 'transform', matrix });
    await waitForFrame(page, { mesh, revision: 2 });
    await draw(page);
    assert.deepEqual(await sizes(), ['8\u00a0mm', '2\u00a0mm', '1\u00a0mm']);
    const stage = await page.locator('#canvas').boundingBox();
    for (const label of await page.locator('#view-labels .size').all()) {
        const { x, y, width, height } = await label.boundingBox();
        assert.ok(x >= stage.x && x + width <= stage.x + stage.width, 'a label is within the view');
        assert.ok(y >= stage.y && y + height <= stage.y + stage.height + 8);
    }
});

test('the theme follows the system or is chosen, is remembered, and changes page and view', async (t) => {
    const { page } = await openMesh(t, CUBE, { colorScheme: 'light' });
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const isLight = async () => {
        const canvas = await draw(page);
        const corner = canvas.colour(3, 3);
        const isGround = isPaper(corner) ? isPaper : isBackground;
        assert.ok(canvas.count - canvas.countOf(isGround) > 20000, 'the mesh is visible');
        const [red] = /\d+/.exec(await ground());
        assert.equal(isPaper(corner), Number(red) > 200, 'the page and the view have the same ground');
        return isPaper(corner);
    };
    assert.equal(await isLight(), true);
    await checkAccessible(page, 'light');
    await page.emulateMedia({ colorScheme: 'dark' });
    assert.equal(await isLight(), false);
    await openView(page);
    await checkAccessible(page, 'panel, dark');
    await choose(page, 'Light');
    assert.equal(await isLight(), true);
    await checkAccessible(page, 'panel, light');
    await page.reload();
    await page.locator('#canvas[data-revision="1"]').waitFor();
    assert.equal(await isLight(), true);
    await openView(page);
    assert.ok(await page.getByRole('radio', { name: 'Light', exact: true }).isChecked());
    await page.getByRole('button', { name: 'Keys' }).click();
    await checkAccessible(page, 'keys, light');
    await page.keyboard.press('Escape');
    await choose(page, 'Dark');
    assert.equal(await isLight(), false);
    await page.emulateMedia({ colorScheme: 'light' });
    assert.equal(await isLight(), false);
    await choose(page, 'System');
    assert.equal(await isLight(), true);
});

test('in the light theme, a selection with its fields, a failure and the manual are readable', async (t) => {
    const context = await openMesh(t, CUBE, { colorScheme: 'light', allowed: [/status of 4\d\d/] });
    const { page, daemon } = context;
    const [place] = await placesOfFaces(context);
    await click(page, place);
    await page.locator('#canvas[data-selection^="face"]').waitFor();
    await checkAccessible(page, 'selection, light');
    await page.locator('#file').setInputFiles({
        name: 'broken.obj', mimeType: '', buffer: Buffer.from('v 0 0 0\nv 1 zero 0\n'),
    });
    await expectToast(page, /line 2/);
    await checkAccessible(page, 'failure, light');
    await page.goto(`${daemon.url}/docs`);
    await page.getByLabel('Search the manual').waitFor();
    await checkAccessible(page, 'manual, light');
});

test('the look is remembered, and a button goes back to the plain one', async (t) => {
    const { page, mesh } = await openMesh(t, TORUS);
    await openView(page);
    await choose(page, 'Smooth');
    await surface(page).selectOption('Matcap: clay');
    await page.getByRole('combobox', { name: 'Unit' }).selectOption('in');
    await choose(page, 'X');
    const state = await lookOf(page);
    assert.deepEqual([state.isSmooth, state.matcap, state.section.axis], [true, 'clay', 'x']);
    await page.reload();
    await waitForFrame(page, { mesh, revision: 1 });
    const clay = await draw(page);
    assert.ok(clay.countOf(isClay) > 5000);
    // a section belongs to one mesh, so it is not remembered
    assert.deepEqual(await lookOf(page), { ...state, section: null });
    await openView(page);
    await page.getByRole('button', { name: 'Reset the view settings' }).click();
    const plain = await draw(page);
    assert.equal(plain.countOf(isClay), 0);
    assert.ok(plain.countOf(isSurface) > 20000);
    assert.equal((await lookOf(page)).unit, 'in');
});

test('a browser that remembers nothing, or nonsense, shows the plain look', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const forbidden = await openPage(t, daemon, {
        init: () => {
            Object.defineProperty(window, 'localStorage', {
                get() {
                    throw new DOMException('no', 'SecurityError');
                },
            });
        },
    });
    await waitForFrame(forbidden, { mesh, revision: 1 });
    await openView(forbidden);
    await choose(forbidden, 'Light');
    await choose(forbidden, 'Wires');
    const light = await draw(forbidden);
    assert.ok(light.countOf(isPaper) > 0.9 * light.count && light.countOf(isPaper) < light.count);
    const nonsense = await openPage(t, daemon, {
        init: () => {
            window.localStorage.setItem('hedge-look', '{"way":"<b>","crease":"x","section":[1]');
            window.localStorage.setItem('hedge-theme', '"purple"');
        },
    });
    await waitForFrame(nonsense, { mesh, revision: 1 });
    assert.ok((await draw(nonsense)).countOf(isSurface) > 5000);
});

test('keys and the keyboard alone reach every control', async (t) => {
    const { page } = await openMesh(t, TORUS);
    const canvas = page.locator('#canvas');
    for (const way of ['xray', 'wire', 'points', 'solid']) {
        await press(page, 'z');
        assert.equal((await lookOf(page)).way, way);
    }
    await canvas.press('v');
    assert.ok(await page.locator('#view-panel').isVisible());
    const focused = () => page.evaluate(() => document.activeElement.name || document.activeElement.id);
    assert.equal(await focused(), 'theme');
    const reached = [];
    while (!reached.includes('view-reset')) {
        await page.keyboard.press('Tab');
        reached.push(await focused());
        assert.ok(reached.length < 30, `${reached}`);
    }
    for (const name of ['way', 'isSmooth', 'matcap', 'marksBacks', 'axis', 'hasEdges', 'hasAxes',
        'hasGrid', 'hasBox', 'unit', 'hurry']) {
        assert.ok(reached.includes(name), `${name} is not among ${reached}`);
    }
    await page.locator('#view-form input[name="axis"]:checked').focus();
    await page.keyboard.press('ArrowRight');
    assert.equal((await lookOf(page)).section.axis, 'x');
    await page.locator('#section-slider').press('ArrowLeft');
    assert.ok((await lookOf(page)).section.at < 0);
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('#view-panel').isHidden());
    assert.equal(await focused(), 'view-button');
    await page.getByRole('button', { name: 'Keys' }).click();
    const help = await page.locator('#keys').textContent();
    assert.match(help, /VOpen or close the View panel/);
    assert.match(help, /ZDraw the mesh solid/);
});
