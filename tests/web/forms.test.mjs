// Tests of the forms of operations: fields are filled by clicks, and the effect of an edit is
// described before it is sent, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isNear, projector, readCanvas, waitForFrame, waitForTold } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { chooseOperation, click, fillVector, goTo, isEdit, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const GRID = { name: 'grid', shape: 'grid', columns: 3, rows: 3 };

const choose = chooseOperation;
const field = (page, name) => page.locator(`#param-${name}`);
const arm = (page, name) =>
    page.getByRole('button', { name: `Pick ${name} in the view`, exact: true }).click();

function expectValue(page, name, value) {
    return page.waitForFunction(
        ([id, wanted]) => document.getElementById(id).value === wanted,
        [`param-${name}`, value],
    );
}

function expectVector(page, name, numbers) {
    return page.waitForFunction(
        ([labels, wanted]) =>
            labels.every((label, i) => {
                const field = document.querySelector(`#parameters [aria-label="${label}"]`);
                return field.value === wanted[i];
            }),
        [['x', 'y', 'z'].map((axis) => `${name} ${axis}`), numbers.map(String)],
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
    // Elements that were clicked for a field must stay in the field when another element is
    // selected.
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
    // The elements in the field must be outlined in the view, although they are not selected.
    while ((await readCanvas(page)).countOf(isNear) < 300);
    await waitForFrame(page, { selection: '' });
    await checkAccessible(page, 'picking');
    await press(page, 'Escape');
    assert.equal(await page.locator('[aria-pressed="true"]').count(), 0);
    assert.ok(await page.locator('#pick-note').isHidden());
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
    await fillVector(page, 'by', [0, 0, 1]);
    await arm(page, 'to');
    await click(page, place.at([5]));
    await expectVector(page, 'to', position);
    await expectVector(page, 'by', ['', '', '']);
    await expectVerdict(page, 'Would change: 1 V');
});

async function paste(page, label, text) {
    await page.getByLabel(label, { exact: true }).evaluate((input, pasted) => {
        const clipboardData = new DataTransfer();
        clipboardData.setData('text', pasted);
        const options = { clipboardData, bubbles: true, cancelable: true };
        input.dispatchEvent(new ClipboardEvent('paste', options));
    }, text);
}

async function apply(page) {
    const sent = page.waitForRequest(isEdit);
    await page.getByRole('button', { name: 'Apply' }).click();
    return (await sent).postDataJSON().ops[0];
}

test('numbers are pasted into all fields of a point, more into a list', async (t) => {
    const { page } = await openMesh(t, GRID);
    await choose(page, 'vertex_move');
    await field(page, 'vertex').fill('3 4');
    await paste(page, 'to y', '1 2 3');
    await expectVector(page, 'to', [1, 2, 3]);
    await expectVerdict(page, 'Would change: 2 V');
    await paste(page, 'by x', '[0.5,-1,1e-3]');
    await expectVector(page, 'by', [0.5, -1, '1e-3']);
    await expectVector(page, 'to', ['', '', '']);
    await paste(page, 'by y', '8, 9');
    await expectVector(page, 'by', [0.5, 8, 9]);
    await paste(page, 'by z', '0 0 1, 0 0 2');
    const list = page.getByRole('textbox', { name: 'by as text' });
    assert.equal(await list.inputValue(), '0 0 1\n0 0 2');
    await checkAccessible(page, 'list of points', '#details');
    assert.deepEqual((await apply(page)).by, [[0, 0, 1], [0, 0, 2]]);
    await waitForFrame(page, { revision: 2 });
});

test('a point that lacks a number is said, and its field marked', async (t) => {
    const { page } = await openMesh(t, GRID, { allowed: [/status of 4\d\d/] });
    await choose(page, 'vertex_add');
    await page.getByLabel('position x', { exact: true }).fill('1');
    await expectVerdict(page, 'Not possible: position needs its y.');
    await page.locator('.wrong [aria-label="position x"][aria-invalid="true"]').waitFor();
    await fillVector(page, 'position', [1, 2, 3]);
    await expectVerdict(page, 'Would make: +1 V');
    assert.equal(await page.locator('.wrong').count(), 0);
    // A mistake that only the server finds must be marked at its field, too.
    await choose(page, 'edge_split');
    await field(page, 'edge').fill('0');
    await field(page, 't').fill('7');
    await expectVerdict(page, 'Not possible');
    await page.locator('.wrong #param-t').waitFor();
    await checkAccessible(page, 'wrong', '#details');
});

