// operation_pages.mjs - the pages about operations.

import { draw, frameOf } from '../src/manual/drawing.js';
import { idsOf, listedSets, markSets, noMarks, sentenceOf } from '../src/manual/told.js';
import { h } from './html.mjs';
import { inline } from './markdown.mjs';
import { code, requestBlock, setupBlock, table, typeNodes } from './parts.mjs';

// The families of operations, by the beginning of their names or by the names themselves.
const FAMILIES = [
    ['Vertices', /^vertex_/],
    ['Edges', /^edge_/],
    ['Faces', /^face_/],
    ['Loops and holes', /^(loop_|hole_fill|fill_holes)/],
    ['Shape of the whole mesh', /^(transform|smooth|deform|remesh|subdivide|decimate|delaunay|triangulate|dual|reverse|append)$/],
    ['Cutting and cleaning', /^(plane_|weld$|separate_bowties|delete_isolated|compact)/],
    ['Sets, materials and measures', /./],
];

// Drawings of larger meshes are not shown in the list of operations.
const SMALL = 30;

export function familyOf(name) {
    return FAMILIES.find(([, pattern]) => pattern.test(name))[0];
}

// Returns the marks of the elements that the request of an example names, by the table of parameters.
function pickedBy(body, params) {
    const marks = noMarks();
    const arrows = [];
    for (const { name, plural, each, type } of params) {
        const list = plural ?? each;
        const ids = [body[name] ?? (list && body[list]) ?? []].flat().filter(Number.isInteger);
        if (type === 'halfedge') {
            arrows.push(...ids.map((id) => ({ id, name: `${name} (h${id})`, kind: 'picked' })));
        }
        const kind = { vertices: 'vertex', edges: 'edge', faces: 'face' }[type] ?? type;
        for (const id of marks[kind] ? ids : []) {
            marks[kind].set(id, 'picked');
        }
    }
    return { marks, arrows };
}

// Returns the drawings {before, after} of an example.
function drawingsOf(name, { before, after, view, request, answer, selected }, params) {
    const told = JSON.parse(answer.text);
    const frame = frameOf([before, after], view);
    const old = pickedBy(request.body, params);
    markSets(old.marks, told.deleted, 'gone');
    const made = noMarks();
    const isLarge = after.faces.length > SMALL;
    markSets(made, isLarge ? {} : told.created, 'new');
    for (const [i, value] of (selected?.values ?? []).entries()) {
        if (value === true) {
            made.face.set(after.faces[i].id, 'new');
        }
    }
    const gone = listedSets(told.deleted);
    const created = listedSets(told.created);
    return {
        gone, created, moved: listedSets(told.modified),
        before: draw(before, frame, { ...old, ids: idsOf(before, view, old.marks), title: sentenceOf(`Before ${name}`, before, gone && ` It deletes ${gone}.`) }),
        after: draw(after, frame, { marks: made, ids: idsOf(before, view, made), title: sentenceOf(`After ${name}`, after, created && ` New: ${created}.`) }),
    };
}

function countsTable(before, after) {
    if (before.counts === null) {
        return '';
    }
    const row = (label, old, now) => [label, String(old), String(now), now - old === 0 ? '0' : (now > old ? '+' : '−') + Math.abs(now - old)];
    return table(['Number of', 'Before', 'After', 'Change'], [
        row('Vertices', before.counts.vertices, after.counts.vertices),
        row('Edges', before.counts.edges, after.counts.edges),
        row('Faces', before.counts.faces, after.counts.faces),
        row('Euler characteristic', before.euler, after.euler),
    ], 'Numbers of elements', 'numbers');
}

const PARAMETER_TYPES = {
    flag: 'true or false', point: 'point [x, y, z]', points: 'point, or list of points', text: 'text', mesh: 'id of a mesh',
    matrix: '16 numbers, row by row', matrix_projective: '16 numbers, row by row', polygon: 'list of points [x, y]',
    color: '3 numbers', color_alpha: '3 or 4 numbers',
};

