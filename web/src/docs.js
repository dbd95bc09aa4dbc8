// docs.js - the manual at /docs: this server's OpenAPI document as a page. Each endpoint has a
// section whose id is its operationId, and each schema one whose id is schema-NAME.

import { getDescription } from './wire/api.js';
import { make } from './kit/dom.js';
import './look/theme.js';
import { alternatives, typeOf } from './wire/schema.js';

// Returns nodes that describe the type of a schema; the names of other schemas in this description
// are links.
function typeNodes(schema) {
    return typeOf(schema).map((part) =>
        typeof part === 'string' ? part : make('a', { href: `#schema-${part.ref}` }, part.ref),
    );
}

function cells(tag, ...contents) {
    return make('tr', {}, ...contents.map((content) => make(tag, {}, ...content)));
}

function table(heads, rows) {
    const head = make('thead', {}, cells('th', ...heads.map((text) => [text])));
    // The table may be wider than the page; tabIndex lets it have the focus, so that the keyboard
    // can scroll it.
    return make(
        'div',
        { className: 'table', tabIndex: 0, role: 'group', 'aria-label': heads[0] },
        make('table', {}, head, make('tbody', {}, ...rows)),
    );
}

function code(text) {
    return make('code', {}, text);
}

// Returns an element that shows an example: JSON with one member per line, other text unchanged.
function example(body) {
    const text = typeof body === 'string' ? body : JSON.stringify(body, null, 2);
    // Short arrays, such as ids and points, are written in one line, which is easier to read.
    const flat = text.replace(/\[[^[\]{}]*\]/g, (array) =>
        typeof body === 'string' ? array : array.replace(/\s+/g, ''),
    );
    return make('pre', { tabIndex: 0 }, code(flat.trimEnd()));
}

// Returns nodes that show a text, with the words between backticks as code.
function prose(text) {
    return text.split('`').map((part, i) => (i % 2 === 1 ? code(part) : part));
}

function note(text) {
    return text === undefined ? [] : [make('p', {}, ...prose(text))];
}

function membersTable({ properties, required = [] }) {
    const rows = Object.entries(properties).map(([name, schema]) =>
        cells(
            'td',
            [code(name), required.includes(name) ? ' (required)' : ''],
            typeNodes(schema),
            prose(schema.description ?? ''),
        ),
    );
    return table(['Member', 'Type', 'Meaning'], rows);
}

// Returns the nodes that describe a schema below its heading.
function schemaNodes(schema) {
    const nodes = note(schema.description);
    const choices = alternatives(schema);
    for (const choice of choices.filter((each) => each.properties)) {
        nodes.push(...note(choice.description), membersTable(choice));
    }
    const named = choices.filter((each) => each.$ref);
    if (named.length > 0) {
        const word = schema.allOf ? 'All of: ' : 'One of: ';
        nodes.push(make('p', {}, word, ...named.flatMap((each) => [...typeNodes(each), ' '])));
    }
    if (schema.properties && Object.keys(schema.properties).length > 0) {
        nodes.push(membersTable(schema));
    }
    if (choices.length === 0 && !schema.properties) {
        nodes.push(make('p', {}, ...typeNodes(schema)));
    }
    return nodes;
}

function contentNodes(content = {}) {
    return Object.entries(content).flatMap(
        ([media, { schema, 'x-item-schema': line, example: body }]) => {
            const event = schema?.contentSchema?.items;
            return [
                make(
                    'p',
                    {},
                    code(media),
                    ...(schema ? [': ', ...typeNodes(schema)] : []),
                    ...(line ? [', each line: ', ...typeNodes(line)] : []),
                    ...(event ? [', each event: ', ...typeNodes(event)] : []),
                ),
                ...(body === undefined ? [] : [example(body)]),
            ];
        },
    );
}

function parametersTable(parameters) {
    const rows = parameters.map((parameter) =>
        cells(
            'td',
            [code(parameter.name), parameter.required ? ' (required)' : ''],
            [parameter.in],
            typeNodes(parameter.schema),
            prose(parameter.description ?? ''),
        ),
    );
    return table(['Parameter', 'In', 'Type', 'Meaning'], rows);
}

function responseNodes(responses) {
    const nodes = [];
    const refusals = [];
    for (const [status, response] of Object.entries(responses)) {
        if (response.$ref) {
            refusals.push(status);
            continue;
        }
        nodes.push(make('h4', {}, `${status} ${response.description}`));
        if (response.headers) {
            const names = Object.keys(response.headers).flatMap((name) => [' ', code(name)]);
            nodes.push(make('p', {}, 'With', ...names));
        }
        nodes.push(...contentNodes(response.content));
    }
    const link = make('a', { href: '#refusals' }, 'problem');
    nodes.push(make('h4', {}, 'Refusals'));
    nodes.push(make('p', {}, `${refusals.join(', ')}, each a `, link, '.'));
    return nodes;
}

function section(id, heading, ...nodes) {
    return make('section', { id, 'aria-labelledby': `${id}-title` }, heading, ...nodes);
}

function operationSection(path, method, operation, shared) {
    const id = operation.operationId;
    const parameters = [...shared, ...operation.parameters];
    const heading = make('h3', { id: `${id}-title` }, operation.summary);
    const nodes = [
        make('p', { className: 'request' }, code(`${method.toUpperCase()} ${path}`)),
        ...note(operation.description),
    ];
    if (parameters.length > 0) {
        nodes.push(parametersTable(parameters));
    }
    if (operation.requestBody) {
        const word = operation.requestBody.required ? 'Body' : 'Body (optional)';
        nodes.push(make('h4', {}, word), ...contentNodes(operation.requestBody.content));
    }
    return section(id, heading, ...nodes, ...responseNodes(operation.responses));
}

function schemaSection([name, schema]) {
    const id = `schema-${name}`;
    return section(id, make('h3', { id: `${id}-title` }, name), ...schemaNodes(schema));
}

function list(entries) {
    const links = entries.map(([id, text]) => make('li', {}, make('a', { href: `#${id}` }, text)));
    return make('ul', {}, ...links);
}

function show({ info, paths, components }) {
    const operations = Object.entries(paths).flatMap(([path, { parameters, ...methods }]) =>
        Object.entries(methods).map(([method, operation]) => [path, method, operation, parameters]),
    );
    const schemas = Object.entries(components.schemas);
    const { problem } = components.responses;
    document.getElementById('version').textContent = info.version;
    document.getElementById('introduction').textContent = info.description;
    document
        .getElementById('contents')
        .append(
            make('h2', {}, 'Endpoints'),
            list(operations.map(([, , each]) => [each.operationId, each.summary])),
            make('h2', {}, 'Refusals'),
            list([['refusals', 'What a refusal says']]),
            make('h2', {}, 'Schemas'),
            list(schemas.map(([name]) => [`schema-${name}`, name])),
        );
    document
        .getElementById('manual')
        .append(
            make('h2', {}, 'Endpoints'),
            ...operations.map((operation) => operationSection(...operation)),
            section(
                'refusals',
                make('h2', { id: 'refusals-title' }, 'Refusals'),
                ...note(problem.description),
                ...contentNodes(problem.content),
            ),
            make('h2', {}, 'Schemas'),
            ...schemas.map(schemaSection),
        );
    // The browser looked for the section that the address names (#ID) before the manual was built,
    // so the page scrolls there now.
    document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
}

try {
    show(await getDescription());
} catch (error) {
    document.getElementById('introduction').textContent = error.message;
}
