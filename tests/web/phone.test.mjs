// Tests of the page on a telephone: the view, picking, undo and export stay at hand while one reads
// the panels.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, projector, waitForFrame } from './browser.mjs';
import { getAll } from './daemon.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const PHONES = [{ width: 320, height: 568 }, { width: 390, height: 844 }];

// Returns the part of an element that is seen, as {left, top, right, bottom}, or null if another one
// covers its middle.
const seen = (page, selector) =>
    page.evaluate((wanted) => {
        const node = document.querySelector(wanted);
        const { left, top, right, bottom } = node.getBoundingClientRect();
        const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
        return hit !== null && node.contains(hit) ? { left, top, right, bottom } : null;
    }, selector);

for (const viewport of PHONES) {
    test(`picking, undo and export stay at hand, ${viewport.width} wide`, async (t) => {
        const context = await openMesh(t, CUBE, { viewport, hasTouch: true, isMobile: true });
        const { daemon, mesh, page } = context;
        const width = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(width <= viewport.width, `${width} px wide`);
        await page.locator('#statistics').scrollIntoViewIfNeeded();
        for (const wanted of ['#canvas', '#export', '#undo', '#pick-modes']) {
            const box = await seen(page, wanted);
            assert.ok(box !== null, `${wanted} is covered`);
            assert.ok(box.top >= 0 && box.bottom <= viewport.height + 1, wanted);
            assert.ok(box.left >= 0 && box.right <= viewport.width, wanted);
        }
        // A tap picks although the page is scrolled, and the panel says what was picked.
        const place = await projector(page, daemon, mesh);
        const [face] = (await getAll(daemon, mesh, 'faces')).filter((f) => place.isSeen(f));
        await page.locator('#canvas').tap({ position: place.at(face.vertices) });
        await waitForFrame(page, { selection: `face:${face.id}` });
        await page.locator('#split').tap();
        await waitForFrame(page, { revision: 2 });
        await page.locator('#undo').tap();
        await waitForFrame(page, { revision: 3 });
        await checkAccessible(page, 'a telephone');
    });
}

for (const viewport of [...PHONES, { width: 1280, height: 800 }]) {
    test(`the manual, the examples and the keys are in reach, ${viewport.width} wide`, async (t) => {
        const { page } = await openMesh(t, CUBE, { viewport });
        const button = page.getByRole('button', { name: 'Examples, manual and keys' });
        if (viewport.width > 430) {
            assert.ok(await button.isHidden());
            for (const wanted of ['#examples', '.links a', '#help-button']) {
                assert.ok((await seen(page, wanted)) !== null, wanted);
            }
            // The window may become wider while the button is being pressed.
            await page.locator('#links-menu').evaluate((one) => one.click());
            assert.equal(await page.getByRole('menu').count(), 0);
            return;
        }
        for (const wanted of ['#refresh', '.meshes .upload', '.meshes .new-shape']) {
            const { left, right } = await seen(page, wanted);
            assert.ok(left >= 0 && right <= viewport.width, wanted);
        }
        const box = await seen(page, '#links-menu');
        assert.ok(box !== null && box.left >= 0 && box.right <= viewport.width, JSON.stringify(box));
        const bar = await page.locator('.bar').evaluate((one) => [one.scrollWidth, one.clientWidth]);
        assert.ok(bar[0] <= bar[1], `the bar scrolls: ${bar}`);
        assert.ok(await page.locator('#mesh-title').evaluate((one) => one.clientWidth >= 40));
        await button.click();
        const items = page.getByRole('menuitem');
        assert.deepEqual(await items.allTextContents(), ['Examples', 'Manual', 'Keys']);
        await checkAccessible(page, 'the menu of links');
        await items.filter({ hasText: 'Keys' }).click();
        await page.locator('#help').getByRole('button', { name: 'Close' }).click();
        await button.focus();
        await page.keyboard.press('Enter');
        await page.keyboard.press('ArrowDown');
        await page.keyboard.press('Enter');
        await page.waitForURL(/\/docs$/);
    });
}

test('what gets the focus is not covered by the view or the tools', async (t) => {
    const { page } = await openMesh(t, CUBE, { viewport: { width: 390, height: 844 } });
    await page.locator('#goto-id').focus();
    for (let i = 0; i < 30; i++) {
        await page.keyboard.press('Tab');
        const { name, isSeen } = await page.evaluate(() => {
            const node = document.activeElement;
            const { left, top, width, height } = node.getBoundingClientRect();
            const hit = document.elementFromPoint(left + width / 2, top + height / 2);
            const label = node.closest('label');
            return {
                name: node.id || node.textContent,
                isSeen: node === document.body || node.contains(hit) || label?.contains(hit) === true,
            };
        });
        assert.ok(isSeen, `${name} is covered`);
    }
});
