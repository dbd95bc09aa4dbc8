// contract.mjs - checks whether an exchange, a request with its answer, agrees with an OpenAPI
// document: paths, parameters, statuses, headers, media types, and bodies. Ajv compiles the schemas
// of the document.
//
// The check is stricter than what the document promises to clients: an object must have no member
// that its schema does not list, because such a member is undocumented. Clients must expect that a
// later version of the API adds members.

import { createRequire } from 'node:module';
import { gunzipSync } from 'node:zlib';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
const Ajv = require('ajv/dist/2020').default;
const addFormats = require('ajv-formats').default;

// Headers that an answer may have only if the document lists these headers.
const LISTED = [
    'etag', 'location', 'link', 'allow', 'retry-after', 'export-warnings', 'accept-encoding',
    'content-encoding',
];
// The statuses with which a request may be refused before the server looks at its path.
const BEFORE_ROUTING = [400, 403, 413, 414, 421, 429, 431, 501, 503, 505];
const PROBLEM = 'application/problem+json';
const PROBLEM_SCHEMA = { $ref: '#/components/schemas/problem' };

// --- closed schemas ---

// Returns a schema that refuses members which it does not list. The parts of an allOf stay open,
// because each part lists only some of the members; the whole allOf is closed instead.
function closed(schema, open) {
    if (Array.isArray(schema)) {
        return schema.map((each) => closed(each, open));
    }
    if (schema === null || typeof schema !== 'object') {
        return schema;
    }
    const result = {};
    for (const [key, value] of Object.entries(schema)) {
        if (key === '$ref') {
            result.$ref = open ? value.replace('/schemas/', '/open/') : value;
        } else if (key === 'allOf') {
            result.allOf = closed(value, true);
        } else if ((key === 'oneOf' || key === 'anyOf') && schema.properties !== undefined) {
            result[key] = closed(value, true);
        } else if (key === 'properties') {
            const members = Object.entries(value).map(([name, each]) => {
                return [name, closed(each, false)];
            });
            result.properties = Object.fromEntries(members);
        } else if (['oneOf', 'anyOf'].includes(key)) {
            result[key] = closed(value, open);
        } else if (['items', 'additionalProperties'].includes(key)) {
            result[key] = closed(value, false);
        } else if (key !== 'example' && key !== 'description') {
            result[key] = value;
        }
    }
    const lists = result.properties !== undefined || result.allOf !== undefined;
    const free = ['additionalProperties', 'unevaluatedProperties'].every((key) => !(key in result));
    if (!open && lists && free) {
        result.unevaluatedProperties = false;
    }
    return result;
}

function each(object, change) {
    return Object.fromEntries(Object.entries(object).map(([k, value]) => [k, change(value)]));
}

function newAjv({ components }) {
    const ajv = new Ajv({ allErrors: false, strict: false, discriminator: false });
    addFormats(ajv);
    const { schemas } = components;
    const root = {
        schemas: each(schemas, (schema) => closed(schema, false)),
        open: each(schemas, (schema) => closed(schema, true)),
    };
    ajv.addSchema({ $id: 'hedge', components: root });
    return ajv;
}

// --- messages ---

// Returns the headers of a message as a map from names in lower case to values. If a message has
// several heads, such as that of 100 Continue before that of the answer, only the last head counts.
function parseHead(head) {
    const block = head.trimEnd().split('\r\n\r\n').at(-1);
    const headers = new Map();
    for (const line of block.split('\r\n')) {
        const [, name, value] = /^([^\s:]+):[ \t]*(.*)$/.exec(line) ?? [];
        if (name !== undefined) {
            headers.set(name.toLowerCase(), value);
        }
    }
    return headers;
}

