// Tests that the page, after the server has refused a file, offers to upload it again with the
// repairs that would make it acceptable.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible } from './browser.mjs';
import { get, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openPage } from './visit.mjs';

const BROKEN_OBJ = `
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
v 1 1 1
f 1 2 3
f 2 1 4
f 1 2 5
f 1 1 2
`;

test('a refused file is sent again with the repairs the refusal names', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    await page.locator('#file').setInputFiles({
        name: 'broken.obj',
        mimeType: '',
        buffer: Buffer.from(BROKEN_OBJ),
    });
    await expectToast(page, /line 10.*repair=drop_degenerate,split/);
    await checkAccessible(page, 'refused');
    assert.deepEqual((await get(daemon, '')).items, []);
    await page.getByRole('button', { name: 'Upload with drop_degenerate, split' }).click();
    await page.locator('#canvas[data-revision="1"]').waitFor();
    assert.equal(await page.getByRole('alert').count(), 0);
    const { items } = await get(daemon, '');
    assert.equal(items.length, 1);
    assert.equal(items[0].name, 'broken');
    assert.deepEqual([items[0].counts.vertices, items[0].counts.faces], [7, 3]);
});

test('what no repair mends is not offered', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    await page.locator('#file').setInputFiles({
        name: 'broken.obj',
        mimeType: '',
        buffer: Buffer.from('v 0 0 0\nf 1 2 3\n'),
    });
    await expectToast(page, /line 2/);
    assert.equal(await page.getByRole('button', { name: /Upload with/ }).count(), 0);
});
