// reference_pages.mjs - the pages about routes, problems and types, made from the server's tables.

import { h } from './html.mjs';
import { inline } from './markdown.mjs';
import { answerText, code, requestBlock, schemaNodes, setupBlock, table, typeNodes } from './parts.mjs';

// --- routes ---

function contentNodes(content = {}, link) {
    return Object.entries(content).map(([media, { schema, 'x-item-schema': line }]) => {
        const event = schema?.contentSchema?.items;
        const type = event ?? line ?? schema;
        const words = event ? 'a stream of ' : line ? 'lines, each ' : '';
        return h('li', {}, code(media), type && Object.keys(type).length > 0 ? [': ', words, ...typeNodes(type, link)] : '');
    });
}

function answersList(responses, problems, link) {
    const good = Object.entries(responses).filter(([, response]) => !response.$ref && !response.content?.['application/problem+json']);
    const refused = Object.keys(responses).filter((status) => !good.some(([each]) => each === status));
    return [
        h('dl', { class: 'answers' }, good.map(([status, { description, content, headers }]) => [
            h('dt', {}, status),
            h('dd', {}, description,
                content ? h('ul', {}, contentNodes(content, link)) : '',
                headers ? h('p', { class: 'small' }, 'Headers: ', Object.keys(headers).join(', ')) : ''),
        ])),
        h('p', {}, 'Refusals: ', refused.map((status, i) => [i > 0 ? ', ' : '', h('a', { href: link(`/docs/problems#status-${status}`) }, status)]), '. Each is a ',
            h('a', { href: link('/docs/types/problem') }, 'problem'), '.'),
    ];
}

function parametersTable(parameters, link) {
    return table(['Parameter', 'In', 'Type', 'Meaning'], parameters.map((each) => [
        [code(each.name), each.required ? h('span', { class: 'must' }, ' required') : ''],
        each.in, typeNodes(each.schema, link), inline(each.description ?? '', link),
    ]), 'Parameters');
}

// Returns the example of an answer that the OpenAPI document has, or undefined.
function exampleOf({ responses }) {
    const bodies = Object.entries(responses)
        .filter(([status]) => status < 300)
        .flatMap(([, { content = {} }]) => Object.entries(content));
    const [media, found] = bodies.find(([, { example }]) => example !== undefined) ?? [];
    return found === undefined ? undefined : answerText({
        media, bytes: 1, text: typeof found.example === 'string' ? found.example : JSON.stringify(found.example),
    });
}

function roleOf({ security }) {
    return security?.flatMap((each) => each.token ?? [])[0];
}

export function routePages({ openapi, problems, examples }) {
    const routes = Object.entries(openapi.paths).flatMap(([path, { parameters = [], ...methods }]) =>
        Object.entries(methods).map(([method, operation]) => ({ path, method: method.toUpperCase(), shared: parameters, operation })));
    const tags = openapi.tags.map((tag) => ({ ...tag, routes: routes.filter(({ operation }) => operation.tags.includes(tag.name)) }));
    const pages = routes.map(({ path, method, shared, operation }) => {
        const { operationId: id, summary, description, requestBody } = operation;
        const { setup, request, answer, run } = examples.routes[id];
        const parameters = [...shared, ...operation.parameters];
        const tag = tags.find(({ name }) => operation.tags.includes(name));
        const role = roleOf(operation);
        const isPage = !run && Object.keys(operation.responses['200']?.content ?? {}).some((media) => media === 'text/html');
        return {
            path: `docs/routes/${id}`,
            title: summary,
            lead: description,
            words: `${id} ${method} ${path} ${parameters.map(({ name }) => name).join(' ')}`,
            kind: 'route',
            label: `${method} ${path}`,
            group: 'docs/routes',
            siblings: tag.routes.map((each) => ({ path: `docs/routes/${each.operation.operationId}`, title: each.operation.summary })),
            crumbs: [{ path: 'docs/routes', title: 'Routes' }],
            body: (link) => [
                h('p', { class: 'route' }, h('span', { class: `method ${method.toLowerCase()}` }, method), ' ', h('code', {}, path)),
                h('p', { class: 'small' }, code(id), role ? ` - if the server needs tokens, one with the role ${role} or more` : ' - needs no token'),
                h('h2', { id: 'try' }, 'Try it'),
                setupBlock(setup),
                requestBlock(request, { answer, edit: true, run, shown: answer === undefined ? exampleOf(operation) : undefined }),
                isPage ? h('p', {}, h('a', { href: link(request.path) }, 'Open the page')) : '',
                parameters.length === 0 ? '' : [h('h2', { id: 'parameters' }, 'Parameters'), parametersTable(parameters, link)],
                requestBody === undefined ? '' : [
                    h('h2', { id: 'body' }, requestBody.required ? 'Body' : 'Body (optional)'),
                    h('ul', {}, contentNodes(requestBody.content, link)),
                ],
                h('h2', { id: 'answers' }, 'Answers'),
                answersList(operation.responses, problems, link),
            ],
        };
    });
    const index = {
        path: 'docs/routes',
        title: 'Routes',
        lead: `The ${routes.length} requests that the server answers. Every GET also answers HEAD.`,
        kind: 'list',
        group: 'docs/routes',
        body: (link) => tags.map(({ name, description, routes: rows }) => [
            h('h2', { id: name }, name[0].toUpperCase() + name.slice(1)),
            h('p', {}, inline(description, link)),
            table(['Request', 'What it does'], rows.map(({ path, method, operation }) => [
                [h('span', { class: `method ${method.toLowerCase()}` }, method), ' ', h('code', {}, path)],
                h('a', { href: link(`/docs/routes/${operation.operationId}`) }, operation.summary),
            ]), name),
        ]),
    };
    return [index, ...pages];
}