test('a whole number is asked for in whole steps', async (t) => {
    const { page } = await openMesh(t, GRID);
    await choose(page, 'subdivide');
    assert.equal(await field(page, 'steps').getAttribute('step'), '1');
    await choose(page, 'face_inset');
    assert.equal(await field(page, 'factor').getAttribute('step'), 'any');
    await choose(page, 'remesh');
    const marks = page.locator('[data-name="target_faces"] .head .small');
    assert.equal(await marks.textContent(), 'whole, from 1 to 33,554,432');
});

test('a map is put together of steps, or given as 16 numbers', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const { position } = await get(daemon, `/${mesh}/vertices/5`);
    await choose(page, 'transform');
    await page.getByLabel('rotate z', { exact: true }).fill('90');
    await page.getByRole('button', { name: 'Pick about in the view' }).click();
    await click(page, place.at([5]));
    await expectVector(page, 'about', position);
    await expectVerdict(page, 'Would change');
    await checkAccessible(page, 'steps', '#details');
    const [x, y] = position;
    const matrix = [0, -1, 0, x + y, 1, 0, 0, y - x, 0, 0, 1, 0, 0, 0, 0, 1];
    const near = (one) => one.forEach((value, i) => assert.ok(Math.abs(value - matrix[i]) < 1e-9));
    near((await apply(page)).matrix);
    await waitForFrame(page, { revision: 2 });
    assert.deepEqual((await get(daemon, `/${mesh}/vertices/5`)).position, position);

    await page.getByRole('button', { name: 'As 16 numbers' }).click();
    const text = page.getByRole('textbox', { name: 'matrix as text' });
    near((await text.inputValue()).split(/\s+/).map(Number));
    await checkAccessible(page, 'matrix', '#details');
    await text.fill('2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1');
    assert.deepEqual((await apply(page)).matrix, [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]);
    await waitForFrame(page, { revision: 3 });
    await page.getByRole('button', { name: 'As steps' }).click();
    await expectVector(page, 'about', position);
});

test('what an edit would make or why not is said before it is sent', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await choose(page, 'face_poke');
    assert.equal(await page.locator('#verdict').textContent(), '');
    await field(page, 'face').fill('2');
    await expectVerdict(page, 'Would make: +1 V +4 E +3 F');
    await checkAccessible(page, 'tried', '#details');
    await field(page, 'face').fill('66');
    await expectVerdict(page, /Not possible:.*66/);
    await checkAccessible(page, 'would be refused', '#details');
    await field(page, 'face').fill('6th');
    await expectVerdict(page, /6th.*not a number/);
    assert.equal(await page.getByRole('alert').filter({ visible: true }).count(), 0);
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    await field(page, 'face').fill('2');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
});

test('a form is found, filled and applied by keys alone, again and again', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await page.locator('#operation-search').focus();
    await page.keyboard.type('face_poke');
    await page.keyboard.press('Enter');
    await page.keyboard.type('2');
    await expectVerdict(page, 'Would make');
    await page.keyboard.press('Enter');
    await waitForFrame(page, { revision: 2 });
    const apply = page.getByRole('button', { name: 'Apply' });
    await apply.focus();
    for (const revision of [3, 4]) {
        await page.waitForFunction(() => {
            const { textContent, disabled } = document.activeElement;
            return textContent === 'Apply' && !disabled;
        });
        await page.keyboard.press('Enter');
        await waitForFrame(page, { revision });
    }
});

test('a visitor who uses fingers is brought to the view and back', async (t) => {
    const options = { viewport: { width: 390, height: 844 }, hasTouch: true };
    const { page } = await openMesh(t, CUBE, options);
    await choose(page, 'face_delete');
    const isSeen = (selector) =>
        page.waitForFunction((wanted) => {
            const { top, bottom } = document.querySelector(wanted).getBoundingClientRect();
            return top > -1 && bottom < window.innerHeight + 1;
        }, selector);
    await page.getByRole('button', { name: 'Pick face in the view' }).tap();
    await isSeen('#canvas');
    const { width, height } = await page.locator('#canvas').boundingBox();
    await page.locator('#canvas').tap({ position: { x: width / 2, y: height / 2 } });
    await page.waitForFunction(() => document.getElementById('param-face').value !== '');
    await checkAccessible(page, 'picking by fingers');
    await page.getByRole('button', { name: 'Done' }).tap();
    await isSeen('.picked button');
});

