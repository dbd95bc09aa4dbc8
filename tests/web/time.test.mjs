// Tests of looking at earlier revisions: the slider, the curtain with changed faces in colours, names
// of revisions, and the way back to a named moment.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isSurface, readCanvas, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { goTo } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const GRID = { name: 'grid', shape: 'grid', columns: 4, rows: 4 };
const edit = (daemon, mesh, operation) => post(daemon, `/${mesh}/edits`, operation);
const row = (page, revision) => page.locator(`#history li[data-revision="${revision}"]`);
const slider = (page) => page.getByRole('slider', { name: 'Look at revision' });
const note = (page) => page.getByRole('group', { name: 'An earlier revision' });

// Whether a pixel is tinted in the colour of faces that are gone, new or moved.
const isGone = ([r, g, b]) => r > 120 && r > g + 45 && Math.abs(g - b) < 40;
const isMade = ([r, g, b]) => g > 100 && g > r + 30 && g > b + 15;
const isMoved = ([r, g, b]) => g > 110 && r > b + 40 && g > b + 25 && g > 0.77 * r;

// Waits until the page shows an earlier revision, or the present one (null).
function waitForPast(page, past) {
    return page.waitForFunction(
        (wanted) => (document.querySelector('#canvas').dataset.past ?? null) === wanted,
        past === null ? null : `${past}`,
    );
}

// Opens a grid with three edits: a face is deleted, one is poked, and a vertex is moved.
async function openEdited(t, options) {
    const opened = await openMesh(t, GRID, options);
    const { daemon, mesh, page } = opened;
    await edit(daemon, mesh, { op: 'face_delete', face: 0 });
    await edit(daemon, mesh, { op: 'face_poke', face: 15 });
    await edit(daemon, mesh, { op: 'vertex_move', vertex: 12, by: [0, 0, 0.1] });
    await waitForFrame(page, { revision: 4 });
    return opened;
}

// Returns which of the colours a part of the canvas has, from `from` to `to` of its width; what lies
// over the canvas does not count.
async function tintsIn(page, from, to) {
    await page.locator('#canvas').blur();
    const canvas = await page.locator('#canvas').boundingBox();
    const over = await Promise.all(
        ['#past-note', '#wiper'].map((one) => page.locator(one).boundingBox()),
    );
    const isOver = (x, y) =>
        over.some((box) => {
            const [left, top] = [x + canvas.x - (box?.x ?? 0), y + canvas.y - (box?.y ?? 0)];
            return box !== null && left >= 0 && top >= 0 && left <= box.width && top <= box.height;
        });
    const { width, height, colour } = await readCanvas(page);
    const found = { gone: 0, made: 0, moved: 0, plain: 0 };
    for (let y = 0; y < height; y += 2) {
        for (let x = Math.ceil(from * width); x < to * width; x += 2) {
            if (isOver(x, y)) {
                continue;
            }
            const pixel = colour(x, y);
            found.gone += isGone(pixel);
            found.made += isMade(pixel);
            found.moved += isMoved(pixel);
            found.plain += isSurface(pixel);
        }
    }
    return found;
}

test('any revision is looked at without a change of the mesh', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    const before = await get(daemon, `/${mesh}`);
    const present = await page.locator('#canvas').screenshot();
    assert.equal(await slider(page).getAttribute('min'), '1');
    assert.equal(await slider(page).getAttribute('max'), '4');
    await slider(page).focus();
    await page.keyboard.press('Home');
    await waitForPast(page, 1);
    await note(page).getByText('You are looking at revision 1 of 4.').waitFor();
    await checkAccessible(page, 'an earlier revision');
    assert.notDeepEqual(await page.locator('#canvas').screenshot(), present);
    // Nothing can be edited or picked meanwhile.
    assert.ok(await page.getByRole('button', { name: 'Undo', exact: true }).isDisabled());
    await page.locator('#canvas').click({ position: { x: 200, y: 200 } });
    await slider(page).focus();
    await page.keyboard.press('ArrowRight');
    await waitForPast(page, 2);
    assert.equal(await page.locator('#time-at').textContent(), '2 of 4');
    await page.locator('#canvas').press('Escape');
    await waitForPast(page, null);
    assert.ok(await note(page).isHidden());
    await page.locator('#canvas').blur();
    await waitForFrame(page, { revision: 4, selection: '' });
    assert.deepEqual(await get(daemon, `/${mesh}`), before);
});