// Writes a limit of a number.
function limit(value) {
    return value === Math.PI ? '\u03c0' : String(value);
}

function parameterType({ type, plural, each, choices, min, max, exclusive, nullable, set, unit }) {
    const list = plural ?? each;
    const base = choices !== undefined ? choices.join(', ') : PARAMETER_TYPES[type] ?? (['vertex', 'edge', 'face', 'halfedge'].includes(type) ? `id of a ${type === 'halfedge' ? 'half-edge' : type}` : type);
    const range = min === undefined ? '' : exclusive
        ? ` above ${limit(min)}${max < 1e300 ? `, below ${limit(max)}` : ''}`
        : max >= 1e300 ? (min <= -1e300 ? '' : ` from ${limit(min)}`) : ` from ${limit(min)} to ${limit(max)}`;
    const more = `${nullable ? ', or null' : ''}${list && list !== undefined ? `, or a list in ${list}${set ? ', or a set' : ''}` : ''}`;
    return base + (unit === undefined ? '' : ` in ${unit},`) + range + more;
}

// Says which parameters of an operation are alternatives of one of them.
function alternativesOf({ group, required }, params) {
    const names = params.filter((each) => group !== undefined && each.group === group).map(({ name }) => name);
    return names.length < 2 ? '' : [` Give ${required ? 'exactly' : 'at most'} one of `, names.map((name, i) => [i > 0 ? ', ' : '', code(name)]), '.'];
}

// Returns the name of the list that may be given instead of one value, if it has a name of its own.
function listNames({ name, plural, each }) {
    const list = plural ?? each ?? name;
    return list === name ? '' : [', ', code(list)];
}

// Says what it means to give a list.
function listText({ plural, each }) {
    return each === undefined || plural !== undefined ? '' : [' The operation runs once for each item of a list in ', code(each), ', in order.'];
}

function parametersTable(params, link) {
    if (params.length === 0) {
        return h('p', {}, 'It has no parameters.');
    }
    return table(['Parameter', 'Value', 'Default', 'Meaning'], params.map((param) => [
        [code(param.name), listNames(param),
            param.required || param.required_with ? h('span', { class: 'must' }, param.group ? ' or another' : ' required') : ''],
        parameterType(param),
        param.default === undefined ? '' : String(param.default),
        [inline(param.doc, link), param.with ? ` Only with ${param.with.join(', ')}.` : '', alternativesOf(param, params), listText(param)],
    ]), 'Parameters');
}

function resultsTable(results, link) {
    if (results.length === 0) {
        return '';
    }
    return [h('h2', { id: 'results' }, 'Results'), table(['Result', 'Type', 'Meaning'], results.map(({ name, type, unit, choices, doc }) => [
        code(name), choices?.join(', ') ?? (unit === undefined ? type : `${type} in ${unit}`), inline(doc, link),
    ]), 'Results')];
}

function refusalsTable(refusals, problems, link) {
    if (refusals.length === 0) {
        return h('p', {}, 'The mesh never forbids it.');
    }
    return table(['Code', 'Why', 'What to do'], refusals.map((slug) => [
        h('a', { href: link(`/docs/problems/${slug}`) }, code(slug)), problems[slug].title, inline(problems[slug].cure, link),
    ]), 'Refusals');
}

