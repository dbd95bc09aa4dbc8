// Tests of the dialog that makes a mesh from a shape: it must offer every shape of the server with
// every parameter, and send what the user has put in.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { rangeOf, wordsFor } from '../../web/src/meshes/new_shape.js';
import { shapesOf } from '../../web/src/wire/schema.js';
import { checkAccessible } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

const WIDTHS = [360, 800, 1440];

const dialog = (page) => page.getByRole('dialog', { name: 'New mesh from a shape' });
const field = (page, name) => dialog(page).getByLabel(name, { exact: true });
const create = (page) => page.getByRole('button', { name: 'Create' });

async function openDialog(page) {
    await page.getByRole('button', { name: 'New shape' }).first().click();
    await dialog(page).waitFor();
}

async function readShapes(daemon) {
    return shapesOf(await (await fetch(`${daemon.url}/v1/openapi.json`)).json());
}

// Presses Create, and returns the body of the request and the summary of the mesh that the page
// then shows.
async function make(page) {
    const [request] = await Promise.all([
        page.waitForRequest((one) => one.method() === 'POST' && one.url().endsWith('/v1/meshes')),
        create(page).click(),
    ]);
    await dialog(page).waitFor({ state: 'detached' });
    return request.postDataJSON();
}

test('names and ranges are said in words', () => {
    assert.equal(wordsFor('major_segments'), 'Major segments');
    assert.equal(rangeOf({ min: 3, max: 16777216, exclusive: false }), 'from 3 to 16,777,216');
    assert.equal(rangeOf({ min: 0, max: 1e100, exclusive: true }), 'above 0');
    assert.equal(rangeOf({ min: -1e100, max: 1e100, exclusive: false }), '');
});

test('each shape is offered with all its parameters, and made with what they say', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    const shapes = await readShapes(daemon);
    assert.ok(shapes.length >= 13);
    for (const { name: shape, doc, params } of shapes) {
        await openDialog(page);
        await field(page, 'Shape').selectOption(shape);
        assert.ok(await dialog(page).getByText(doc).isVisible());
        for (const param of params) {
            const control = field(page, wordsFor(param.name));
            if (param.type === 'boolean') {
                assert.equal(await control.isChecked(), param.default);
                await control.setChecked(!param.default);
            } else {
                assert.equal(await control.inputValue(), `${param.default}`);
                // A whole number and one with a fraction that no parameter has by itself.
                await control.fill(param.type === 'integer' ? '4' : '0.375');
            }
        }
        await field(page, 'Name').fill(`a ${shape}`);
        const sent = await make(page);
        const wanted = Object.fromEntries(
            params.map(({ name, type, default: usual }) => [
                name,
                type === 'boolean' ? !usual : type === 'integer' ? 4 : 0.375,
            ]),
        );
        assert.deepEqual(sent, { shape, name: `a ${shape}`, ...wanted });
        await page.locator('#mesh-title').filter({ hasText: `a ${shape}` }).waitFor();
        // A client that sends the same gets the same mesh.
        const again = await post(daemon, '', sent);
        const { items } = await get(daemon, '');
        const [one, other] = items.filter(({ name }) => name === `a ${shape}`);
        assert.deepEqual(one.counts, other.counts);
        await fetch(`${daemon.url}/v1/meshes/${again.id}`, { method: 'DELETE' });
    }
    assert.equal((await get(daemon, '')).items.length, shapes.length);
});

test('a wrong number is explained at its field, and the rest stays', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 4\d\d/] });
    await openDialog(page);
    await field(page, 'Shape').selectOption('torus');
    await field(page, 'Minor radius').fill('0.5');
    await field(page, 'Minor segments').fill('2');
    await create(page).click();
    await dialog(page).getByRole('alert').filter({ hasText: /3/ }).waitFor();
    const wrong = field(page, 'Minor segments');
    assert.equal(await wrong.getAttribute('aria-invalid'), 'true');
    assert.ok(await wrong.evaluate((one) => one === document.activeElement));
    assert.equal(await field(page, 'Major segments').getAttribute('aria-invalid'), 'false');
    await checkAccessible(page, 'shape refused');
    assert.deepEqual((await get(daemon, '')).items, []);
    await wrong.fill('8');
    assert.deepEqual(await make(page), {
        shape: 'torus',
        name: 'Torus',
        major_segments: 32,
        minor_segments: 8,
        major_radius: 1,
        minor_radius: 0.5,
    });
    await page.locator('[data-statistic="faces"]').filter({ hasText: '256' }).waitFor();
});

test('a shape that is too large is refused in the dialog', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 4\d\d/] });
    await openDialog(page);
    await field(page, 'Shape').selectOption('grid');
    await field(page, 'Columns').fill('16777216');
    await field(page, 'Rows').fill('16777216');
    await create(page).click();
    await dialog(page).getByRole('alert').filter({ hasText: /\w/ }).waitFor();
    assert.ok(await create(page).isEnabled());
    await page.keyboard.press('Escape');
    await dialog(page).waitFor({ state: 'detached' });
    assert.deepEqual((await get(daemon, '')).items, []);
});

test('a shape is made by keyboard at each width, and its dialog fits', async (t) => {
    for (const width of WIDTHS) {
        const daemon = await startDaemon(t);
        const page = await openPage(t, daemon, { viewport: { width, height: 740 } });
        await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
        await checkAccessible(page, `empty at ${width}`);
        await page.getByRole('button', { name: 'New shape' }).first().focus();
        await page.keyboard.press('Enter');
        await field(page, 'Shape').selectOption('cylinder');
        const box = await dialog(page).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width && box.height <= 740, `${width}`);
        await checkAccessible(page, `shape at ${width}`);
        await field(page, 'Shape').focus();
        await page.keyboard.press('Tab');
        await page.keyboard.type('5'); // the number is selected, so that typing replaces it
        await page.keyboard.press('Enter');
        await page.locator('[data-statistic="faces"]').filter({ hasText: /^7$/ }).waitFor();
        assert.equal((await get(daemon, '')).items[0].name, 'Cylinder');
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} px at ${width}`);
    }
});
