// A body or an answer can have several media types; kubb is to generate code for JSON.
import { defineConfig } from '@kubb/core';
import { pluginClient } from '@kubb/plugin-client';
import { pluginOas } from '@kubb/plugin-oas';
import { pluginTs } from '@kubb/plugin-ts';

const contentType = 'application/json';
export default defineConfig({
    input: { path: './work/openapi.json' },
    output: { path: './work/kubb/made', clean: true, format: false },
    plugins: [
        pluginOas({ validate: false, contentType }),
        pluginTs({ contentType }),
        pluginClient({ client: 'fetch', dataReturnType: 'full', bundle: true, contentType }),
    ],
});