// Parses a recorded request or answer. A compressed body is decompressed if it was recorded
// completely and node knows the coding.
function parseMessage({ head, body, length }) {
    const headers = parseHead(head);
    const sent = Buffer.from(body ?? '', 'base64');
    const complete = body !== undefined && sent.length === length;
    const coding = sent.length > 0 ? headers.get('content-encoding')?.toLowerCase() : undefined;
    const unfolded = ['gzip', 'x-gzip'].includes(coding) && complete ? unfold(sent) : undefined;
    const plain = coding === undefined || coding === 'identity' || unfolded !== undefined;
    return {
        headers,
        known: body !== undefined,
        plain,
        whole: complete && plain,
        bytes: unfolded ?? sent,
        media: headers.get('content-type')?.split(';')[0].trim().toLowerCase(),
    };
}

function unfold(bytes) {
    try {
        return gunzipSync(bytes);
    } catch {
        return undefined; // the body is no gzip, for which the server refused the request
    }
}

const utf8 = new TextDecoder('utf-8', { fatal: true });

function isJson(media) {
    return media === 'application/json' || media.endsWith('+json');
}

// --- the contract ---

export class Contract {
    constructor(document) {
        this.document = document;
        this.ajv = newAjv(document);
        this.compiled = new Map(); // by the text of a schema
        this.checks = new Map(); // by the schema itself, an object of the document
        this.operations = [];
        this.paths = Object.entries(document.paths).map(([template, item]) => {
            const { parameters = [], ...methods } = item;
            const path = { template, segments: template.split('/'), parameters, methods: {} };
            for (const [method, operation] of Object.entries(methods)) {
                const found = { name: `${method.toUpperCase()} ${template}`, operation, hits: 0 };
                path.methods[method] = found;
                this.operations.push(found);
            }
            return path;
        });
        // Paths without variables are tried before paths that have variables in the same segments.
        this.paths.sort((a, b) => variables(a) - variables(b));
    }

    // Returns the operations that no exchange has reached with success.
    unreached() {
        return this.operations.filter(({ hits }) => hits === 0).map(({ name }) => name);
    }

    // Checks an exchange and returns {name, wrong}: its method, path and status, such as "GET
    // /v1/meshes 200", and a list of sentences about everything that is wrong with it.
    check(exchange) {
        const { method, target, status } = exchange;
        const [path, query] = target.split(/\?(.*)/s);
        const route = this.match(path);
        const name = `${method} ${route?.template ?? 'elsewhere'} ${status}`;
        return { name, wrong: this.findWrong(exchange, route, path, query) };
    }

    findWrong(exchange, route, path, query) {
        const wrong = [];
        const { method, status } = exchange;
        const request = parseMessage(exchange.request);
        const answer = parseMessage(exchange.answer);
        if (route === undefined && status === 308) {
            this.checkRedirect(path, answer, wrong);
            return wrong;
        }
        if (route === undefined) {
            if (status !== 404 && !BEFORE_ROUTING.includes(status)) {
                wrong.push(`the document has no such path, and the status is ${status}`);
            }
            this.checkProblem(exchange, answer, wrong);
            return wrong;
        }
        const found = route.methods[method === 'HEAD' ? 'get' : method.toLowerCase()];
        if (found === undefined) {
            this.checkMethods(exchange, route, answer, wrong);
            return wrong;
        }
        const response = this.resolve(found.operation.responses[status]);
        if (response === undefined) {
            wrong.push(`status ${status} is not declared`);
            return wrong;
        }
        // If the server did not keep the body of the first answer to a request with an idempotency
        // key, the answer to a repeated request has no body to check.
        if (!answer.headers.has('idempotency-replayed') || answer.bytes.length > 0) {
            this.checkHeaders(response, answer, wrong);
            this.checkBody(exchange, response, answer, wrong);
        }
        if (status < 400) {
            found.hits += 1;
            this.checkParameters(route, found.operation, path, query, request, wrong);
            this.checkRequest(found.operation, { ...request, query }, { ...answer, status }, wrong);
        }
        return wrong;
    }

    match(path) {
        const given = path.split('/');
        return this.paths.find(({ segments, parameters }) => {
            const values = variablesOf(segments, given);
            return values !== null && parameters.every((p) => allowed(p, values[p.name]));
        });
    }

