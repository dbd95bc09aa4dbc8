// problem.js - the errors of requests.

// An error that the server, or a proxy in front of it, answered: the members of an RFC 9457
// problem, and `mesh`, the id of the mesh that the request was about, or null.
export class Problem extends Error {
    constructor({
        status = 0,
        title = '',
        detail = '',
        code = '',
        pointer = '',
        repair = [],
        elements = [],
        total = 0,
        element = null,
        mesh = null,
    }) {
        super(detail || title);
        this.status = status;
        this.title = title;
        this.detail = detail;
        this.code = code;
        this.pointer = pointer;
        this.repair = repair;
        this.elements = elements;
        this.total = total;
        this.element = element;
        this.mesh = mesh;
    }
}

export function unreachable() {
    return new Problem({
        title: 'No connection',
        detail: 'The server cannot be reached. Is hedged still running?',
    });
}

// Returns the problem that is in the text of an answer, or, if the text is not a problem document,
// makes a problem from the answer's status.
export function problemOf(status, text) {
    try {
        const problem = JSON.parse(text);
        if (typeof problem.detail === 'string' || typeof problem.title === 'string') {
            return new Problem({ ...problem, status });
        }
    } catch {
        // The answer is not JSON, so it comes from a gateway in front of the server.
    }
    const detail = `The server answered with status ${status}.`;
    return new Problem({ status, title: 'Request failed', detail });
}

export function cancelled() {
    return new Problem({ title: 'Cancelled', detail: 'Nothing was changed.', code: 'cancelled' });
}