test('before and now are beside each other, with changes in colours', async (t) => {
    const { page } = await openEdited(t);
    await row(page, 4).waitFor();
    await slider(page).focus();
    await page.keyboard.press('Home');
    await waitForPast(page, 1);
    const whole = await tintsIn(page, 0, 1);
    assert.equal(whole.gone + whole.made, 0);
    await page.getByRole('checkbox', { name: 'Compare with the present' }).check();
    await note(page).getByText('1 face gone, 3 faces new').waitFor();
    await checkAccessible(page, 'before and now');
    const wipe = page.getByRole('slider', { name: 'Dividing line between before and now' });
    // All is before: the deleted face is there, the faces of the poke are not.
    await wipe.focus();
    await page.keyboard.press('End');
    const past = await tintsIn(page, 0, 1);
    assert.ok(past.gone > 20, JSON.stringify(past));
    assert.ok(past.moved > 20, JSON.stringify(past));
    assert.equal(past.made, 0);
    // All is now.
    await page.keyboard.press('Home');
    const now = await tintsIn(page, 0, 1);
    assert.ok(now.made > 20, JSON.stringify(now));
    assert.ok(now.moved > 20, JSON.stringify(now));
    assert.equal(now.gone, 0);
    // The line is dragged to the middle: what is new is right of it only, what is gone left of it.
    const box = await page.locator('#canvas').boundingBox();
    const middle = box.x + box.width / 2;
    await page.mouse.move(box.x + 3, box.y + 80);
    await page.mouse.down();
    await page.mouse.move(middle, box.y + 80);
    await page.mouse.up();
    assert.equal(await wipe.inputValue(), '50');
    const left = await tintsIn(page, 0, 0.49);
    const right = await tintsIn(page, 0.51, 1);
    assert.equal(left.made, 0);
    assert.equal(right.gone, 0);
    assert.ok(left.plain > 100 && right.plain > 100);
    await page.getByRole('button', { name: 'Back to the present' }).click();
    await waitForPast(page, null);
    const after = await tintsIn(page, 0, 1);
    assert.equal(after.gone + after.made, 0);
});

test('an edit by another client keeps the earlier revision in sight', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    await row(page, 2).getByRole('button', { name: 'Look at revision 2' }).click();
    await waitForPast(page, 2);
    await page.getByRole('checkbox', { name: 'Compare with the present' }).check();
    await edit(daemon, mesh, { op: 'face_poke', face: 5 });
    await waitForFrame(page, { revision: 5 });
    await note(page).getByText('You are looking at revision 2 of 5.').waitFor();
    await note(page).getByText('6 faces new').waitFor();
    await page.getByRole('button', { name: 'Undo to here' }).click();
    await waitForPast(page, null);
    await waitForFrame(page, { revision: 8 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 15);
});

