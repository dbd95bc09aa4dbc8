// share.js - the parts of a link to what is shown. Each part of the page that has a state worth
// sharing registers it here under a name:
//
//     share.register('look', { get: () => 'flat', set: (text) => ... })
//
// `get(isShared)` returns the state as text, or null if it is the usual one, which needs no place in the
// page's address. If `isShared` is true, the link is for others, whose usual state may be another one; a
// part that visitors keep for themselves then returns its text in any case. `set(text)` takes the text of a link, which may be anything, and null if the link has none;
// it passes over what it cannot read.

export class Share {
    #parts = new Map();

    register(name, { get, set }) {
        this.#parts.set(name, { get, set });
    }

    // Returns the parts of a link to what is shown now, by name; `isShared` is as above.
    parts(isShared) {
        return Object.fromEntries(
            [...this.#parts]
                .map(([name, { get }]) => [name, get(isShared)])
                .filter(([, value]) => value !== null && value !== undefined),
        );
    }

    // Shows what the parts of a link say; names that are not registered are passed over.
    async show(parts) {
        for (const [name, { set }] of this.#parts) {
            await set(parts[name] ?? null);
        }
    }
}
