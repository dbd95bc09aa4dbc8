// generators.mjs - the programs that make TypeScript clients of an OpenAPI document, and how each is
// told to: `words` is the command, below node_modules, with its arguments; `files` are what it
// reads from its folder. `document` is the path of the document, `out` is where the client goes.

export const generators = [
    {
        name: 'openapi-typescript',
        words: ['openapi-typescript/bin/cli.js', 'openapi.json', '--output', 'out/index.ts'],
    },
    {
        name: 'hey-api',
        words: ['@hey-api/openapi-ts/bin/run.js', '-f', 'config.mjs'],
        files: {
            'config.mjs': `export default {
                input: 'openapi.json',
                output: 'out',
                plugins: ['@hey-api/client-fetch', '@hey-api/typescript', '@hey-api/sdk'],
            };`,
        },
    },
    {
        name: 'swagger-typescript-api',
        words: ['swagger-typescript-api/dist/cli.mjs', 'generate', '--path', 'openapi.json', '--output', 'out',
            '--name', 'index.ts', '--module-name-first-tag'],
    },
    {
        name: 'orval',
        words: ['orval/dist/bin/orval.mjs', '--config', 'config.mjs'],
        files: {
            'config.mjs': `export default { hedge: {
                input: 'openapi.json',
                output: { target: 'out/index.ts', client: 'fetch', mode: 'single', baseUrl: { getBaseUrlFromSpecification: true } },
            } };`,
        },
    },
    {
        name: 'kubb',
        words: ['@kubb/cli/bin/kubb.js', 'generate', '--config', 'kubb.config.mjs'],
        files: {
            'kubb.config.mjs': `import { defineConfig } from '@kubb/core';
                import { pluginOas } from '@kubb/plugin-oas';
                import { pluginTs } from '@kubb/plugin-ts';
                import { pluginClient } from '@kubb/plugin-client';
                export default defineConfig({
                    root: '.',
                    input: { path: './openapi.json' },
                    output: { path: './out', clean: true },
                    plugins: [pluginOas(), pluginTs(), pluginClient({ client: 'fetch' })],
                });`,
        },
    },
];
