// Tests of the palette: everything that can be done is found by a few letters and run by keys, in
// Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { fitOf, found } from '../../web/src/palette/fuzzy.js';
import { checkAccessible, waitForFrame } from './browser.mjs';
import { startDaemon } from './daemon.mjs';
import { goTo } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

const items = (...labels) => labels.map((label) => ({ label, about: '' }));
const labelsOf = (list) => list.map(({ label }) => label);

test('a text fits if it has the letters of each word in their order', () => {
    assert.ok(fitOf('fh', 'fill_holes') > 0);
    assert.ok(fitOf('holes fill', 'fill_holes') > 0);
    assert.ok(fitOf('FILL', 'fill_holes') > 0);
    assert.equal(fitOf('fhx', 'fill_holes'), -1);
    assert.equal(fitOf('lif', 'fill'), -1);
    assert.equal(fitOf('ff', 'fill'), -1);
    assert.equal(fitOf('fill', ''), -1);
});

test('beginnings of words and letters in a row come first', () => {
    const list = items('edge_flip', 'face_delete', 'edge_delete', 'delaunay', 'fit view', 'loop_split');
    assert.deepEqual(labelsOf(found('ed', list)).slice(0, 2).sort(), ['edge_delete', 'edge_flip']);
    assert.equal(labelsOf(found('fd', list))[0], 'face_delete');
    assert.equal(labelsOf(found('fit', list))[0], 'fit view');
    assert.equal(labelsOf(found('dela', list))[0], 'delaunay');
    assert.deepEqual(found('  ', list), list);
    assert.deepEqual(found('zz', list), []);
    const described = [...items('remesh'), { label: 'smooth', about: 'Even out bumps' }];
    assert.deepEqual(labelsOf(found('bumps', described)), ['smooth']);
});

test('each text fits itself at least as well as any part of it', () => {
    const names = ['vertex_split_corners', 'loop_bridge', 'Select: Grow', 'plane_cut', 'material_set'];
    for (const name of names) {
        for (let length = 1; length < name.length; length++) {
            const part = name.slice(0, length);
            assert.ok(fitOf(part, name) >= 0, part);
            assert.ok(fitOf(name, name) >= fitOf(part, name), part);
        }
    }
});

const rows = (page) => page.locator('#palette-list [role="option"]');
const current = (page) => page.locator('#palette-list [aria-selected="true"] .act').textContent();

test('Ctrl+K lists all operations and the acts of the page, and keys run one', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await page.keyboard.press('Control+k');
    assert.ok(await page.locator('#palette-input').evaluate((node) => node === document.activeElement));
    await checkAccessible(page, 'the palette');
    const labels = await page.locator('#palette-list .act').allTextContents();
    const operations = await page.locator('#operation option').evaluateAll((all) => all.map(({ value }) => value));
    assert.ok(operations.length > 50);
    operations.forEach((name) => assert.ok(labels.includes(name), name));
    for (const act of ['Export', 'Fit view', 'Check', 'New shape', 'Screenshot', 'Select: Box', 'Pick: Edge']) {
        assert.ok(labels.includes(act), `${act} in ${labels}`);
    }
    // What cannot be done now is not offered.
    assert.ok(!labels.includes('Undo') && !labels.includes('Select: Grow'), `${labels}`);
    assert.equal(new Set(labels).size, labels.length);
    await page.keyboard.type('subd');
    assert.equal(await current(page), 'subdivide');
    const active = await page.locator('#palette-input').getAttribute('aria-activedescendant');
    assert.equal(await page.locator(`#${active} .act`).textContent(), 'subdivide');
    await page.keyboard.press('Enter');
    assert.ok(await page.locator('#palette').isHidden());
    assert.equal(await page.locator('#operation').inputValue(), 'subdivide');
    assert.ok(await page.locator('#parameters').evaluate((form) => form.contains(document.activeElement)));
});

test('arrows choose another row, a click runs it, Esc closes, and nothing fits nonsense', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await page.getByRole('button', { name: 'Commands' }).click();
    await page.keyboard.type('pick');
    const first = await current(page);
    await page.keyboard.press('ArrowDown');
    const second = await current(page);
    assert.notEqual(second, first);
    await page.keyboard.press('ArrowUp');
    assert.equal(await current(page), first);
    await page.keyboard.press('ArrowUp');
    const count = await rows(page).count();
    assert.equal(await page.locator('#palette-list [aria-selected="true"]').getAttribute('id'), `palette-${count - 1}`);
    await page.locator('#palette-list .act').getByText('Pick: Edge', { exact: true }).click();
    assert.ok(await page.getByRole('radio', { name: 'Edge', exact: true }).isChecked());
    await page.keyboard.press('Control+k');
    await page.keyboard.type('qqqqzz');
    assert.equal(await rows(page).count(), 0);
    await page.locator('#palette-none').filter({ hasText: 'Nothing has this name.' }).waitFor();
    await checkAccessible(page, 'nothing found', '#palette');
    await page.keyboard.press('Enter');
    assert.ok(await page.locator('#palette').isVisible());
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('#palette').isHidden());
});

test('the acts of the palette are those that are possible, and work', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await goTo(page, 'face', 2);
    await page.keyboard.press('Control+k');
    await page.keyboard.type('select grow');
    assert.equal(await current(page), 'Select: Grow');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('5 faces'));
    await waitForFrame(page, { revision: 1 });
    await page.keyboard.press('Control+k');
    await page.keyboard.type('new shape');
    await page.keyboard.press('Enter');
    await page.getByRole('dialog').getByRole('heading', { name: /shape/i }).waitFor();
    // A dialog that is open is not covered by another one.
    await page.keyboard.press('Control+k');
    assert.ok(await page.locator('#palette').isHidden());
});

test('without a mesh the palette has only what needs none, on a telephone, too', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { viewport: { width: 320, height: 700 } });
    await page.locator('#empty:not([hidden])').waitFor();
    await page.getByRole('button', { name: 'Commands' }).click();
    const labels = await page.locator('#palette-list .act').allTextContents();
    assert.ok(labels.includes('New shape') && !labels.includes('Export') && !labels.includes('subdivide'), `${labels}`);
    await checkAccessible(page, 'a telephone');
    const { width } = await page.locator('#palette').boundingBox();
    assert.ok(width <= 320);
});
