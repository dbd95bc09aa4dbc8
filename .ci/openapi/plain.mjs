// plain.mjs FILE - checks that an OpenAPI document uses only what generators of clients understand.
// Prints the place of each fault; the exit status is 1 if there is one.

import { readFileSync } from 'node:fs';

const document = JSON.parse(readFileSync(process.argv[2], 'utf8'));
const faults = [];
const isSchema = (path) => /\/(schema|items|additionalProperties|x-item-schema)$|\/(schemas|properties)\/[^/]*$|\/(oneOf|anyOf|allOf)\/\d+$/.test(path);
const VERBS = new Set(['apply', 'back', 'check', 'compare', 'copy', 'create', 'delete', 'export', 'follow', 'get',
    'list', 'name', 'preview', 'put', 'query', 'redo', 'reload', 'replace', 'traverse', 'undo', 'update']);
const resolve = ({ $ref: reference, ...schema }) =>
    reference === undefined ? schema : reference.slice(2).split('/').reduce((at, name) => at[name], document);
const only = (value, name) => Object.keys(value).every((key) => key === name);

function checkSchema(schema, path) {
    const say = (what) => faults.push(`${path}: ${what}`);
    if (('enum' in schema || 'const' in schema) && !('type' in schema)) {
        say('an enum or const without a type');
    }
    if (Array.isArray(schema.type)) {
        say('a list of types');
    }
    if (schema.allOf?.length === 1) {
        say('an allOf of one');
    }
    if ([...(schema.anyOf ?? []), ...(schema.oneOf ?? [])].some((part) => only(part, 'required'))) {
        say('a union of requirements');
    }
    const parts = (schema.oneOf ?? []).map(resolve);
    const [first = []] = parts.map(({ properties = {} }) => Object.keys(properties));
    const tells = first.find((name) => parts.every(({ properties = {} }) => 'const' in (properties[name] ?? {})));
    if (parts.length > 1 && tells !== undefined && schema.discriminator?.propertyName !== tells) {
        say(`a union whose parts differ in "${tells}", without a discriminator`);
    }
    if (schema.type === 'integer' && !('format' in schema) && !(schema.maximum < 2 ** 31)) {
        say('an integer that may pass 2^31 without a format');
    }
}

function walk(value, path) {
    if (typeof value !== 'object' || value === null || /\/(example|const)$/.test(path)) {
        return;
    }
    if (isSchema(path) && !Array.isArray(value)) {
        checkSchema(value, path);
    }
    for (const [key, child] of Object.entries(value)) {
        walk(child, `${path}/${key.replaceAll('~', '~0').replaceAll('/', '~1')}`);
    }
}

walk(document, '');
const tags = new Set(document.tags?.map(({ name }) => name));
for (const [path, item] of Object.entries(document.paths)) {
    for (const [method, operation] of Object.entries(item)) {
        if (method !== 'parameters' && !operation.tags?.every((tag) => tags.has(tag))) {
            faults.push(`/paths/${path}/${method}: no tag, or one that is not described`);
        }
        if (method !== 'parameters' && !(/^[a-z]+(_[a-z]+)+$/.test(operation.operationId) && VERBS.has(operation.operationId.split('_')[0]))) {
            faults.push(`/paths/${path}/${method}: the operationId is no verb with what it is done to, such as get_mesh`);
        }
        for (const { content = {} } of Object.values(operation.responses ?? {})) {
            for (const [media, { schema }] of Object.entries(content)) {
                if (schema === undefined) {
                    faults.push(`/paths/${path}/${method}: ${media} without a schema`);
                }
            }
        }
        for (const [media, { schema = {} }] of Object.entries(operation.requestBody?.content ?? {})) {
            if (Object.keys(schema).length === 0) {
                faults.push(`/paths/${path}/${method}: a body of ${media} that may be anything`);
            }
        }
    }
}
faults.forEach((fault) => console.log(fault));
process.exitCode = faults.length > 0 ? 1 : 0;
