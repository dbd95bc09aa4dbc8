// numbers.js - numbers in text, as people write and paste them. Pure.

import { Problem } from './api.js';

// What stands between numbers, also around lists of them.
const BETWEEN = /[\s,;()[\]]+/;

export function wordsOf(text) {
    return text.split(BETWEEN).filter((word) => word !== '');
}

// The numbers in the text of the parameter `name`. Digits as people write them: what else
// JavaScript reads, such as 0x10, is a slip.
export function numbersOf(text, name) {
    return wordsOf(text).map((word) => {
        const value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(word) ? Number(word) : NaN;
        if (!Number.isFinite(value)) {
            throw slip(name, 'Not a number', `${name}: \u201c${word}\u201d is not a number.`);
        }
        return value;
    });
}

// What is wrong with the text of a parameter, as the server would say it.
export function slip(name, title, detail) {
    return new Problem({ title, detail, pointer: `/ops/0/${name}` });
}

// The text of a list of ids with one more, or without it where it was in there.
export function toggleWord(text, word) {
    const words = wordsOf(text);
    const others = words.filter((one) => one !== `${word}`);
    return (others.length < words.length ? others : [...words, word]).join(' ');
}
