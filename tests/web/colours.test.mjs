// Tests that faces are drawn in the colours of their materials, which a legend names. The colours
// are read from a file, changed by the page and by other clients, undone, and switched off.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible,
    isBackground,
    isChosen,
    isSurface,
    projector,
    readCanvas,
    waitForFrame,
} from './browser.mjs';
import { get, getAll, post, startDaemon } from './daemon.mjs';
import { click } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const LIBRARY = `newmtl red
Kd 0.8 0.02 0.02
newmtl green
Kd 0.02 0.6 0.05
newmtl lamp
Kd 0 0 0
Ke 0 0 1
newmtl glass
Kd 0.9 0.9 0.9
d 0.5
newmtl unused
Kd 1 1 0
`;

// The materials of eight squares, side by side in a plane that the camera looks down on.
const NAMES = ['red', 'green', 'lamp', 'glass', 'unheard_of', '', 'red', 'red'];
const BANDS = [
    'mtllib bands.mtl',
    ...Array.from({ length: 18 }, (_, i) => `v ${i >> 1} ${4 * (i & 1)} 0`),
    'f 11 13 14 12',
    ...NAMES.flatMap((name, i) => {
        const [a, b, c, d] = [2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2];
        return name === '' ? [] : [`usemtl ${name}`, `f ${a} ${b} ${c} ${d}`];
    }),
].join('\n');

const isRed = ([r, g, b]) => r > 90 && g < 60 && b < 60;
const isGreen = ([r, g, b]) => g > 90 && r < 60 && b < 90;
const isBlue = ([r, g, b]) => b > 180 && r < 60 && g < 60;
const isLight = ([r, g, b]) => Math.min(r, g, b) > 110 && Math.max(r, g, b) - Math.min(r, g, b) < 12;

// Returns a function that reads 64 pixels in the middle of each face of the page's mesh, and
// returns a map from the face's id to a function that counts those that pass a test.
async function looker({ page, daemon, mesh }) {
    const [project, faces] = [await projector(page, daemon, mesh), await getAll(daemon, mesh, 'faces')];
    return async () => {
        const picture = await readCanvas(page);
        return new Map(faces.map(({ id, vertices }) => {
            const { x, y } = project.at(vertices);
            const pixels = Array.from({ length: 64 }, (_, i) =>
                picture.colour(x - 4 + (i & 7), y - 4 + (i >> 3)));
            return [id, (isIt) => pixels.filter(isIt).length];
        }));
    };
}

const legend = (page) =>
    page.locator('#legend [data-material]').evaluateAll((rows) =>
        rows.map((row) => [row.dataset.material, row.children[2].textContent]));

test('an OBJ file and its library show their colours and names', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.locator('#file').setInputFiles([
        { name: 'bands.obj', mimeType: '', buffer: Buffer.from(BANDS) },
        { name: 'bands.mtl', mimeType: '', buffer: Buffer.from(LIBRARY) },
    ]);
    await page.locator('#mesh-title').filter({ hasText: /^bands$/ }).waitFor();
    const [{ id: mesh }] = (await get(daemon, '')).items;
    await waitForFrame(page, { mesh, revision: 1, materials: 1 });
    const look = await looker({ page, daemon, mesh });
    const seen = await look();
    // a face without a material has the colour of a surface without materials
    const wanted = [isSurface, isRed, isGreen, isBlue, null, isSurface, isRed, isRed];
    wanted.forEach((isIt, face) => {
        assert.ok(isIt === null || seen.get(face)(isIt) === 64, `face ${face}`);
    });
    // half of the pixels behind the transparent face must be visible
    assert.equal(seen.get(4)(isBackground), 32);
    assert.equal(seen.get(4)(isLight), 32);
    assert.deepEqual(await legend(page), [
        ['red', ''],
        ['green', ''],
        ['lamp', ''],
        ['glass', 'opacity 0.5'],
        ['unused', ''],
        ['unheard_of', 'unknown colour'],
    ]);
    const [red] = await page.locator('#legend .swatch').evaluateAll((swatches) =>
        swatches.map((swatch) => getComputedStyle(swatch).backgroundColor));
    assert.equal(red, 'rgb(231, 39, 39)'); // 0.8 and 0.02 in sRGB
    await checkAccessible(page, 'materials');

    // a selected face must be drawn as selected, and still show its material; a transparent face
    // can be picked, too
    const project = await projector(page, daemon, mesh);
    const pick = async (face) => {
        const { vertices } = await get(daemon, `/${mesh}/faces/${face}`);
        await click(page, project.at(vertices));
        await waitForFrame(page, { selection: `face:${face}` });
    };
    await pick(2);
    const current = page.locator('#legend [aria-current]');
    assert.equal(await current.getAttribute('data-material'), 'green');
    assert.equal((await look()).get(2)(isChosen), 64);
    await pick(4);
    assert.equal(await current.getAttribute('data-material'), 'glass');
    await pick(0);
    assert.equal(await current.count(), 0);
    await page.locator('#canvas').press('Escape');

    await page.getByLabel('Draw faces in these colours').uncheck();
    await waitForFrame(page, { selection: '' });
    const plain = await look();
    [0, 1, 2, 3, 5, 6, 7].forEach((face) => assert.equal(plain.get(face)(isSurface), 64, `${face}`));
});