test('what an edit would make is asked again when another client has edited', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await choose(page, 'face_poke');
    await field(page, 'face').fill('2');
    await expectVerdict(page, 'Would make: +1 V +4 E +3 F');
    await post(daemon, `/${mesh}/edits`, { ops: [{ op: 'face_delete', face: 2 }] });
    await waitForFrame(page, { revision: 2 });
    await expectVerdict(page, /Not possible/);
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
    // The page's clock stands still in this test, so the field is filled at once and not key by
    // key.
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
    await expectVerdict(page, 'No preview');
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

const listed = (page) =>
    page.locator('#operation optgroup').evaluateAll((groups) =>
        Object.fromEntries(
            groups.map(({ label, children }) => [label, [...children].map(({ value }) => value)]),
        ),
    );

test('the list has the operations that take the selection, and all on request', async (t) => {
    const { daemon, page } = await openMesh(t, CUBE);
    const { operations } = await (await fetch(`${daemon.url}/v1/operations`)).json();
    const all = operations.map(({ name }) => name).sort();
    const everything = async () => Object.values(await listed(page)).flat().sort();
    const toggle = page.getByRole('checkbox', { name: 'Show all operations' });
    assert.deepEqual(await everything(), all);
    assert.ok(await toggle.isHidden());
    const takes = (...types) =>
        operations.filter(({ params }) => params.some(({ type }) => types.includes(type)));
    for (const [kind, name, types] of [
        ['face', 'face', ['face']],
        ['edge', 'edge', ['edge']],
        ['halfedge', 'half-edge', ['halfedge', 'edge']],
        ['vertex', 'vertex', ['vertex', 'vertices']],
    ]) {
        await goTo(page, kind, 1);
        const { [`For the selected ${name}`]: own, ...rest } = await listed(page);
        assert.deepEqual(own, takes(...types).map((one) => one.name), kind);
        assert.deepEqual(rest, {}, kind);
    }
    await checkAccessible(page, 'filtered', '#details');
    // The switch shows all of them, those for the selection first.
    await toggle.check();
    assert.deepEqual(await everything(), all);
    assert.deepEqual(Object.keys(await listed(page)), [
        'For the selected vertex', 'Vertex', 'Edge', 'Face', 'Loop', 'Mesh',
    ]);
    await choose(page, 'triangulate');
    await toggle.uncheck();
    // The operation in the form stays in the list.
    assert.equal(await page.locator('#operation').inputValue(), 'triangulate');
    assert.deepEqual((await listed(page)).Mesh, ['triangulate']);
});

test('several elements are offered what takes all of them', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    await click(page, place.at(faces[0].vertices));
    await waitForFrame(page, { selection: 'face:0' });
    assert.ok((await listed(page))['For the selected face'].includes('face_poke'));
    await click(page, place.at(faces[4].vertices), ['Shift']);
    await waitForFrame(page, { selection: 'face:0 face:4' });
    const own = (await listed(page))['For 2 faces'];
    assert.ok(own.includes('face_extrude') && own.includes('face_delete'), `${own}`);
    assert.ok(!own.includes('face_poke'), 'face_poke takes one face');
    await page.locator('#canvas').press('Escape');
    await waitForFrame(page, { selection: '' });
    assert.ok((await listed(page)).Face.includes('face_poke'));
});

test('the search finds operations that the selection hides', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await goTo(page, 'face', 0);
    const search = page.getByRole('searchbox', { name: 'Search operations' });
    assert.equal(await page.locator('#operation option[value="subdivide"]').count(), 0);
    await search.focus();
    await page.keyboard.type('subdiv');
    assert.equal(await page.locator('#operation').inputValue(), 'subdivide');
    await page.keyboard.press('Enter');
    await field(page, 'steps').fill('1');
    await expectVerdict(page, 'Would replace the whole mesh.');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
});

const areApart = (a, b) =>
    a.y + a.height <= b.y || b.y + b.height <= a.y || a.x + a.width <= b.x || b.x + b.width <= a.x;

// Returns the places of all elements that have one and fit a selector, asked for at once: a form has
// dozens of them.
function readBoxes(page, selector) {
    return page.locator(selector).evaluateAll((all) =>
        all
            .filter((each) => each.getClientRects().length > 0)
            .map((each) => {
                const { x, y, width, height } = each.getBoundingClientRect();
                return { id: each.id, x, y, width, height };
            }),
    );
}

