// Tests that visitors reach what they want in few clicks, and that the page is small. tasks.mjs has the
// tasks, in which nothing is done but by clicks and keys.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { wordsOfTime } from '../../web/src/kit/when.js';
import { checkAccessible, waitForFrame } from './browser.mjs';
import { startDaemon } from './daemon.mjs';
import { Hand, TASKS, compressedSize } from './tasks.mjs';
import { openPage } from './visit.mjs';

const MOST_BYTES = 300_000;

for (const task of TASKS) {
    test(`to ${task.name} needs at most ${task.most} clicks`, async (t) => {
        const daemon = await startDaemon(t);
        const page = await openPage(t, daemon, { allowed: [/status of 422/] });
        const context = { daemon, said: [], ...(await task.prepare(daemon)) };
        if (task.later !== undefined) {
            await page.clock.setFixedTime(Date.now() + task.later);
        }
        await page.reload();
        await (context.mesh === undefined
            ? page.getByRole('heading', { name: 'No meshes yet' }).waitFor()
            : waitForFrame(page, { mesh: context.mesh }));
        const hand = new Hand(page);
        await task.run(page, hand, context);
        await checkAccessible(page, task.name);
        await task.check(context);
        t.diagnostic(`${task.name}: ${hand.clicks} clicks, ${hand.keys} keys`);
        assert.ok(hand.clicks <= task.most, `${hand.clicks} clicks`);
    });
}

test('what the page loads first is sent as at most 300 kB', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
    for (const coding of ['gzip', 'zstd']) {
        const bytes = await compressedSize(page, coding, daemon.direct);
        t.diagnostic(`note: the page is sent as ${bytes} bytes of ${coding}`);
        assert.ok(bytes <= MOST_BYTES, `${bytes} bytes of ${coding}`);
    }
});

test('times are said the shorter the nearer they are', () => {
    const now = new Date(2026, 2, 1, 0, 5);
    const said = (...parts) => wordsOfTime(new Date(...parts), now);
    assert.equal(said(2026, 2, 1, 0, 4), '00:04');
    assert.equal(said(2026, 1, 28, 23, 59), 'yesterday 23:59');
    assert.equal(said(2026, 1, 28, 0, 0), 'yesterday 00:00');
    assert.equal(said(2026, 1, 27, 9, 30), '27 Feb 09:30');
    assert.equal(said(2025, 11, 31, 9, 30), '31 Dec 2025');
    assert.equal(wordsOfTime(new Date(2025, 11, 31, 9, 30), new Date(2026, 0, 1)), 'yesterday 09:30');
});
