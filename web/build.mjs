// build.mjs - bundles the page: `npm run build` writes these files to the folder that the variable
// WEB_OUT names, or to ../build/web if it is not set.
//
//   index.html, docs.html  the pages, with the names of the files below
//   assets/NAME-HASH.js    scripts, and in the same way .css and .svg; HASH is computed from the
//                          contents, so browsers may keep the files for ever
//   assets/LICENSES.txt    the licences of everything that is in the bundle

import { mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { build } from 'esbuild';

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
for (const name of ['index.html', 'docs.html']) {
    await writeFile(path.join(out, name), await page(name));
}
if (unused.size > 0) {
    throw new Error(`no page uses ${[...unused].join(', ')}`);
}
await writeFile(path.join(out, 'assets/LICENSES.txt'), await licenses(metafile.inputs));

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