    resolve(value) {
        return value?.$ref === undefined
            ? value
            : value.$ref.slice(2).split('/').reduce((at, name) => at[name], this.document);
    }

    // Returns what is wrong with a value according to a schema, or null if nothing is.
    validate(schema, value) {
        const check = this.compile(schema);
        return check(value) ? null : this.ajv.errorsText(check.errors, { dataVar: '' });
    }

    // Returns the function that ajv makes of a schema. Equal schemas share one, and an object that
    // was seen before is not even compared: there are hundreds of thousands of exchanges.
    compile(schema) {
        if (!this.checks.has(schema)) {
            const key = JSON.stringify(schema);
            if (!this.compiled.has(key)) {
                const rooted = JSON.parse(key.replaceAll('"#/', '"hedge#/'));
                this.compiled.set(key, this.ajv.compile(closed(rooted, false)));
            }
            this.checks.set(schema, this.compiled.get(key));
        }
        return this.checks.get(schema);
    }

    checkProblem({ method, status }, { media, whole, bytes }, wrong) {
        if (media !== PROBLEM) {
            wrong.push(`a refusal is ${PROBLEM}, not ${media}`);
        } else if (whole && method !== 'HEAD') {
            this.checkJson(PROBLEM_SCHEMA, bytes, wrong, (problem) => statusOf(problem, status));
        }
    }

    // Checks the redirect of a path with an extra slash at its end: it must lead to a path of the
    // document.
    checkRedirect(path, answer, wrong) {
        const base = `http://host${path}`;
        const { pathname } = new URL(answer.headers.get('location') ?? '', base);
        if (pathname !== path.slice(0, -1) || this.match(pathname) === undefined) {
            wrong.push(`${path} leads to ${pathname}`);
        }
    }

    checkMethods(exchange, { template, methods }, answer, wrong) {
        const { method, status } = exchange;
        if (status !== 405 && method === 'OPTIONS' && status === 204) {
            const preflight = answer.headers.has('access-control-allow-methods');
            if (!preflight && !answer.headers.has('allow')) {
                wrong.push('no Allow');
            }
            return;
        }
        if (status !== 405 && !BEFORE_ROUTING.includes(status)) {
            wrong.push(`${template} has no ${method}, and the status is ${status}`);
        }
        const names = Object.keys(methods).map((name) => name.toUpperCase());
        const wanted = [...names, ...(names.includes('GET') ? ['HEAD'] : []), 'OPTIONS'].sort();
        const allow = answer.headers.get('allow')?.split(/, */).sort().join();
        if (status === 405 && allow !== wanted.join()) {
            wrong.push(`Allow is ${allow} and not ${wanted}`);
        }
        this.checkProblem(exchange, answer, wrong);
    }

    checkHeaders({ headers = {} }, answer, wrong) {
        const names = Object.keys(headers).map((name) => name.toLowerCase());
        for (const [name, declared] of Object.entries(headers)) {
            const header = this.resolve(declared);
            const value = answer.headers.get(name.toLowerCase());
            if (value === undefined && header.required) {
                wrong.push(`no header ${name}`);
            } else if (value !== undefined && this.validate(header.schema, value) !== null) {
                wrong.push(`${name}: ${this.validate(header.schema, value)}`);
            }
        }
        for (const name of LISTED) {
            if (answer.headers.has(name) && !names.includes(name)) {
                wrong.push(`header ${name} is not declared`);
            }
        }
    }

