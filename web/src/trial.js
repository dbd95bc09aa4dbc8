// trial.js - a dry run of an edit before it is sent, described in words.

// Milliseconds without a change of the form before its dry run.
const DELAY = 300;

const LETTERS = { vertices: 'V', edges: 'E', faces: 'F' };

export class Trial {
    #box;
    #attempt;
    #timer = 0;
    #running = null;
    #asked = null; // the operation of the last dry run

    // `attempt(operation, signal)` returns the text to show, or null.
    constructor(box, attempt) {
        this.#box = box;
        this.#attempt = attempt;
    }

    // Tries an operation soon; only the last call counts. Null: the form is incomplete.
    ask(operation) {
        this.clear();
        this.#asked = operation;
        if (operation !== null) {
            this.#timer = setTimeout(() => this.#run(operation), DELAY);
        }
    }

    // Called when the mesh has changed, because the last result may be wrong: tries the operation
    // again.
    askAgain() {
        if (this.#asked !== null) {
            this.ask(this.#asked);
        }
    }

    // Shows that the form cannot be sent.
    refuse(error) {
        this.clear();
        this.#sayRefused(error);
    }

    #sayRefused(error) {
        this.#say(`Not possible: ${error.detail || error.message}`, true);
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
            // A lost connection is shown elsewhere.
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

// Returns the text for the answer to a dry run, null if there is none.
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
            : 'Would replace the whole mesh.';
    }
    return changed.length > 0 ? `Would change: ${changed.join(' ')}` : 'Would change nothing.';
}

function tally(found) {
    return Object.entries(LETTERS)
        .filter(([kind]) => found?.[kind]?.length > 0)
        .map(([kind, letter]) => `${found[kind].length} ${letter}`);
}
