// Tests that the page says what an import has repaired and what it warns of, in sentences with
// links to the elements, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { sentencesOf, tallyOf } from '../../web/src/meshes/imported.js';
import { checkAccessible, waitForTold } from './browser.mjs';
import { get, startDaemon } from './daemon.mjs';
import { cameraOf, checkInspector } from './page.mjs';
import { openPage } from './visit.mjs';

// Line 13 is unknown, vertex 5 is isolated, face 3 has no area, and three faces share an edge.
const BROKEN_OBJ = `
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
v 1 1 1
v 9 9 9
f 1 2 3
f 2 1 4
f 1 2 5
f 1 1 2
flourish 1 2
`;

async function openBroken(t) {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    await page.locator('#file').setInputFiles({
        name: 'broken.obj',
        mimeType: '',
        buffer: Buffer.from(BROKEN_OBJ),
    });
    await page.getByRole('dialog', { name: 'Repair broken.obj' }).waitFor();
    await page.getByRole('button', { name: 'Import repaired mesh' }).click();
    await page.locator('#canvas[data-revision="1"]').waitFor();
    const { items: [{ id: mesh }] } = await get(daemon, '');
    return { daemon, mesh, page };
}

test('what an import repaired and warned of is shown, and each element is a click away', async (t) => {
    const context = await openBroken(t);
    const { page } = context;
    await waitForTold(page, /8 vertices, 3 faces/);
    await page.getByRole('button', { name: 'Show report' }).click();
    const dialog = page.getByRole('dialog', { name: 'What the import did' });
    await dialog.waitFor();
    const rows = (list) =>
        page.locator(`#report-${list} li`).evaluateAll((all) =>
            all.map(({ firstChild }) => firstChild.textContent),
        );
    assert.deepEqual(await rows('repairs'), [
        'Dropped 1 face without area (line 11 of the file).',
        'Split 2 vertices where the surface did not fit together, which made 2 new vertices.',
    ]);
    const warnings = await rows('warnings');
    assert.equal(warnings.length, 2);
    assert.match(warnings[0], /^A line with the unknown keyword 'flourish' is ignored, on line 12\.$/);
    assert.equal(warnings[1], 'These vertices belong to no face.');
    await checkAccessible(page, 'report');
    const before = await cameraOf(page);
    await dialog.getByRole('button', { name: 'Vertex 5' }).click();
    const { isolated } = await checkInspector(context, 'vertex', 5);
    assert.equal(isolated, true);
    assert.notEqual(await cameraOf(page), before);
    assert.ok(await dialog.isVisible(), 'further elements can be clicked');
    await dialog.getByRole('button', { name: 'Vertex 6' }).click();
    await checkInspector(context, 'vertex', 6);
});

test('the report is opened again from the statistics, and closed by keys', async (t) => {
    const { page } = await openBroken(t);
    const opener = page.getByRole('button', { name: 'Import: 2 repairs, 2 warnings' });
    await opener.focus();
    await page.keyboard.press('Enter');
    const dialog = page.getByRole('dialog', { name: 'What the import did' });
    await dialog.waitFor();
    assert.equal(await page.evaluate(() => document.activeElement.id), 'report-close');
    await page.keyboard.press('Escape');
    assert.ok(await dialog.isHidden());
    assert.equal(await page.evaluate(() => document.activeElement.id), 'report-open');
    // A mesh that was read without a remark has no report.
    await opener.click();
    await page.locator('#file').setInputFiles({
        name: 'whole.off',
        mimeType: '',
        buffer: Buffer.from('OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'),
    });
    await waitForTold(page, /whole\.off.*3 vertices, 1 face\D/);
    assert.ok(await dialog.isHidden());
    assert.ok(await page.locator('#report-open').isHidden());
});

test('every repair has its sentence, in the singular and in the plural', () => {
    const say = (repair) => sentencesOf({ repairs: [repair] }).repairs.map(({ text }) => text);
    const gone = { gone: [6], lines: [7] };
    assert.deepEqual(
        say({ repair: 'weld', count: 1, tolerance: 0, into: [0], moved: 1, ...gone }),
        [
            'Merged 1 vertex into others at the same place (line 7 of the file).',
            '1 value of merged vertices differed, and became values of corners.',
        ],
    );
    assert.deepEqual(
        say({ repair: 'weld', count: 3, tolerance: 0.5, into: [0, 0, 1], moved: 0, gone: [6, 7, 8] }),
        ['Merged 3 vertices into others at most 0.5 away.'],
    );
    assert.deepEqual(say({ repair: 'drop_degenerate', count: 0, gone: [], mended: 2, faces: [4, 6] }), [
        'Took corners out of 2 faces that used a vertex twice, or cut them into triangles ' +
            '(faces 4 and 6 of the file).',
    ]);
    assert.deepEqual(
        say({ repair: 'drop_duplicates', count: 2, into: [0, 1], gone: [5, 6], bytes: [84, 134] }),
        ['Dropped 2 faces with the same corners as others (bytes 84 and 134 of the file).'],
    );
    assert.deepEqual(
        say({ repair: 'orient', count: 2, components: 1, faces: [1, 2], not_orientable: 1, clashes: [9] }),
        [
            'Turned over 2 faces in 1 component, so that neighbours look the same way.',
            'Cut 1 component that cannot be oriented.',
        ],
    );
    assert.deepEqual(say({ repair: 'fill', count: 1, hole_edges: 16, faces: [4], left: 2 }), [
        'Filled 1 hole of at most 16 edges.',
        'Left 2 boundary loops open.',
    ]);
    assert.deepEqual(say({ repair: 'split', count: 0, vertices: 0, parents: { vertices: [] } }), [
        'The repair split found nothing to do.',
    ]);
});

test('what a report does not list is counted', () => {
    const lines = Array.from({ length: 100 }, (_, i) => i + 1);
    const detail = 'a number is read as 0, 250 times, first on line 1';
    const { warnings } = sentencesOf({
        warnings: [
            { code: 'not_finite', detail, count: 250, line: 1, lines },
            { code: 'open_seams', detail: 'faces are not connected', count: 12 },
            { code: 'bowtie', detail: 'fans share a vertex', count: 120, vertices: lines },
        ],
        more_warnings: 1,
    });
    assert.deepEqual(warnings.map(({ text }) => text), [
        'A number is read as 0, 250 times, first on line 1 (lines 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, ' +
            '11, 12 and 238 more of the file).',
        'Faces are not connected (12 times).',
        'Fans share a vertex.',
        '1 more warning is not listed.',
    ]);
    assert.equal(warnings[2].elements[0].more, 20);
    assert.equal(tallyOf({ repairs: [{}], warnings: [{}], more_warnings: 1 }), '1 repair, 2 warnings');
    assert.equal(tallyOf({ repairs: [], warnings: [] }), '');
});
