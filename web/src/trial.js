// trial.js - what an edit would do, asked of the server before it is sent: a dry run, in words.

// An edit is tried when the form has been left alone for so many milliseconds.
const DELAY = 300;

const LETTERS = { vertices: 'V', edges: 'E', faces: 'F' };

export class Trial {
    #box;
    #attempt;
    #timer = 0;
    #running = null;
    #asked = null; // the operation that was asked about last

    // `attempt(operation, signal)` gives what is to be said, or null where that is nothing.
    constructor(box, attempt) {
        this.#box = box;
        this.#attempt = attempt;
    }

    // Try an operation soon; only the last counts. Null where the form does not say one yet.
    ask(operation) {
        this.clear();
        this.#asked = operation;
        if (operation !== null) {
            this.#timer = setTimeout(() => this.#run(operation), DELAY);
        }
    }

    // The mesh has changed: what was said of it may hold no longer.
    askAgain() {
        if (this.#asked !== null) {
            this.ask(this.#asked);
        }
    }

    // Say that what the form says cannot be sent.
    refuse(error) {
        this.clear();
        this.#sayRefused(error);
    }

    #sayRefused(error) {
        this.#say(`Would be refused: ${error.detail || error.message}`, true);
    }

    clear() {
        clearTimeout(this.#timer);
        this.#running?.abort();
        this.#asked = null;
        this.#say('', false);
    }

    async #run(operation) {
        const running = new AbortController();
        this.#running = running;
        try {
            const words = await this.#attempt(operation, running.signal);
            if (words !== null && !running.signal.aborted) {
                this.#say(words, false);
            }
        } catch (error) {
            // That there is no connection is shown elsewhere.
            if (!running.signal.aborted && error.status !== 0) {
                this.#sayRefused(error);
            }
        }
    }

    #say(text, isRefused) {
        this.#box.textContent = text;
        this.#box.classList.toggle('refused', isRefused);
    }
}

// What the answer to a dry run says, null where there is none.
export function wordsOf(answer) {
    if (answer === null) {
        return null;
    }
    const end = answer.undoable === false ? ' It cannot be undone.' : '';
    return `${changesOf(answer)}${end}`;
}

function changesOf(answer) {
    const { created, deleted, modified, replaced } = answer;
    const signs = [
        ['+', created],
        ['\u2212', deleted],
    ];
    const sizes = signs.flatMap(([sign, found]) => tally(found).map((word) => `${sign}${word}`));
    const changed = tally(modified);
    if (sizes.length > 0) {
        return `Would make: ${sizes.join(' ')}`;
    }
    if (replaced) {
        return answer.results.some(({ op }) => op === 'compact')
            ? 'Would change the ids of all elements.'
            : 'Would make the mesh anew.';
    }
    return changed.length > 0 ? `Would change: ${changed.join(' ')}` : 'Would change nothing.';
}

function tally(found) {
    return Object.entries(LETTERS)
        .filter(([kind]) => found?.[kind]?.length > 0)
        .map(([kind, letter]) => `${found[kind].length} ${letter}`);
}
