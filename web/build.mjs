// build.mjs - bundles the page: `npm run build` writes these files to the folder that the variable
// WEB_OUT names, or to ../build/web if it is not set.
//
//   index.html             the page, with the names of the files below
//   docs.html, docs/       the pages of the manual, if the variable MANUAL names the file that
//                          manual/record.mjs has written
//   assets/NAME-HASH.js    scripts, and in the same way .css and .svg; HASH is computed from the
//                          contents, so browsers may keep the files for ever
//   assets/LICENSES.txt    the licences of everything that is in the bundle

import { createHash } from 'node:crypto';
import { mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { build } from 'esbuild';

import { filesOf, indexOf, pagesOf } from './manual/pages.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const out = path.resolve(here, process.env.WEB_OUT ?? '../build/web');

await rm(path.join(out, 'assets'), { recursive: true, force: true });
await mkdir(path.join(out, 'assets'), { recursive: true });

const { metafile } = await build({
    absWorkingDir: here,
    entryPoints: [
        'src/main.js',
        'src/style.css',
        'src/docs.js',
        'src/docs.css',
        'src/icon.svg',
    ],
    outdir: path.join(out, 'assets'),
    entryNames: '[name]-[hash]',
    bundle: true,
    format: 'esm',
    target: 'es2022',
    minify: true,
    loader: { '.svg': 'copy' },
    legalComments: 'none',
    banner: { js: '/* Licences: LICENSES.txt beside this file. */' },
    metafile: true,
    logLevel: 'warning',
});

const made = new Map(
    Object.entries(metafile.outputs)
        .filter(([, { entryPoint }]) => entryPoint !== undefined)
        .map(([file, { entryPoint }]) => [entryPoint, `assets/${path.basename(file)}`]),
);
const unused = new Set(made.keys());
await writeFile(path.join(out, 'index.html'), await page('index.html'));
await rm(path.join(out, 'docs'), { recursive: true, force: true });
if (process.env.MANUAL) {
    await makeManual(JSON.parse(await readFile(process.env.MANUAL, 'utf8')));
    if (unused.size > 0) {
        throw new Error(`no page uses ${[...unused].join(', ')}`);
    }
}
await writeFile(path.join(out, 'assets/LICENSES.txt'), await licenses(metafile.inputs));

// Writes the pages of the manual, and the list in which their search looks.
async function makeManual(recorded) {
    const pages = pagesOf(recorded);
    const index = JSON.stringify(indexOf(pages));
    const hash = createHash('sha256').update(index).digest('hex').slice(0, 8).toUpperCase();
    const assets = { index: `assets/docs-${hash}.json` };
    for (const [name, source] of [['style', 'src/docs.css'], ['script', 'src/docs.js'], ['icon', 'src/icon.svg']]) {
        assets[name] = made.get(source);
        unused.delete(source);
    }
    await writeFile(path.join(out, assets.index), index);
    for (const [name, text] of filesOf(pages, recorded, assets)) {
        await mkdir(path.dirname(path.join(out, name)), { recursive: true });
        await writeFile(path.join(out, name), text);
    }
}

// Returns the HTML of a page in which the name of each source file is replaced by the name of the
// bundled file.
async function page(name) {
    const html = await readFile(path.join(here, name), 'utf8');
    return html.replaceAll(/"(src\/[^"]*)"/g, (quoted, source) => {
        if (!made.has(source)) {
            throw new Error(`${name} names ${source}, which is no entry point`);
        }
        unused.delete(source);
        return `"${made.get(source)}"`;
    });
}

// Returns the text of the project's own licence and of the licences of all packages from which a
// file was bundled.
async function licenses(inputs) {
    const packages = new Set();
    for (const input of Object.keys(inputs)) {
        const match = /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input);
        if (match) {
            packages.add(match[1]);
        }
    }
    const parts = [await section('hedge', path.join(here, '..'))];
    for (const name of [...packages].sort()) {
        const folder = path.join(here, 'node_modules', name);
        const { version } = JSON.parse(await readFile(path.join(folder, 'package.json'), 'utf8'));
        parts.push(await section(`${name} ${version}`, folder));
    }
    return parts.join('\n');
}

async function section(title, folder) {
    const text = await readFile(path.join(folder, 'LICENSE'), 'utf8');
    return `${title}\n${'-'.repeat(title.length)}\n\n${text.trim()}\n`;
}
