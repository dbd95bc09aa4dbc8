// Tests that every operation of the server can be used from the page: its form is filled by clicks,
// tried, applied and undone, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { waitForFrame } from './browser.mjs';
import { get, startDaemon } from './daemon.mjs';
import { SCENARIOS, fillForm, openScenario } from './scenarios.mjs';
import { openPage } from './visit.mjs';

test('there is a scenario for every operation', async (t) => {
    const daemon = await startDaemon(t);
    const { operations } = await (await fetch(`${daemon.url}/v1/operations`)).json();
    const names = (rows) => rows.map(({ name }) => name).sort();
    assert.deepEqual(names(SCENARIOS), names(operations));
});

async function goThrough({ daemon, page }, scenario) {
    const mesh = await openScenario({ daemon, page }, scenario);
    const { revision, counts } = await get(daemon, `/${mesh}`);
    await fillForm({ daemon, page, mesh }, scenario);
    const verdict = page.locator('#verdict').filter({ hasText: /./ });
    assert.match(await verdict.textContent(), /^Would (make|change|replace|select|divide)/, scenario.name);
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { mesh, revision: revision + 1 });
    if (scenario.name === 'compact') {
        return; // compact gives the elements other ids and cannot be undone
    }
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await waitForFrame(page, { mesh, revision: revision + 2 });
    assert.deepEqual((await get(daemon, `/${mesh}`)).counts, counts, scenario.name);
}

const GROUPS = ['vertex', 'edge', 'face', 'loop'];
const groupOf = ({ name }) => GROUPS.find((group) => name.startsWith(`${group}_`)) ?? 'mesh';

for (const group of [...GROUPS, 'mesh']) {
    test(`each ${group} operation is filled, tried, applied and undone`, async (t) => {
        const daemon = await startDaemon(t);
        // The page may try an edit while the form is only half filled, and be refused: a single
        // edge between inner vertices cannot be cut.
        const page = await openPage(t, daemon, { allowed: [/status of 422/] });
        for (const scenario of SCENARIOS.filter((one) => groupOf(one) === group)) {
            await goThrough({ daemon, page }, scenario);
        }
    });
}
