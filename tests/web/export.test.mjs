// Tests of the dialog that exports the open mesh: it must offer what the server can write, and save
// what the server sends.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';

import { fileNameOf, formatBytes } from '../../web/src/kit/download.js';
import { choicesOf, formatOf, sentencesOf } from '../../web/src/meshes/exporting.js';
import { parametersOf } from '../../web/src/wire/schema.js';
import { checkAccessible, waitForFrame, waitForTold } from './browser.mjs';
import { post, startDaemon } from './daemon.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const WIDTHS = [360, 800, 1440];

const exportButton = (page) => page.getByRole('button', { name: 'Export', exact: true });
const download = (page) => page.getByRole('button', { name: 'Download' });
const dialog = (page) => page.getByRole('dialog', { name: /^Export/ });

async function openDialog(page) {
    await exportButton(page).click();
    await dialog(page).waitFor();
}

// Presses the button of the dialog, and returns the name and the bytes of the file that the browser
// saves.
async function save(page) {
    const [file] = await Promise.all([page.waitForEvent('download'), download(page).click()]);
    return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

async function contentOf({ daemon, mesh }, query) {
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}/content?${query}`);
    return {
        bytes: Buffer.from(await answer.arrayBuffer()),
        warnings: answer.headers.get('Export-Warnings') ?? '',
    };
}

test('names of files are safe, and sizes and warnings are words', () => {
    assert.equal(fileNameOf('cube', 'obj'), 'cube.obj');
    assert.equal(fileNameOf('../a/b: "c"?', 'stl'), 'a b c.stl');
    assert.equal(fileNameOf('  Gehäuse 左  ', 'ply'), 'Gehäuse 左.ply');
    assert.equal(fileNameOf('///', 'glb'), 'mesh.glb');
    assert.equal(fileNameOf('x'.repeat(300), 'glb').length, 104);
    assert.deepEqual([684, 1234, 4460000].map(formatBytes), ['684 bytes', '1.23 kB', '4.46 MB']);
    assert.deepEqual(sentencesOf(''), []);
    assert.deepEqual(sentencesOf('a face is cut, 6 times; and 3 more'), [
        'A face is cut, 6 times.',
        'And 3 more.',
    ]);
});

test('a file is written again in its own format, if the server can write it', () => {
    const formats = ['a.STL', 'a.b.obj', 'a.gltf', 'a.glb', 'a.mtl', 'a.bin', 'stl', ''].map(formatOf);
    assert.deepEqual(formats, ['stl', 'obj', 'glb', 'glb', null, null, null, null]);
});

test('the export begins with the format of the file that was read last', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const { bytes } = await contentOf({ daemon, mesh }, 'format=off');
    const file = { name: 'cube.off', mimeType: '', buffer: bytes };
    await page.locator('#file').setInputFiles(file);
    await waitForTold(page, /Read cube\.off/);
    await openDialog(page);
    assert.equal(await page.getByLabel('Format').inputValue(), 'off');
});

test('each format has the choices that the server accepts for it, and no others', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const answer = await fetch(`${daemon.url}/v1/openapi.json`);
    const parameters = parametersOf(await answer.json(), 'export_mesh');
    const { values: formats } = parameters.find(({ name }) => name === 'format');
    let count = 0;
    for (const format of formats) {
        for (const { name, values } of parameters.filter((one) => one.values !== undefined)) {
            const accepted = [];
            for (const value of name === 'format' ? [] : values) {
                const query = `format=${format}&${name}=${value}`;
                const { status } = await fetch(`${daemon.url}/v1/meshes/${mesh}/content?${query}`);
                assert.ok(status === 200 || status === 400, query);
                accepted.push(...(status === 200 ? [value] : []));
                count++;
            }
            // If a format has only one encoding, there is nothing to choose.
            const some = name === 'encoding' && accepted.length === 1 ? [] : accepted;
            const offered = choicesOf(format, name, values).filter((value) => value !== '');
            assert.deepEqual([...offered].sort(), some.sort(), `${format} ${name}`);
        }
    }
    assert.equal(count, formats.length * 4);
});

test('the file has the name of the mesh and the bytes of the server', async (t) => {
    const context = await openMesh(t, { ...CUBE, name: 'my: cube' });
    const { page } = context;
    await openDialog(page);
    const file = await save(page);
    assert.equal(file.name, 'my cube.obj');
    assert.deepEqual(file.bytes, (await contentOf(context, 'format=obj')).bytes);
    await dialog(page).waitFor({ state: 'detached' });
    await waitForTold(page, /Exported.*my cube\.obj, \d+ bytes/);
    await openDialog(page);
    assert.equal(await page.getByLabel('Format').inputValue(), 'obj');
    await page.getByLabel('Format').selectOption('ply');
    await page.getByLabel('Encoding').selectOption('ascii');
    const text = await save(page);
    assert.equal(text.name, 'my cube.ply');
    assert.match(`${text.bytes}`, /^ply\nformat ascii/);
});

test('what a format cannot hold is said in sentences', async (t) => {
    const context = await openMesh(t, CUBE);
    const { page } = context;
    await openDialog(page);
    await page.getByLabel('Format').selectOption('stl');
    const { bytes, warnings } = await contentOf(context, 'format=stl&encoding=binary');
    assert.notEqual(warnings, '');
    const file = await save(page);
    assert.equal(file.name, 'cube.stl');
    assert.deepEqual(file.bytes, bytes);
    const notes = dialog(page).getByRole('listitem');
    await notes.first().waitFor();
    assert.deepEqual(await notes.allTextContents(), sentencesOf(warnings));
    assert.match(await notes.first().textContent(), /^A face .*triangles.*6 times\.$/);
    await checkAccessible(page, 'export with notes');
    // Another format is another file, so the notes go.
    await page.getByLabel('Format').selectOption('off');
    assert.equal(await notes.count(), 0);
});

test('a glb is smaller when it is compressed', async (t) => {
    const { page } = await openMesh(t, { name: 'ball', shape: 'icosphere', subdivisions: 4 });
    await openDialog(page);
    await page.getByLabel('Format').selectOption('glb');
    assert.equal(await page.getByLabel('Encoding').count(), 0);
    const plain = await save(page);
    await page.getByLabel('Compression').selectOption('meshopt');
    const packed = await save(page);
    assert.ok(packed.bytes.length < plain.bytes.length);
    assert.match(`${packed.bytes}`, /EXT_meshopt_compression/);
});

test('an earlier revision is exported', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    await openDialog(page);
    assert.ok(await page.getByLabel('What to export').isHidden());
    await page.keyboard.press('Escape');
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { revision: 2 });
    await openDialog(page);
    await page.getByLabel('What to export').selectOption('1');
    const before = await save(page);
    assert.equal(before.name, 'cube r1.obj');
    assert.deepEqual(before.bytes, (await contentOf(context, 'format=obj&revision=1')).bytes);
    assert.notDeepEqual(before.bytes, (await contentOf(context, 'format=obj')).bytes);
});

test('a refusal is shown in the dialog, which stays open', async (t) => {
    const document = {
        name: 'far',
        vertices: [[0, 0, 0], [1e39, 0, 0], [0, 1e39, 0]],
        faces: [[0, 1, 2]],
    };
    const { page } = await openMesh(t, document, { allowed: [/status of 422/] });
    await openDialog(page);
    await page.getByLabel('Format').selectOption('glb');
    await download(page).click();
    const alert = dialog(page).getByRole('alert').filter({ hasText: /float/ });
    await alert.waitFor();
    await checkAccessible(page, 'export refused');
    await page.getByLabel('Format').selectOption('obj');
    assert.equal((await save(page)).name, 'far.obj');
});

test('the export works by keyboard at each width, and fits', async (t) => {
    for (const width of WIDTHS) {
        const { page } = await openMesh(t, CUBE, { viewport: { width, height: 740 } });
        await exportButton(page).focus();
        await page.keyboard.press('Enter');
        await dialog(page).waitFor();
        assert.equal(
            await page.evaluate(() => document.activeElement.labels?.[0]?.textContent),
            'Format',
        );
        const box = await dialog(page).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= width && box.height <= 740, `${width}`);
        await checkAccessible(page, `export at ${width}`);
        const file = page.waitForEvent('download');
        await page.keyboard.press('Tab');
        await page.keyboard.press('Tab');
        await page.keyboard.press('Enter');
        assert.equal((await file).suggestedFilename(), 'cube.obj');
        await dialog(page).waitFor({ state: 'detached' });
        assert.equal(await page.evaluate(() => document.activeElement.id), 'export');
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} px at ${width}`);
    }
});