test('what an edit would do stands below its field and covers nothing', async (t) => {
    for (const viewport of [{ width: 800, height: 600 }, { width: 1280, height: 700 }]) {
        const { page } = await openMesh(t, GRID, { viewport, allowed: [/status of 4\d\d/] });
        await choose(page, 'remesh');
        await field(page, 'face').fill('0');
        const verdict = page.locator('#verdict');
        for (const name of ['error', 'edge_length', 'min_length', 'steps', 'crease']) {
            await field(page, name).fill('0.5');
            await expectVerdict(page, /./);
            assert.equal(await page.evaluate(() => document.activeElement.id), `param-${name}`);
            const [said, own] = [await verdict.boundingBox(), await field(page, name).boundingBox()];
            const what = `${viewport.width}: ${name}`;
            assert.ok(said.height > 10 && said.y >= 0, what);
            assert.ok(said.y + said.height <= viewport.height + 1, `${what} out of sight`);
            assert.ok(own.y >= 0 && own.y + own.height <= viewport.height, `${what} scrolled away`);
            const boxes = await readBoxes(page, '#parameters :is(input, select, button)');
            assert.ok(boxes.length > 10, `${what}: ${boxes.length} fields`);
            for (const { id, ...box } of boxes) {
                assert.ok(areApart(said, box), `${what} covers ${id}`);
            }
        }
        await checkAccessible(page, 'verdict below its field', '#details');
    }
});

const submit = (page) => page.locator('#parameters').getByRole('button', { name: 'Apply' }).click();

test('what is missing is said beside its field, and nothing is sent', async (t) => {
    const { page } = await openMesh(t, GRID);
    const sent = [];
    page.on('request', (request) => isEdit(request) && sent.push(request.url()));
    for (const [operation, name, words] of [
        ['decimate', 'faces', 'Fill in faces or ratio.'],
        ['hole_fill', 'halfedge', 'Fill in halfedge: type ids, or press Pick and click in the view.'],
        ['append', 'mesh', 'Fill in mesh: choose a mesh.'],
        ['plane_cut', 'point', 'Fill in point'],
    ]) {
        await choose(page, operation);
        await submit(page);
        const verdict = page.locator(`[data-name="${name}"] + #verdict`);
        await verdict.filter({ hasText: words }).waitFor();
        const control = field(page, name);
        assert.equal(await control.getAttribute('aria-invalid'), 'true');
        assert.ok(await control.evaluate((node) => node === document.activeElement), operation);
        await checkAccessible(page, `${operation} without ${name}`, '#details');
    }
    assert.equal(await page.getByRole('alert').count(), 0);
    assert.deepEqual(sent, []);
});

test('what the server refuses is said beside the field that it is about', async (t) => {
    const { page } = await openMesh(t, GRID, { allowed: [/status of 4\d\d/] });
    await choose(page, 'smooth');
    await field(page, 'steps').fill('-4');
    await submit(page);
    await page.locator('[data-name="steps"] + #verdict').filter({ hasText: 'Not possible: ' }).waitFor();
    assert.equal(await field(page, 'steps').getAttribute('aria-invalid'), 'true');
    assert.equal(await page.getByRole('alert').count(), 0);
    // The mistake is forgotten when the field changes.
    await field(page, 'steps').fill('2');
    await page.waitForFunction(
        () => document.getElementById('param-steps').getAttribute('aria-invalid') === 'false',
    );
});

test('an edge or an inner half-edge at a hole means the half-edge of the hole', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: 4 });
    await waitForFrame(page, { revision: 2 });
    const loops = (await get(daemon, `/${mesh}/boundaries`)).loops;
    const [rim] = loops.filter(({ halfedges }) => halfedges.length === 4);
    const hole = rim.halfedges[0];
    const { twin, edge, origin } = await get(daemon, `/${mesh}/halfedges/${hole}`);
    await choose(page, 'hole_fill');
    await goTo(page, 'edge', edge);
    await expectValue(page, 'halfedge', `${hole}`);
    await goTo(page, 'halfedge', twin);
    await expectValue(page, 'halfedge', `${hole}`);
    await goTo(page, 'halfedge', hole);
    await expectValue(page, 'halfedge', `${hole}`);
    await goTo(page, 'vertex', origin);
    await page.waitForFunction((ids) => ids.includes(document.getElementById('param-halfedge').value), rim.halfedges.map(String));
    await goTo(page, 'edge', edge);
    await expectVerdict(page, 'Would make: +1 F');
    await submit(page);
    await waitForFrame(page, { revision: 3 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 1);
    // Beside the form, the page says what was made.
    await expectVerdict(page, 'Made: +1 F');
});