    checkBody({ method, status }, response, { media, plain, whole, bytes, headers }, wrong) {
        const { content } = response;
        if (content === undefined) {
            if (bytes.length > 0) {
                wrong.push(`a body of ${media}, and none is declared`);
            }
            return;
        }
        if (content[media] === undefined) {
            wrong.push(`media type ${media} is not declared`);
            return;
        }
        const { schema, 'x-item-schema': item } = content[media];
        if (isJson(media) && schema === undefined) {
            wrong.push(`${media} is declared without a schema`);
        } else if (method === 'HEAD') {
            if (bytes.length > 0) {
                wrong.push('an answer to HEAD has a body');
            }
        } else if (isJson(media) && whole) {
            this.checkJson(schema, bytes, wrong, (value) => {
                return besides(value, status, response, headers);
            });
        } else if (media === 'text/event-stream' && plain) {
            this.checkEvents(schema.contentSchema.items, bytes, wrong);
        } else if (item !== undefined && plain) {
            this.checkLines(item, bytes, whole, wrong);
        }
    }

    checkJson(schema, bytes, wrong, more = () => null) {
        let value;
        try {
            value = JSON.parse(utf8.decode(bytes));
        } catch (error) {
            wrong.push(`the body is not JSON: ${error.message}`);
            return;
        }
        const error = this.validate(schema, value) ?? more(value);
        if (error !== null) {
            wrong.push(`body: ${error}`);
        }
    }

    checkLines(schema, bytes, whole, wrong) {
        const lines = bytes.toString().split('\n');
        const last = lines.pop(); // incomplete if the recording was cut, otherwise empty
        if (whole && last !== '') {
            wrong.push('the last line has no end');
        }
        for (const [i, line] of lines.entries()) {
            this.checkJson(schema, Buffer.from(line), wrong, (value) =>
                !whole || (value.end === true) === (i === lines.length - 1)
                    ? null
                    : `the end is not in line ${i + 1}`,
            );
        }
    }

    // Checks a recorded event stream. What follows the last empty line is an incomplete event, so
    // it is left out. A block without data is no event but a comment, or sets the last event's id.
    checkEvents(schema, bytes, wrong) {
        for (const block of bytes.toString().split('\n\n').slice(0, -1)) {
            const fields = Object.fromEntries(block.split('\n').map((line) => line.split(/: ?(.*)/s)));
            if (fields.data !== undefined) {
                const { event, id, data } = fields;
                const parts = { event, ...(id === undefined ? {} : { id }), data: JSON.parse(data) };
                const error = this.validate(schema, parts);
                if (error !== null) {
                    wrong.push(`event ${event}: ${error}`);
                }
            }
        }
    }

    // Checks the parameters of a request that was accepted.
    checkParameters({ segments, parameters }, operation, path, query, { headers }, wrong) {
        const values = variablesOf(segments, path.split('/'));
        for (const { name, schema } of parameters) {
            this.checkText(`{${name}}`, schema, values[name], wrong);
        }
        const declared = operation.parameters.filter((each) => each.in === 'query');
        const keys = Object.values(this.document.components.securitySchemes ?? {})
            .filter((scheme) => scheme.in === 'query')
            .map((scheme) => scheme.name);
        for (const [name, value] of new URLSearchParams(query ?? '')) {
            if (keys.includes(name)) {
                continue; // an access token, which belongs to the security scheme
            }
            const parameter = declared.find((p) => p.name === name);
            if (parameter === undefined) {
                wrong.push(`query parameter ${name} is not declared`);
            } else {
                this.checkText(name, parameter.schema, value, wrong);
            }
        }
        for (const name of ['If-Match', 'If-None-Match', 'Prefer']) {
            const known = operation.parameters.some((p) => p.in === 'header' && p.name === name);
            if (headers.has(name.toLowerCase()) && !known && operation.requestBody !== undefined) {
                wrong.push(`header ${name} of the request is not declared`);
            }
        }
    }

    checkText(name, schema, text, wrong) {
        const { type } = this.resolve(schema);
        const isNumber = (type === 'integer' || type === 'number') && text !== '';
        const value = isNumber ? Number(text) : type === 'array' ? text.split(',') : text;
        const error = this.validate(schema, value);
        if (error !== null) {
            wrong.push(`${name}=${text}: ${error}`);
        }
    }