// --- problems ---

const STATUS_WORDS = {
    400: 'The request is wrong', 401: 'No token', 403: 'Not allowed', 404: 'Not found', 405: 'Wrong method', 406: 'No acceptable form',
    408: 'Too slow', 409: 'Not now', 410: 'Gone', 412: 'The mesh has changed', 413: 'Too large', 414: 'Too long', 415: 'Unknown type',
    421: 'Wrong host', 422: 'The mesh does not allow it', 429: 'Too many', 431: 'Headers too large', 500: 'An error of the server',
    501: 'Not implemented', 503: 'Try again later', 505: 'Wrong version', 507: 'No room',
};

export function problemPages({ problems, operations, openapi, examples }) {
    const statuses = [...new Set(problems.map(({ status }) => status))].sort((a, b) => a - b);
    const pages = problems.map(({ code: slug, status, title, doc }) => {
        const { cure, when, example } = examples.problems[slug];
        const users = operations.filter(({ refusals }) => refusals.includes(slug));
        const rows = problems.filter((each) => each.status === status);
        return {
            path: `docs/problems/${slug}`,
            title,
            lead: doc,
            words: `${slug} ${status} ${cure}`,
            kind: 'problem',
            label: slug,
            group: 'docs/problems',
            siblings: rows.map((each) => ({ path: `docs/problems/${each.code}`, title: each.code })),
            crumbs: [{ path: 'docs/problems', title: 'Problems' }, { path: `docs/problems#status-${status}`, title: `${status} ${STATUS_WORDS[status]}` }],
            body: (link) => [
                h('p', { class: 'small' }, code(slug), ` with the HTTP status ${status}`),
                h('h2', { id: 'cure' }, 'What to do'),
                h('p', { class: 'cure' }, inline(cure, link)),
                h('h2', { id: 'example' }, 'Example'),
                when === undefined ? '' : h('p', {}, inline(when, link)),
                example === undefined ? [
                    h('p', {}, 'The answer then has these members, and a ', code('detail'), ' that says more:'),
                    h('pre', { tabindex: 0 }, h('code', {}, JSON.stringify({ type: `/problems/${slug}`, title, status, code: slug }, null, 2))),
                ] : [
                    example.runs ? '' : h('p', {}, example.flags ? ['This server was started with ', code(example.flags.join(' ')), '.'] : 'This server was started with a file of tokens.'),
                    setupBlock(example.setup, 'First'),
                    requestBlock(shortened(example.request), { answer: example.answer, run: example.runs && isShort(example.request), edit: true }),
                ],
                users.length === 0 ? '' : [
                    h('h2', { id: 'operations' }, 'Operations that answer it'),
                    h('ul', { class: 'columns-list' }, users.map(({ name }) => h('li', {}, h('a', { href: link(`/docs/operations/${name}`) }, name)))),
                ],
            ],
        };
    });
    const index = {
        path: 'docs/problems',
        title: 'Problems',
        lead: `A refused request is answered with a problem: a JSON object whose member \`code\` is one of these ${problems.length}. [The guide to errors](/docs/guides/errors) says how a program should treat them.`,
        kind: 'list',
        group: 'docs/problems',
        body: (link) => [
            // Statuses that routes declare but no code has as its usual one have no table.
            h('p', { class: 'jump' }, 'HTTP status: ', statuses.map((status) => [h('a', { href: `#status-${status}` }, String(status)), ' '])),
            ...statuses.map((status) => [
                h('h2', { id: `status-${status}` }, `${status} ${STATUS_WORDS[status]}`),
                table(['Code', 'Meaning'], problems.filter((each) => each.status === status).map(({ code: slug, title }) => [
                    h('a', { href: link(`/docs/problems/${slug}`) }, code(slug)), title,
                ]), `Status ${status}`),
            ]),
        ],
    };
    return [index, ...pages];
}

