// schema.js - reads the server's OpenAPI document: describes JSON Schemas in words, for the manual,
// and finds what the forms of the page offer. Pure: no document, no server.

// Returns the name of the schema that a reference points to, which is the reference's last segment.
function nameOf(reference) {
    return reference.slice(reference.lastIndexOf('/') + 1);
}

// Returns the schemas that a schema lists in oneOf, anyOf or allOf; none if it lists none.
export function alternatives(schema) {
    return schema.oneOf ?? schema.anyOf ?? schema.allOf ?? [];
}

function join(schemas, word) {
    return schemas.flatMap((schema, i) => [...(i === 0 ? [] : [word]), ...typeOf(schema)]);
}

function range({ minimum, maximum, exclusiveMinimum, exclusiveMaximum }) {
    const parts = [];
    if (exclusiveMinimum !== undefined) {
        parts.push(`above ${exclusiveMinimum}`);
    } else if (minimum !== undefined) {
        parts.push(`from ${minimum}`);
    }
    if (exclusiveMaximum !== undefined) {
        parts.push(`below ${exclusiveMaximum}`);
    } else if (maximum !== undefined) {
        parts.push(`to ${maximum}`);
    }
    return parts.map((part) => ` ${part}`).join('');
}

function arrayOf({ items, minItems = 0, maxItems }) {
    if (maxItems === 0) {
        return ['empty array'];
    }
    if (minItems === maxItems) {
        return [`${minItems} of `, ...typeOf(items)];
    }
    return [minItems > 0 ? 'non-empty array of ' : 'array of ', ...typeOf(items)];
}

function basic(schema) {
    if (schema.const !== undefined) {
        return [JSON.stringify(schema.const)];
    }
    if (schema.enum) {
        return [schema.enum.map((value) => JSON.stringify(value)).join(' or ')];
    }
    if (schema.type === 'array') {
        return arrayOf(schema);
    }
    const type = Array.isArray(schema.type) ? schema.type.join(' or ') : schema.type;
    const form = schema.format ?? schema.pattern;
    return [`${type ?? 'anything'}${range(schema)}${form === undefined ? '' : ` (${form})`}`];
}

// Returns a description of the values that a schema allows, as an array whose items are texts or,
// for a reference to another schema, {ref: NAME}.
export function typeOf(schema) {
    const parts = schema.$ref
        ? [{ ref: nameOf(schema.$ref) }]
        : schema.oneOf || schema.anyOf
          ? join(alternatives(schema), ' or ')
          : schema.allOf
            ? join(schema.allOf, ' and ')
            : basic(schema);
    return schema.default === undefined
        ? parts
        : [...parts, `; ${JSON.stringify(schema.default)} if not given`];
}

// --- forms ---

// Returns the query parameters of an operation, {name, doc, values} each, where `values` are the
// texts that a parameter, or each item of its list, may have, or undefined. `id` is the operationId.
export function parametersOf({ paths }, id) {
    const found = Object.values(paths)
        .flatMap((methods) => Object.values(methods))
        .find(({ operationId }) => operationId === id);
    return found.parameters
        .filter((parameter) => parameter.in === 'query')
        .map(({ name, description, schema }) => ({ name, doc: description, values: schema.enum ?? schema.items?.enum }));
}

// Returns the shapes from which the server makes meshes: {name, doc, params} each; the params are
// {name, doc, type, default, min, max, exclusive}, where `exclusive` says that `min` itself is not
// allowed.
export function shapesOf({ components: { schemas } }) {
    return Object.entries(schemas.shape.discriminator.mapping).map(([name, reference]) => {
        const { description, properties } = schemas[nameOf(reference)];
        const params = Object.entries(properties)
            .filter(([param]) => param !== 'shape' && param !== 'name')
            .map(([param, schema]) => ({
                name: param,
                doc: schema.description ?? '',
                type: schema.type,
                default: schema.default,
                min: schema.minimum ?? schema.exclusiveMinimum,
                max: schema.maximum,
                exclusive: schema.exclusiveMinimum !== undefined,
            }));
        return { name, doc: description, params };
    });
}
