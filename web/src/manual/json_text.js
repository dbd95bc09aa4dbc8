// json_text.js - writes JSON for readers: short objects and lists in one line, others with a member a
// line; long lists are cut. Pure: no document, no server.

const WIDTH = 78;

// Writes a value, continued lines indented by `indent` blanks. A list with more than `most` items
// shows only the first half of that many, and says how many follow.
export function formatJson(value, { indent = 0, most = Infinity, room = WIDTH } = {}) {
    const flat = inline(value, most);
    if (flat.length + indent <= room || typeof value !== 'object' || value === null) {
        return flat;
    }
    const pad = ' '.repeat(indent + 2);
    const inner = (each) => formatJson(each, { indent: indent + 2, most, room });
    if (Array.isArray(value)) {
        const lines = isPlain(value) ? wrap(shown(value, most), indent + 2, room) : shown(value, most, inner);
        return `[\n${lines.map((line) => pad + line).join(isPlain(value) ? '\n' : ',\n')}\n${' '.repeat(indent)}]`;
    }
    const members = Object.entries(value).map(([name, each]) => `${pad}${JSON.stringify(name)}: ${inner(each)}`);
    return `{\n${members.join(',\n')}\n${' '.repeat(indent)}}`;
}

function isPlain(list) {
    return list.every((each) => typeof each !== 'object' || each === null || (Array.isArray(each) && each.length < 6));
}

// Returns the items of a list as texts; what is left out is told by the last one.
function shown(list, most, write = (each) => inline(each, most)) {
    if (list.length <= most) {
        return list.map(write);
    }
    const first = list.slice(0, Math.ceil(most / 2));
    return [...first.map(write), `… ${list.length - first.length} more`];
}

function inline(value, most) {
    if (Array.isArray(value)) {
        return `[${shown(value, most).join(', ')}]`;
    }
    if (typeof value === 'object' && value !== null) {
        const members = Object.entries(value).map(([name, each]) => `${JSON.stringify(name)}: ${inline(each, most)}`);
        return `{${members.join(', ')}}`;
    }
    return JSON.stringify(value);
}

// Joins texts to lines that are not too long.
function wrap(texts, indent, room) {
    const lines = [''];
    texts.forEach((text, i) => {
        const piece = text + (i < texts.length - 1 ? ',' : '');
        const last = lines.at(-1);
        if (last !== '' && last.length + 1 + piece.length + indent > room) {
            lines.push(piece);
        } else {
            lines[lines.length - 1] = last === '' ? piece : `${last} ${piece}`;
        }
    });
    return lines;
}
