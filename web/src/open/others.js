// others.js - the other clients of a mesh and what they show of themselves, kept up to date by the
// events `presence`. Pure.

// The colours of other clients, as text and as a number. They differ from those of the selection,
// of boundary loops and of changes.
const COLORS = ['#c77dff', '#5ad1c8', '#ff8fa3', '#8ecae6', '#b5e48c', '#f78fd6', '#90a8ff', '#d4b8ff'];

export class Others {
    #clients = new Map();

    // Takes the data of an event.
    note({ clients, changed }) {
        const there = new Set(clients);
        for (const client of this.#clients.keys()) {
            if (!there.has(client)) {
                this.#clients.delete(client);
            }
        }
        for (const presence of changed) {
            this.#clients.set(presence.client, presence);
        }
    }

    // Returns what all clients but `self` show, in the order of their ids: presences as the server
    // sends them, each with a `color`.
    besides(self) {
        return [...this.#clients.values()]
            .filter(({ client }) => client !== self)
            .sort((a, b) => (a.client < b.client ? -1 : 1))
            .map((presence) => ({ ...presence, color: colorOf(presence.client) }));
    }
}

// Returns the colour of a client, which is the same on all pages.
export function colorOf(client) {
    let hash = 0;
    for (const letter of client) {
        hash = (31 * hash + letter.codePointAt(0)) % 65521;
    }
    return COLORS[hash % COLORS.length];
}
