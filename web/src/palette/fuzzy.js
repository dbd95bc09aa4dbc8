// fuzzy.js - finds texts by a few of their letters. Pure.

// What a letter of the query counts when it is found: at the beginning of a word, directly after the
// letter before it, or anywhere else.
const AT_WORD = 8;
const IN_ROW = 8;
const ANYWHERE = 1;

// A text with fewer letters that were not asked for comes first.
const PER_REST = 0.02;

const isBetween = (letter) => letter === undefined || /[\s_:,.()-]/.test(letter);

// Returns how well a text fits a query, or -1 if it does not: all letters of each word of the query
// must be in the text, in their order. The words may be in any order.
export function fitOf(query, text) {
    const words = query.toLowerCase().split(/\s+/).filter((word) => word !== '');
    const letters = text.toLowerCase();
    let sum = 0;
    for (const word of words) {
        const fit = fitOfWord(word, letters);
        if (fit < 0) {
            return -1;
        }
        sum += fit;
    }
    return Math.max(sum - PER_REST * letters.length, 0);
}

// Returns the best sum of what the letters of a word count, over all places where they are in a text,
// or -1. best[i] is the best sum with which the letters up to the present one end at place i.
function fitOfWord(word, letters) {
    let best = null;
    for (const letter of word) {
        const next = new Array(letters.length).fill(-1);
        let before = best === null ? 0 : -1; // best sum that ends earlier than place i - 1
        for (let i = 0; i < letters.length; i++) {
            if (letters[i] === letter) {
                const own = isBetween(letters[i - 1]) ? AT_WORD : ANYWHERE;
                const adjacent = best !== null && i > 0 ? best[i - 1] : -1;
                const apart = before >= 0 ? before + own : -1;
                next[i] = Math.max(apart, adjacent >= 0 ? adjacent + Math.max(IN_ROW, own) : -1);
            }
            if (best !== null && i > 0) {
                before = Math.max(before, best[i - 1]);
            }
        }
        best = next;
    }
    return Math.max(...best, -1);
}

// A text that is found only in the description of an item counts this part.
const DESCRIBED = 0.3;

// Returns the items, {label, about}, that fit a query, the best first; all in their order if the
// query is empty.
export function found(query, items) {
    if (query.trim() === '') {
        return items;
    }
    return items
        .map((item, at) => {
            const own = fitOf(query, item.label);
            const described = item.about.toLowerCase().includes(query.trim().toLowerCase());
            const fit = own >= 0 ? own : described ? DESCRIBED : -1;
            return { item, fit, at };
        })
        .filter(({ fit }) => fit >= 0)
        .sort((a, b) => b.fit - a.fit || a.at - b.at)
        .map(({ item }) => item);
}