// A request whose path or header is only long is shown shorter, and cannot be run.
const LONG = 300;

function isShort({ path, headers = {} }) {
    return path.length < LONG && Object.values(headers).every((value) => value.length < LONG) && !('Host' in headers) && !('Origin' in headers)
        && !('Cookie' in headers) && !('Content-Length' in headers) && !('Transfer-Encoding' in headers);
}

function shortened(step) {
    const cut = (text) => (text.length > LONG ? `${text.slice(0, 60)}…` : text);
    return {
        ...step,
        path: cut(step.path),
        ...(step.headers && { headers: Object.fromEntries(Object.entries(step.headers).map(([name, value]) => [name, cut(value.replace('TOKEN', 'hedge_…'))])) }),
    };
}

// --- types ---

// Returns a map from the names of schemas to the addresses of their pages. What an operation takes, and
// what it gives, is on its own page.
export function schemaPathsOf({ openapi, operations }) {
    const paths = new Map(Object.keys(openapi.components.schemas).map((name) => [name, `/docs/types/${name}`]));
    for (const { name } of operations) {
        paths.set(`op_${name}`, `/docs/operations/${name}`);
        paths.set(`done_${name}`, `/docs/operations/${name}`);
    }
    return paths;
}

export function typePages(recorded) {
    const { openapi } = recorded;
    const { schemas } = openapi.components;
    const paths = schemaPathsOf(recorded);
    const names = Object.keys(schemas).filter((name) => paths.get(name).startsWith('/docs/types/'));
    const users = usersOf(openapi, paths);
    const group = (name) => (/^shape_/.test(name) ? 'Shapes' : /^(walk|walked)_/.test(name) ? 'Walks' : schemas[name].properties ? 'Objects' : 'Values and choices');
    const groups = ['Objects', 'Values and choices', 'Shapes', 'Walks'].map((title) => ({ title, rows: names.filter((name) => group(name) === title).sort() }));
    const pages = names.map((name) => ({
        path: `docs/types/${name}`,
        title: name,
        lead: schemas[name].description,
        words: Object.keys(schemas[name].properties ?? {}).join(' '),
        kind: 'type',
        group: 'docs/types',
        crumbs: [{ path: 'docs/types', title: 'Types' }],
        body: (link) => [
            ...schemaNodes(schemas[name], link),
            (users.get(name) ?? []).length === 0 ? '' : [
                h('h2', { id: 'used' }, 'Used by'),
                h('ul', { class: 'columns-list' }, [...users.get(name)].map(([path, title]) => h('li', {}, h('a', { href: link(path) }, title)))),
            ],
        ],
    }));
    const index = {
        path: 'docs/types',
        title: 'Types',
        lead: 'The objects and values of requests and answers, as the [OpenAPI document](/v1/openapi.json) names them. What an operation takes and gives is on [its page](/docs/operations).',
        kind: 'list',
        wide: true,
        group: 'docs/types',
        body: (link) => groups.map(({ title, rows }) => [
            h('h2', { id: title.toLowerCase().replaceAll(' ', '-') }, title),
            h('ul', { class: 'columns-list' }, rows.map((name) => h('li', {}, h('a', { href: link(`/docs/types/${name}`) }, name)))),
        ]),
    };
    return [index, ...pages];
}

// Returns for each schema the pages that name it: a map from the name to a map from paths to titles.
function usersOf({ paths, components }, pages) {
    const users = new Map();
    const note = (value, path, title) => {
        for (const [, name] of JSON.stringify(value).matchAll(/"#\/components\/schemas\/([a-z_0-9]+)"/g)) {
            if (!users.has(name)) {
                users.set(name, new Map());
            }
            users.get(name).set(path, title);
        }
    };
    for (const methods of Object.values(paths)) {
        for (const operation of Object.values(methods).filter(({ operationId }) => operationId)) {
            note(operation, `/docs/routes/${operation.operationId}`, operation.summary);
        }
    }
    for (const [name, schema] of Object.entries(components.schemas)) {
        const page = pages.get(name);
        note(schema, page, page.slice(page.lastIndexOf('/') + 1));
    }
    return users;
}