const SQUARES = {
    name: 'squares',
    vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
    faces: [[0, 1, 4, 3], [1, 2, 5, 4]],
};

test('what is changed here or elsewhere is drawn, and undone', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, SQUARES);
    const look = await looker({ page, daemon, mesh });
    const step = async (path, body) => {
        const { revision } = await post(daemon, `/${mesh}/${path}`, body);
        await waitForFrame(page, { revision, materials: revision });
        return look();
    };
    assert.ok(await page.locator('#materials').isHidden());

    let seen = await step('edits',
        { op: 'material_set', name: 'red', base_color: [0.8, 0, 0], faces: [1] });
    assert.deepEqual([seen.get(0)(isSurface), seen.get(1)(isRed)], [64, 64]);
    assert.deepEqual(await legend(page), [['red', '']]);
    seen = await step('edits', { op: 'material_set', name: 'red', base_color: [0, 0.8, 0] });
    assert.equal(seen.get(1)(isGreen), 64);
    seen = await step('edits', { op: 'material_set', name: 'red', rename: 'lime', faces: [0] });
    assert.equal(seen.get(0)(isGreen), 64);
    assert.deepEqual(await legend(page), [['lime', '']]);
    seen = await step('undo', {});
    assert.equal(seen.get(0)(isSurface), 64);

    // both sides of a face must show its colour once its material is two-sided
    seen = await step('edits', { op: 'reverse' });
    assert.equal(seen.get(1)(isGreen), 0);
    seen = await step('edits', { op: 'material_set', name: 'red', two_sided: true });
    assert.equal(seen.get(1)(isGreen), 64);
    assert.deepEqual(await legend(page), [['red', 'two-sided']]);

    // new faces must have the material of the face that they came from
    const { vertices } = await get(daemon, `/${mesh}/faces/1`);
    await step('edits', { op: 'face_poke', face: 1 });
    const picture = await readCanvas(page);
    const project = await projector(page, daemon, mesh);
    const [a, b] = vertices;
    const beside = project.at([a, a, b, b, vertices[2]]);
    assert.ok(isGreen(picture.colour(beside.x, beside.y)));

    // the whole mesh is replaced
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ ...SQUARES, materials: [{ name: 'sky', base_color: [0, 0, 1] }],
            attributes: [{ domain: 'faces', name: 'material', type: 'uint32',
                labels: ['', 'sky'], values: [1, 0] }] }),
    });
    assert.equal(answer.status, 200, await answer.clone().text());
    const { revision } = await answer.json();
    await waitForFrame(page, { revision, materials: revision });
    seen = await look();
    assert.equal(seen.get(1)(isSurface), 64);
    assert.ok(seen.get(0)(([r, g, b]) => b > 90 && r < 40 && g < 40) === 64);
    assert.deepEqual(await legend(page), [['sky', '']]);
});
