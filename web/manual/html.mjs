// html.mjs - writes trees of [tag, attributes, children] and texts as HTML.

const VOID = new Set(['br', 'hr', 'img', 'input', 'link', 'meta']);
const ESCAPES = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };

export function escape(text) {
    return String(text).replace(/[&<>"]/g, (character) => ESCAPES[character]);
}

// A text that is HTML already.
export class Html {
    constructor(text) {
        this.text = text;
    }
}

// Returns a tree; attributes whose value is undefined or false are left out.
export function h(tag, attributes = {}, ...children) {
    return [tag, attributes, children];
}

function isPlainObject(value) {
    return typeof value === 'object' && value !== null && !Array.isArray(value) && !(value instanceof Html);
}

// Writes a tree, a text, or a list of them.
export function write(tree) {
    if (tree === undefined || tree === null || tree === false) {
        return '';
    }
    if (tree instanceof Html) {
        return tree.text;
    }
    if (!Array.isArray(tree)) {
        return escape(tree);
    }
    const [tag, attributes, children] = tree;
    if (typeof tag !== 'string' || !isPlainObject(attributes)) {
        return tree.map(write).join('');
    }
    const written = Object.entries(attributes)
        .filter(([, value]) => value !== undefined && value !== false)
        .map(([name, value]) => (value === true ? ` ${name}` : ` ${name}="${escape(value)}"`))
        .join('');
    return `<${tag}${written}>${VOID.has(tag) ? '' : `${write(children)}</${tag}>`}`;
}
