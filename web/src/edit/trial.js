// trial.js - makes a dry run of the edit in a form before the user sends it, and shows the result
// in words.

import { formatCount, formatNumberOf } from '../kit/dom.js';
import { openOf } from './results.js';

// A dry run starts when the form has not changed for this many milliseconds.
const DELAY = 300;

const LETTERS = { vertices: 'V', edges: 'E', faces: 'F' };

export class Trial {
    #box;
    #attempt;
    #timer = 0;
    #running = null;
    #asked = null; // the operation of the last dry run
    #onKnown;

    // `attempt(operation, signal)` makes a dry run and returns a promise of {words, isKnown}: the text to
    // show, or null if there is nothing to show, and whether it is known that the operation is possible. `onKnown(operation)` is called with an operation that a dry
    // run has found possible, and with null when it is not known any more whether the form is.
    constructor(box, attempt, onKnown) {
        this.#box = box;
        this.#attempt = attempt;
        this.#onKnown = onKnown;
    }

    // Makes a dry run of an operation after DELAY; a later call replaces it. `operation` is null if
    // the form is incomplete: then nothing is shown.
    ask(operation) {
        const height = this.#box.offsetHeight;
        this.clear();
        this.#asked = operation;
        if (operation !== null) {
            // The room of the last result is kept, so that the form does not jump.
            this.#box.style.minHeight = `${height}px`;
            this.#timer = setTimeout(() => this.#run(operation), DELAY);
        }
    }

    // Called when the mesh has changed: makes the dry run again, because its result may be
    // different now.
    askAgain() {
        if (this.#asked !== null) {
            this.ask(this.#asked);
        }
    }

    // Shows why the form cannot be sent. `isPlain` says that the error is a sentence by itself.
    refuse(error, isPlain = false) {
        this.clear();
        if (isPlain) {
            this.#say(error.detail, true);
        } else {
            this.#sayRefused(error);
        }
    }

    // Shows what the edit has done, until the form changes.
    tell(words) {
        this.clear();
        this.#say(words, false);
    }

    #sayRefused(error) {
        this.#say(`Not possible: ${error.detail || error.message}`, true);
    }

    clear() {
        clearTimeout(this.#timer);
        this.#running?.abort();
        this.#asked = null;
        this.#onKnown(null);
        this.#say('', false);
    }

    async #run(operation) {
        const running = new AbortController();
        this.#running = running;
        try {
            const { words, isKnown } = await this.#attempt(operation, running.signal);
            if (!running.signal.aborted) {
                this.#say(words ?? '', false);
                this.#onKnown(isKnown ? operation : null);
            }
        } catch (error) {
            // Status 0 means a lost connection, which the page shows in its bar and not in the
            // form.
            if (!running.signal.aborted && error.status !== 0) {
                this.#sayRefused(error);
            }
        }
    }

    #say(text, isRefused) {
        this.#box.style.minHeight = '';
        this.#box.textContent = text;
        this.#box.classList.toggle('refused', isRefused);
        const { activeElement } = document;
        if (text !== '' && this.#box.previousElementSibling?.contains(activeElement)) {
            // The field above is in use, so that both must be seen.
            this.#box.scrollIntoView({ block: 'nearest' });
            activeElement.scrollIntoView({ block: 'nearest' });
        }
    }
}

// Returns the answer to a dry run in words, or null if there was no answer.
export function wordsOf(answer) {
    if (answer === null) {
        return null;
    }
    const end = answer.undoable === false ? ' This edit cannot be undone.' : '';
    const open = answer.results.map(openOf).find((words) => words !== '');
    return `${changesOf(answer)}${open === undefined ? '' : `. ${open}`}${end}`;
}

// Returns what an edit has done, by its answer: how many elements it made, deleted or changed.
export function madeOf(answer) {
    if (answer.replaced) {
        return isRenumbering(answer) ? 'All ids are new.' : 'The whole mesh was replaced.';
    }
    const { sizes, changed } = sizesOf(answer);
    if (sizes.length > 0) {
        return `Made: ${sizes.join(' ')}`;
    }
    return changed.length > 0 ? `Changed: ${changed.join(' ')}` : 'Nothing has changed.';
}

function isRenumbering({ results }) {
    return results.some(({ op }) => op === 'compact');
}

function sizesOf({ created, deleted, modified }) {
    const signs = [
        ['+', created],
        ['\u2212', deleted],
    ];
    const sizes = signs.flatMap(([sign, found]) => tally(found).map((word) => `${sign}${word}`));
    return { sizes, changed: tally(modified) };
}

function changesOf(answer) {
    const { replaced } = answer;
    const chosen = answer.results.find(({ selected }) => selected !== undefined);
    if (chosen !== undefined) {
        return `Would select: ${selectionOf(chosen)}.`;
    }
    const divided = answer.results.find(({ patches }) => patches !== undefined);
    if (divided !== undefined) {
        return `Would divide the faces into ${patchesOf(divided)}.`;
    }
    const { sizes, changed } = sizesOf(answer);
    if (sizes.length > 0) {
        return `Would make: ${sizes.join(' ')}`;
    }
    if (replaced) {
        return isRenumbering(answer)
            ? 'Would change the ids of all elements.'
            : 'Would replace the whole mesh.';
    }
    return changed.length > 0 ? `Would change: ${changed.join(' ')}` : 'Would change nothing.';
}

// Returns the result of a selection in words.
export function selectionOf({ selected, added, removed }) {
    const changes = [
        ['+', added],
        ['\u2212', removed],
    ].flatMap(([sign, count]) => (count > 0 ? [`${sign}${formatCount(count)}`] : []));
    const end = ` (${changes.length > 0 ? changes.join(' ') : 'as before'})`;
    return `${formatNumberOf(selected, 'element')}${end}`;
}

// Returns the result of a segmentation in words.
export function patchesOf({ patches, features }) {
    const marked = features > 0 ? `, with ${formatNumberOf(features, 'feature edge')}` : '';
    return `${formatNumberOf(patches, 'patch', 'patches')}${marked}`;
}

function tally(found) {
    return Object.entries(LETTERS)
        .filter(([kind]) => found?.[kind]?.length > 0)
        .map(([kind, letter]) => `${found[kind].length} ${letter}`);
}
