// numbers.js - parses numbers as people write and paste them. Pure.

import { Problem } from '../wire/api.js';

// Characters that may separate numbers or enclose a list of numbers.
const BETWEEN = /[\s,;()[\]]+/;

export function wordsOf(text) {
    return text.split(BETWEEN).filter((word) => word !== '');
}

// Returns the numbers in the text of the parameter `name`. Only decimal notation is allowed: other
// notations of JavaScript, such as 0x10, are mistakes.
export function numbersOf(text, name) {
    return wordsOf(text).map((word) => {
        const value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(word) ? Number(word) : NaN;
        if (!Number.isFinite(value)) {
            throw slip(name, 'Not a number', `${name}: \u201c${word}\u201d is not a number.`);
        }
        return value;
    });
}

// Makes a problem for a mistake in a parameter's text, in the form that the server's problems have.
export function slip(name, title, detail) {
    return new Problem({ title, detail, pointer: `/ops/0/${name}` });
}

// Returns the text of a list with a word added, or removed if it is in the list.
export function toggleWord(text, word) {
    const words = wordsOf(text);
    const others = words.filter((one) => one !== `${word}`);
    return (others.length < words.length ? others : [...words, word]).join(' ');
}
