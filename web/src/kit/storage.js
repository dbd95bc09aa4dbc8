// storage.js - what the browser remembers from one visit to the next. A browser may forbid this; then
// nothing is remembered.

// Returns what was stored under a name, or null.
export function recall(name) {
    try {
        return JSON.parse(window.localStorage.getItem(name));
    } catch {
        return null;
    }
}

// Stores a value, which JSON must be able to express.
export function remember(name, value) {
    try {
        window.localStorage.setItem(name, JSON.stringify(value));
    } catch {
        // Then the next visit begins with the defaults.
    }
}