test('a field takes the selection by its name, and its vertices if it wants vertices', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await goTo(page, 'face', 4);
    await choose(page, 'transform');
    await field(page, 'vertex').fill('the selection');
    await page.locator('#parameters').getByLabel('translate z', { exact: true }).fill('0.25');
    const sent = page.waitForRequest(isEdit);
    await submit(page);
    const { vertices } = (await sent).postDataJSON().ops[0];
    const face = await get(daemon, `/${mesh}/faces/4`);
    assert.deepEqual(vertices, [...face.vertices].sort((a, b) => a - b));
    await waitForFrame(page, { revision: 2 });
    const places = (await getAll(daemon, mesh, 'vertices')).map(({ position }) => position);
    places.forEach(([, , z], id) => assert.equal(z, vertices.includes(id) ? 0.25 : 0));
    // Edges cannot be made of faces.
    await choose(page, 'edge_delete');
    await field(page, 'edge').fill('the selection');
    await submit(page);
    await expectVerdict(page, 'faces are selected, but edges are needed.');
});

test('what an operation did is said in numbers of the mesh', async (t) => {
    const { page } = await openMesh(t, GRID);
    await choose(page, 'triangulate');
    await submit(page);
    await waitForFrame(page, { revision: 2 });
    await waitForTold(page, /9 to 18 faces\./);
    await choose(page, 'decimate');
    await field(page, 'faces').fill('8');
    await submit(page);
    await waitForFrame(page, { revision: 3 });
    await waitForTold(page, /18 to 8 faces, 16 to \d+ vertices, stop: faces, error 0/);
    await choose(page, 'reverse');
    await submit(page);
    await waitForFrame(page, { revision: 4 });
    await waitForTold(page, /Changed: 8 F|Changed: .*8 F/);
    assert.ok(!(await page.evaluate(() => window.told)).some((text) => /Done|revision/.test(text)));
});

test('a long form scrolls in its panel, the page stays where it is', async (t) => {
    const { page } = await openMesh(t, CUBE);
    for (const name of ['remesh', 'select', 'deform']) {
        await choose(page, name);
        const height = await page.evaluate(() => document.documentElement.scrollHeight);
        assert.equal(height, 800, name);
    }
});

test('an angle is given and told in degrees', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const marks = (name) => page.locator(`[data-name="${name}"] .head .small`).textContent();
    await choose(page, 'remesh');
    assert.equal(await marks('crease'), 'degrees, from 0 to 180, optional');
    assert.equal(await field(page, 'crease').getAttribute('placeholder'), '40.107');
    await choose(page, 'segment');
    await field(page, 'angle').fill('180.5');
    await submit(page);
    await expectVerdict(page, 'angle must be from 0 to 180 degrees.');
    assert.equal(await field(page, 'angle').getAttribute('aria-invalid'), 'true');
    await field(page, 'angle').fill('180');
    assert.equal((await apply(page)).angle, Math.PI);
    await waitForFrame(page, { revision: 2 });
    await choose(page, 'select');
    await field(page, 'by').selectOption('region');
    await field(page, 'face').fill('0');
    await field(page, 'angle').fill('45');
    assert.equal((await apply(page)).angle, Math.PI / 4);
    await waitForFrame(page, { revision: 3 });
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces: [0] });
    await waitForFrame(page, { revision: 4 });
    await choose(page, 'fill_holes');
    await submit(page);
    await waitForTold(page, /bend 90\u00b0/);
});

test('a message says each number once, and which holes stay open', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { name: 'ball', shape: 'icosphere', subdivisions: 2 });
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces: [0, 40, 41, 42, 43] });
    await waitForFrame(page, { revision: 2 });
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    const lengths = loops.map(({ length }) => length);
    await choose(page, 'fill_holes');
    await field(page, 'max_edges').fill('3');
    const open = lengths.filter((length) => length > 3).length;
    const said = new RegExp(`${open} holes? stays? open \\(too large: ${open}\\)`);
    await expectVerdict(page, said);
    await submit(page);
    await waitForTold(page, said);
    await choose(page, 'remesh');
    await field(page, 'edge_length').fill('0.4');
    await submit(page);
    await waitForTold(page, /faces, .*stop/);
    const told = await page.evaluate(() => window.told.join());
    assert.ok(!/large 0|doubled 0|faces before|faces after/.test(told), told);
});
