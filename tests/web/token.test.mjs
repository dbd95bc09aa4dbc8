// Tests the page of a server that requires access tokens: the page must ask for a token, keep it
// for the browser's tab only, and show what it allows.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';

import { checkAccessible, waitForFrame } from './browser.mjs';
import { program, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openPage } from './visit.mjs';

// Makes a token, and the line that the daemon's file of tokens must have for it.
function makeToken(name, role) {
    const [token, line] = execFileSync(program, ['--new-token', name, role], {
        encoding: 'utf8',
    }).split('\n');
    return { token, line };
}

// Starts a daemon with a mesh and three tokens: alice may edit, bob may only read, and prom may read
// metrics alone.
async function startGuarded(t) {
    const folder = mkdtempSync(path.join(os.tmpdir(), 'tokens-'));
    t.after(() => rmSync(folder, { recursive: true }));
    const [alice, bob] = [makeToken('alice', 'write'), makeToken('bob', 'read')];
    const prom = makeToken('prom', 'metrics');
    const file = path.join(folder, 'tokens');
    writeFileSync(file, `${alice.line}\n${bob.line}\n${prom.line}\n`);
    const daemon = await startDaemon(t, '--tokens', file);
    const ask = async (who, place, method = 'GET', body = undefined) => {
        const answer = await fetch(`${daemon.url}${place}`, {
            method,
            headers: { Authorization: `Bearer ${who.token}`, 'Content-Type': 'application/json' },
            body: body && JSON.stringify(body),
        });
        return { status: answer.status, body: await answer.json() };
    };
    const { status } = await ask(alice, '/v1/meshes/box', 'PUT', { name: 'box', shape: 'cube' });
    assert.equal(status, 201);
    return { daemon, alice, bob, prom, ask };
}

const UNAUTHORIZED = [/status of 401/];

async function use(page, token) {
    await page.locator('#sign-in[open]').waitFor();
    await page.locator('#token').fill(token);
    await page.locator('#sign-in button[value="use"]').click();
}

test('the page asks for a token until one is good, and edits with it', async (t) => {
    const { daemon, alice, ask } = await startGuarded(t);
    const page = await openPage(t, daemon, { allowed: UNAUTHORIZED });
    await page.locator('#sign-in[open]').waitFor();
    await checkAccessible(page, 'asked for a token', '#sign-in');
    assert.equal(await page.locator('#token-wrong').isVisible(), false);
    await use(page, 'hedge_wrong');
    await page.locator('#token-wrong:not([hidden])').waitFor();
    await use(page, alice.token);
    await waitForFrame(page, { mesh: 'box', revision: 1 });
    assert.equal(await page.locator('#who').textContent(), 'alice (write)');
    assert.equal(await page.locator('#split').isVisible(), true);

    // The event stream, which also needs the token, must report edits of other clients.
    const { status } = await ask(alice, '/v1/meshes/box/edits', 'POST', { op: 'face_poke', face: 0 });
    assert.equal(status, 200);
    await waitForFrame(page, { revision: 2 });
    await page.locator('#undo:enabled').click();
    await waitForFrame(page, { revision: 3 });

    // The token must not be in the address, or in a storage that outlives the browser's tab.
    assert.equal(page.url().includes(alice.token), false);
    const kept = await page.evaluate(() => JSON.stringify(localStorage) + document.cookie);
    assert.equal(kept.includes(alice.token), false, kept);
    await page.reload();
    await waitForFrame(page, { mesh: 'box', revision: 3 });
    const other = await page.context().newPage();
    await other.goto(daemon.url);
    await other.locator('#sign-in[open]').waitFor();
    await other.close();
});

test('who may look sees no buttons that edit', async (t) => {
    const { daemon, alice, bob, ask } = await startGuarded(t);
    const page = await openPage(t, daemon, { allowed: UNAUTHORIZED });
    await use(page, bob.token);
    await waitForFrame(page, { mesh: 'box', revision: 1 });
    assert.equal(await page.locator('#who').textContent(), 'bob (read)');
    for (const button of ['#split', '#undo', '#redo', '#remove', '#operation', '.upload.wide']) {
        assert.equal(await page.locator(button).isVisible(), false, button);
    }
    assert.equal(await page.locator('#fit').isVisible(), true);
    const { status } = await ask(alice, '/v1/meshes/box/edits', 'POST', { op: 'face_poke', face: 0 });
    assert.equal(status, 200);
    await waitForFrame(page, { revision: 2 });
    assert.equal(await page.locator('#history button.entry:visible').count(), 0);
    assert.equal(await page.locator('#history button.edits:visible').count(), 0);
    await checkAccessible(page, 'looking only');

    // The user must be able to change to another token.
    await page.locator('#who').click();
    await use(page, alice.token);
    await waitForFrame(page, { mesh: 'box', revision: 2 });
    assert.equal(await page.locator('#split').isVisible(), true);
});

test('a token for metrics is of no use to the page, which says so and asks again', async (t) => {
    const { daemon, alice, prom } = await startGuarded(t);
    const page = await openPage(t, daemon, { allowed: [...UNAUTHORIZED, /status of 403/] });
    await use(page, prom.token);
    await page.locator('#token-wrong', { hasText: 'may only read metrics' }).waitFor();
    await use(page, alice.token);
    await waitForFrame(page, { mesh: 'box', revision: 1 });
    assert.equal(await page.locator('#who').textContent(), 'alice (write)');
});

test('without a token the page says so, and asks again when told to', async (t) => {
    const { daemon, alice } = await startGuarded(t);
    const page = await openPage(t, daemon, { allowed: UNAUTHORIZED });
    await page.locator('#sign-in[open]').waitFor();
    await page.locator('#sign-in button.quiet').click();
    await expectToast(page, 'A token is needed');
    await page.locator('#refresh').click();
    await use(page, alice.token);
    await page.locator('#meshes button').first().click();
    await waitForFrame(page, { mesh: 'box', revision: 1 });
});
