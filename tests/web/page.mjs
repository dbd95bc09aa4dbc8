// page.mjs - functions that do what a user does on the page, and read what a user reads there.

import assert from 'node:assert/strict';

import { waitForFrame } from './browser.mjs';
import { get } from './daemon.mjs';

// Returns the texts that the inspector shows for the members of an element, by member.
export function readMembers(page) {
    return page.locator('#members').evaluate((list) =>
        Object.fromEntries(
            [...list.querySelectorAll('dd')].map((dd) => [
                dd.dataset.member,
                [...dd.children].map((child) => child.title || child.textContent),
            ]),
        ),
    );
}

// Returns the members that the inspector must show for an element of the API.
function membersOf(element) {
    const text = (value) => (value === null ? 'none' : String(value));
    return Object.fromEntries(
        Object.entries(element).map(([name, value]) => [
            name,
            Array.isArray(value) ? value.map(text) : [text(value)],
        ]),
    );
}

const PLURALS = { vertex: 'vertices', halfedge: 'halfedges', edge: 'edges', face: 'faces' };

export async function checkInspector({ daemon, mesh, page }, kind, id) {
    await waitForFrame(page, { selection: `${kind}:${id}` });
    const element = await get(daemon, `/${mesh}/${PLURALS[kind]}/${id}`);
    assert.deepEqual(await readMembers(page), membersOf(element), `${kind} ${id}`);
    return element;
}

export function click(page, position, modifiers = []) {
    return page.locator('#canvas').click({ position, modifiers });
}

export async function press(page, key) {
    await page.locator('#canvas').press(key);
}

// Waits until the camera is at rest, and returns its numbers as they are in the page's address.
export async function cameraOf(page) {
    await page.locator('#canvas:not([data-moving])').waitFor();
    return /camera=([^&]*)/.exec(page.url())?.[1];
}

// Selects an element by the form into which the user types a kind and an id.
export async function goTo(page, kind, id) {
    await page.locator('#goto-kind').selectOption(kind);
    await page.locator('#goto-id').fill(`${id}`);
    await page.getByRole('button', { name: 'Go', exact: true }).click();
    await waitForFrame(page, { selection: `${kind}:${id}` });
}

export async function setMode(page, mode) {
    await page.getByRole('radio', { name: mode, exact: true }).check();
}

// Chooses an operation in the list; if the list has only those that take the selection, asks for all.
export async function chooseOperation(page, name) {
    if ((await page.locator(`#operation option[value="${name}"]`).count()) === 0) {
        await page.getByRole('checkbox', { name: 'Show all operations' }).check();
    }
    await page.locator('#operation').selectOption(name);
}

// Returns whether a request or an answer is that of an edit and not of a dry run.
export function isEdit(message) {
    const request = message.request?.() ?? message;
    return request.url().endsWith('/edits') && request.postDataJSON()?.dry_run !== true;
}

// Returns the three fields of a point or a vector in the form of an operation.
export const vectorOf = (page, name) =>
    ['x', 'y', 'z'].map((axis) =>
        page.locator('#parameters').getByLabel(`${name} ${axis}`, { exact: true }),
    );

export async function fillVector(page, name, numbers) {
    for (const [i, field] of vectorOf(page, name).entries()) {
        await field.fill(`${numbers[i]}`);
    }
}

export async function expectToast(page, pattern) {
    const toast = page.getByRole('alert').filter({ hasText: pattern });
    await toast.waitFor();
    assert.equal(await toast.count(), 1);
}