    checkRequest({ requestBody }, { known, whole, bytes, media, query }, answer, wrong) {
        if (!known) {
            return;
        }
        if (bytes.length === 0) {
            if (requestBody?.required) {
                wrong.push('the body is required, and was taken without');
            }
            return;
        }
        const content = requestBody?.content[media];
        if (content === undefined && standsForAny(media) && namesFormat(query)
            && requestBody?.content['application/octet-stream'] !== undefined) {
            return; // ?format= in the query says what the body is, so that its type does not count
        } else if (content === undefined) {
            wrong.push(`a body of ${media} is not declared, and was taken`);
        } else if (answer.status === 202 && READS_AS_JOBS.test(content.schema?.$ref)) {
            return; // the request became a job, so the server has not read its body yet
        } else if (content.schema !== undefined && isJson(media) && whole && !namesFormat(query)) {
            const { schema } = content;
            const taken = schema.$ref?.endsWith('/query') ? takenOf(bytes, answer) : bytes;
            this.checkJson(schema, taken, wrong);
        }
    }
}

const READS_AS_JOBS = /\/(query|walk)$/;

// Returns whether a program sends this media type for bytes of any kind: curl sends none with -T,
// and the type of a form with --data-binary.
const standsForAny = (media) =>
    [undefined, 'text/plain', 'application/x-www-form-urlencoded'].includes(media);

// Returns whether ?format= names another format for the body than its Content-Type does.
const namesFormat = (query) =>
    !['json', null].includes(new URLSearchParams(query ?? '').get('format'));

// Checks what a schema cannot express: that a header of an answer agrees with a member of its body.
function besides(value, status, response, headers) {
    const paged = response.headers?.Link !== undefined;
    if (paged && (value.next !== null) !== headers.has('link')) {
        return `next is ${value.next} and Link is ${headers.get('link')}`;
    }
    if (status >= 400) {
        return statusOf(value, status);
    }
    if (value.results !== undefined && value.created !== undefined && !value.dry_run) {
        return headers.has('etag') ? null : 'no ETag of what an edit made';
    }
    return null;
}

// Returns the body of a request to /query without the questions that the server refused. The answer
// has a problem object in place of the answer to each such question, and the question may disagree
// with the schema.
function takenOf(bytes, { media, whole, bytes: answer }) {
    if (media !== 'application/json' || !whole) {
        return bytes;
    }
    const { queries, ...rest } = JSON.parse(utf8.decode(bytes));
    const { results } = JSON.parse(utf8.decode(answer));
    const taken = queries.filter((_, i) => !(results[i]?.status >= 400));
    return Buffer.from(JSON.stringify({ queries: taken, ...rest }));
}

function statusOf(problem, status) {
    return problem.status === status ? null : `its status says ${problem.status}`;
}

function variables({ template }) {
    return template.split('{').length;
}

// Returns the values that the segments of a path have for the variables of a template such as
// /meshes/{mesh}, whose segments are `wanted`, or null if the path does not fit the template.
function variablesOf(wanted, path) {
    const last = wanted.length - 1;
    // {asset} stands for the rest of a path, slashes included (route.h).
    const given = wanted[last] === '{asset}' && path.length > wanted.length
        ? [...path.slice(0, last), path.slice(last).join('/')]
        : path;
    if (wanted.length !== given.length) {
        return null;
    }
    const values = {};
    for (let i = 0; i < wanted.length; i++) {
        const text = decode(given[i]);
        if (wanted[i].startsWith('{') && text !== '') {
            values[wanted[i].slice(1, -1)] = text;
        } else if (wanted[i] !== text) {
            return null;
        }
    }
    return values;
}

function decode(text) {
    if (!text.includes('%')) {
        return text;
    }
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}

// Returns whether a variable of a path may have this value. Only enumerations are checked here,
// because they decide which template the path matches; other schemas are checked later.
function allowed({ schema }, value) {
    return schema.enum === undefined || schema.enum.includes(value);
}