test('a revision is named in place, found again and gone back to with a click', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    await row(page, 3).getByRole('button', { name: 'Name revision 3' }).click();
    const field = page.getByRole('textbox', { name: 'Name of revision 3' });
    await field.fill('before <b>the</b> move');
    await checkAccessible(page, 'a name is written', '#details');
    await field.press('Enter');
    await row(page, 3).getByText('before <b>the</b> move').waitFor();
    const named = async (revision) =>
        (await get(daemon, `/${mesh}/edits`)).entries.find((one) => one.revision === revision).name;
    assert.equal(await named(3), 'before <b>the</b> move');
    // Names that others give appear, too.
    await fetch(`${daemon.url}/v1/meshes/${mesh}/edits/4`, {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json' },
        body: JSON.stringify({ name: 'moved' }),
    });
    await row(page, 4).getByText('moved', { exact: true }).waitFor();
    assert.equal(await row(page, 4).getAttribute('aria-current'), 'step');
    await row(page, 3).getByRole('button', { name: 'before' }).click();
    await waitForFrame(page, { revision: 5 });
    assert.equal(await row(page, 3).getAttribute('aria-current'), 'step');
    await row(page, 3).getByText('now').waitFor();
    // The moment that was left by the undo is reached by a click as well.
    await row(page, 4).getByRole('button', { name: 'moved' }).click();
    await waitForFrame(page, { revision: 6 });
    assert.equal((await get(daemon, `/${mesh}/edits`)).entries[0].state, 4);
    await row(page, 3).getByRole('button', { name: 'Name revision 3' }).click();
    await page.getByRole('textbox', { name: 'Name of revision 3' }).fill('');
    await page.keyboard.press('Enter');
    await row(page, 3).locator('.named').waitFor({ state: 'detached' });
    assert.equal(await named(3), undefined);
    await checkAccessible(page, 'names in the history', '#details');
});

test('a name that is too long is refused where it is written', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    await row(page, 2).getByRole('button', { name: 'Name revision 2' }).click();
    const field = page.getByRole('textbox', { name: 'Name of revision 2' });
    await field.fill('\u00e9'.repeat(101));
    assert.equal(await field.evaluate((one) => one.validationMessage), 'A name has at most 200 bytes.');
    await field.press('Enter');
    assert.ok(await field.isVisible());
    await field.press('Escape');
    await goTo(page, 'face', 3);
    const { entries } = await get(daemon, `/${mesh}/edits`);
    assert.ok(entries.every(({ name }) => name === undefined));
});

test('after a replacement there is no way back to earlier revisions', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    await slider(page).focus();
    await page.keyboard.press('Home');
    await waitForPast(page, 1);
    await fetch(`${daemon.url}/v1/meshes/${mesh}`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ shape: 'cube' }),
    });
    await waitForPast(page, null);
    await waitForFrame(page, { revision: 5 });
    assert.ok(await note(page).isHidden());
    assert.ok(await page.locator('#time').isHidden());
});

test('a name that is being written goes with its revision', async (t) => {
    // So small a history holds three steps.
    const daemon = await startDaemon(t, '--undo-budget', '4096');
    const { id: mesh } = await post(daemon, '', GRID);
    await edit(daemon, mesh, { op: 'face_poke', face: 0 });
    const page = await openPage(t, daemon);
    await waitForFrame(page, { mesh, revision: 2 });
    const sent = [];
    page.on('request', (request) => request.method() === 'PATCH' && sent.push(request.url()));
    await row(page, 2).getByRole('button', { name: 'Name revision 2' }).click();
    await page.keyboard.type('before the dent');
    for (let face = 1; face < 8; face++) {
        await edit(daemon, mesh, { op: 'face_poke', face });
    }
    await row(page, 9).waitFor();
    await row(page, 2).waitFor({ state: 'detached' });
    const { entries } = await get(daemon, `/${mesh}/edits`);
    const named = await page
        .locator('#history li:has(.moment)')
        .evaluateAll((all) => all.map((one) => Number(one.dataset.revision)));
    assert.deepEqual(named, entries.map(({ revision }) => revision));
    // There is nothing to name, so nothing is sent, and the list keeps the focus.
    assert.equal(await page.evaluate(() => document.activeElement.id), 'history');
    await goTo(page, 'face', 10);
    assert.deepEqual(sent, []);
});