// Returns the pages of all operations, and of the list of them.
export function operationPages({ operations, problems, examples }) {
    const told = Object.fromEntries(problems.map((row) => [row.code, { ...row, cure: examples.problems[row.code].cure }]));
    const drawn = new Map(operations.map(({ name, params }) => [name, drawingsOf(name, examples.operations[name], params)]));
    const families = FAMILIES.map(([title]) => ({ title, rows: operations.filter(({ name }) => familyOf(name) === title) }));
    const pages = operations.map((operation) => {
        const { name, doc, params, results, refusals, change, size } = operation;
        const example = examples.operations[name];
        const pictures = drawn.get(name);
        const family = families.find(({ rows }) => rows.includes(operation));
        return {
            path: `docs/operations/${name}`,
            title: name,
            lead: doc,
            words: `${example.use} ${params.map((param) => param.name).join(' ')}`,
            kind: 'operation',
            group: 'docs/operations',
            siblings: family.rows.map((row) => ({ path: `docs/operations/${row.name}`, title: row.name })),
            crumbs: [{ path: 'docs/operations', title: 'Operations' }],
            body: (link) => [
                h('p', {}, inline(example.use, link)),
                h('figure', { class: 'pair', 'data-operation': name, 'data-view': example.view },
                    h('div', {}, h('p', { class: 'small' }, 'Before'), pictures.before),
                    h('div', { class: 'after' }, h('p', { class: 'small' }, 'After'), pictures.after),
                    h('figcaption', {},
                        pictures.gone ? [h('span', { class: 'key gone' }, 'Deleted'), ` ${pictures.gone}. `] : '',
                        pictures.created ? [h('span', { class: 'key new' }, 'New'), ` ${pictures.created}. `] : '',
                        pictures.moved && !pictures.created && !pictures.gone ? [h('span', { class: 'key' }, 'Changed'), ` ${pictures.moved}. `] : '',
                        example.moved ? 'In the drawing, the new vertices were moved aside, so that they can be seen.' : '')),
                countsTable(example.before, example.after),
                h('p', { class: 'small' }, change === null
                    ? 'The change in numbers depends on the mesh.'
                    : 'The change in numbers is always this one.', ' ',
                size === 'local' ? 'Its time depends on the elements around it, not on the size of the mesh.' : 'Its time grows with the mesh; a long one becomes a job.'),
                h('h2', { id: 'try' }, 'Try it'),
                setupBlock(example.setup),
                requestBlock(example.request, { answer: example.answer, edit: true }),
                h('h2', { id: 'parameters' }, 'Parameters'),
                parametersTable(params, link),
                h('p', { class: 'small' }, 'The edit may also have ', code('dry_run'), ', ', code('expected_revision'), ' and, in a list of edits, ', code('as'),
                    ': see ', h('a', { href: link('/docs/guides/batches') }, 'lists of edits'), '. The route is ',
                    h('a', { href: link('/docs/routes/apply_edits') }, 'POST /v1/meshes/{mesh}/edits'), '.'),
                resultsTable(results, link),
                h('h2', { id: 'refusals' }, 'Refusals'),
                refusalsTable(refusals, told, link),
                h('p', { class: 'small' }, 'A refused edit leaves the mesh exactly as it was.'),
            ],
        };
    });
    const index = {
        path: 'docs/operations',
        title: 'Operations',
        lead: `The ${operations.length} edits of a mesh. Each is sent to [POST /v1/meshes/{mesh}/edits](/docs/routes/apply_edits), alone or in a [list](/docs/guides/batches).`,
        kind: 'list',
        wide: true,
        group: 'docs/operations',
        body: (link) => families.map(({ title, rows }) => [
            h('h2', { id: title.toLowerCase().replaceAll(/[^a-z]+/g, '-') }, title),
            h('ul', { class: 'gallery' }, rows.map(({ name, doc }) => h('li', {},
                h('a', { href: link(`/docs/operations/${name}`) },
                    examples.operations[name].after.faces.length <= SMALL ? h('span', { class: 'thumb', 'aria-hidden': 'true' }, plainDrawing(drawn.get(name).after)) : '',
                    h('strong', {}, name)),
                h('span', { class: 'small' }, inline(doc.split('. ')[0].replace(/\.$/, ''), link))))),
        ]),
    };
    return [index, ...pages];
}

// Returns a drawing without its texts, for readers who have the words beside it.
function plainDrawing([tag, attributes, children]) {
    const { role, 'aria-label': label, ...kept } = attributes;
    return [tag, kept, children.filter(([name]) => name !== 'text' && name !== 'g')];
}