test('each revision says when it was made, and the present one is in sight after an undo', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    const { entries } = await get(daemon, `/${mesh}/edits`);
    const times = page.locator('#history time');
    assert.deepEqual(
        await times.evaluateAll((all) => all.map(({ dateTime }) => dateTime)),
        entries.map(({ time }) => time),
    );
    // The page was left open for a day.
    await page.clock.setFixedTime(new Date(entries[0].time).getTime() + 24 * 60 * 60 * 1000);
    await page.evaluate(() => document.dispatchEvent(new Event('visibilitychange')));
    await times.first().filter({ hasText: /^yesterday \d\d:\d\d$/ }).waitFor();
    await row(page, 1).getByRole('button').click();
    await waitForFrame(page, { revision: 7 });
    const present = page.locator('#history [aria-current]');
    await present.filter({ hasText: 'now' }).waitFor();
    const [list, now] = await Promise.all([page.locator('#history'), present].map((one) => one.boundingBox()));
    assert.ok(now.y >= list.y && now.y + now.height <= list.y + list.height + 1, JSON.stringify([list, now]));
    // What is looked at is said with its name and time.
    await page.getByRole('button', { name: 'Name revision 2' }).click();
    await page.getByRole('textbox', { name: 'Name of revision 2' }).fill('one face less');
    await page.keyboard.press('Enter');
    await page.locator('#history .named').filter({ hasText: 'one face less' }).waitFor();
    await page.getByRole('button', { name: 'Look at revision 2' }).click();
    await note(page).getByText(/revision 2 of 7\. It is \u201cone face less\u201d, from yesterday \d\d:\d\d\./).waitFor();
    await checkAccessible(page, 'a moment with its time');
});

test('a name that is being written outlives the edits of others', async (t) => {
    const { daemon, mesh, page } = await openEdited(t);
    await row(page, 3).getByRole('button', { name: 'Name revision 3' }).click();
    const field = page.getByRole('textbox', { name: 'Name of revision 3' });
    await page.keyboard.type('before the dent');
    await field.evaluate((one) => {
        one.setSelectionRange(7, 10);
        window.written = one;
    });
    const state = () =>
        field.evaluate((one) => ({
            isSame: one === window.written && one === document.activeElement,
            text: one.value,
            selection: [one.selectionStart, one.selectionEnd],
        }));
    const wanted = { isSame: true, text: 'before the dent', selection: [7, 10] };
    await edit(daemon, mesh, { op: 'face_poke', face: 14 });
    await row(page, 5).waitFor();
    assert.deepEqual(await state(), wanted);
    // The mark of the present state comes to the row with the field, and goes away from it.
    await post(daemon, `/${mesh}/undo`, {});
    await post(daemon, `/${mesh}/undo`, {});
    await row(page, 3).filter({ hasText: 'now' }).waitFor();
    assert.equal(await row(page, 3).getAttribute('aria-current'), 'step');
    assert.deepEqual(await state(), wanted);
    await post(daemon, `/${mesh}/redo`, {});
    await row(page, 8).filter({ hasText: 'now' }).waitFor();
    assert.equal(await page.locator('#history [aria-current]').count(), 1);
    assert.deepEqual(await state(), wanted);
    const order = await page
        .locator('#history li')
        .evaluateAll((all) => all.map((one) => Number(one.dataset.revision)));
    assert.deepEqual(order, [...order].sort((a, b) => b - a));
    // It is kept while its row is not among the newest, and is saved in the end.
    for (let face = 0; face < 22; face++) {
        await edit(daemon, mesh, { op: 'face_inset', faces: [5], distance: 0.001 });
    }
    await row(page, 30).waitFor();
    assert.deepEqual(await state(), wanted);
    await page.getByRole('button', { name: 'Show older' }).waitFor();
    const renamed = page.waitForResponse((answer) => answer.request().method() === 'PATCH');
    await field.press('Enter');
    await renamed;
    const { entries } = await get(daemon, `/${mesh}/edits?limit=40`);
    assert.equal(entries.find(({ revision }) => revision === 3).name, 'before the dent');
});
