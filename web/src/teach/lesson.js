// lesson.js - a dialog that shows an operation on the open mesh step by step: a drawing of the
// half-edges, what each step changes in words, and the numbers of vertices, edges and faces.

import { enable, make } from '../kit/dom.js';
import { Drawing } from './drawing.js';
import { eulerOf, stepsOf } from './steps.js';

// Milliseconds for which each step is shown while the steps are played.
const PAUSE = 2200;

// Opens the dialog. `operation` is the operation, `doc` a sentence that says what it does, `region` is
// {before, after} of region.js, and `onApply()` applies the operation to the mesh.
export function showLesson({ operation, doc, region, onApply }) {
    new Lesson({ operation, doc, region, onApply });
}

class Lesson {
    #steps;
    #at = 0;
    #drawing;
    #timer = 0;
    #nodes = {};

    constructor({ operation, doc, region, onApply }) {
        this.#steps = stepsOf(region.before, region.after);
        this.#drawing = new Drawing(this.#steps.map(({ state }) => state));
        const button = (text, onclick, more = {}) => make('button', { type: 'button', onclick, ...more }, text);
        const nodes = this.#nodes;
        nodes.title = make('h3', {});
        nodes.text = make('p', {});
        nodes.counts = make('table', { className: 'lesson-counts' });
        nodes.back = button('Back', () => this.#go(this.#at - 1));
        nodes.next = button('Next', () => this.#go(this.#at + 1), { className: 'primary', autofocus: true });
        nodes.play = button('Play', () => this.#toggle());
        nodes.range = make('input', {
            type: 'range',
            min: 0,
            max: this.#steps.length - 1,
            step: 1,
            value: 0,
            'aria-label': 'Step',
            oninput: () => this.#go(Number(nodes.range.value)),
        });
        const dialog = make(
            'dialog',
            { className: 'lesson', 'aria-labelledby': 'lesson-title' },
            make(
                'div',
                { className: 'panel-head' },
                make('h2', { id: 'lesson-title' }, `${operation.op}, step by step`),
                button('Close', () => dialog.close(), { className: 'quiet' }),
            ),
            make('p', { className: 'small' }, doc),
            this.#drawing.node,
            make('div', { className: 'lesson-said', 'aria-live': 'polite' }, nodes.title, nodes.text),
            make('div', { className: 'lesson-steps' }, nodes.back, nodes.range, nodes.next, nodes.play),
            nodes.counts,
            make(
                'p',
                { className: 'small lesson-key' },
                'Each edge has two half-edges, drawn as arrows beside it; the arrow lies on the side of its ' +
                    'face. ',
                make('span', { className: 'role self' }, 'changed'),
                ' ',
                make('span', { className: 'role next' }, 'new next'),
                ' ',
                make('span', { className: 'role was' }, 'former next'),
                ' ',
                make('span', { className: 'role boundary' }, 'at a boundary'),
                '. A dashed arrow is not linked to others yet.',
            ),
            make(
                'div',
                { className: 'ask-buttons' },
                button('Apply to the mesh', () => {
                    dialog.close();
                    onApply();
                }),
            ),
        );
        dialog.addEventListener('close', () => {
            this.#stop();
            this.#drawing.stop();
            dialog.remove();
        });
        document.body.append(dialog);
        dialog.showModal();
        this.#show();
    }

    #go(at) {
        this.#stop();
        this.#at = Math.max(0, Math.min(at, this.#steps.length - 1));
        this.#show();
    }

    #toggle() {
        if (this.#timer !== 0) {
            this.#stop();
            return;
        }
        if (this.#at === this.#steps.length - 1) {
            this.#at = 0;
            this.#show();
        }
        const go = () => {
            if (this.#at === this.#steps.length - 1) {
                this.#stop();
                return;
            }
            this.#at += 1;
            this.#show();
            this.#timer = setTimeout(go, PAUSE);
        };
        this.#timer = setTimeout(go, PAUSE / 3);
        this.#nodes.play.textContent = 'Pause';
    }

    #stop() {
        clearTimeout(this.#timer);
        this.#timer = 0;
        this.#nodes.play.textContent = 'Play';
    }

    #show() {
        const { title, text, counts, back, next, range } = this.#nodes;
        const step = this.#steps[this.#at];
        const last = this.#steps.length - 1;
        this.#drawing.show(step);
        title.textContent = `${this.#at + 1} of ${this.#steps.length}: ${step.title}`;
        text.textContent = step.text;
        range.value = this.#at;
        range.setAttribute('aria-valuetext', `${this.#at + 1} of ${this.#steps.length}: ${step.title}`);
        enable(back, this.#at > 0);
        enable(next, this.#at < last);
        counts.replaceChildren(...rowsOf(this.#steps[0].state, step.state, this.#steps[last].state));
    }
}

// Returns the rows of a table of the numbers of elements before the operation, now, and after it.
function rowsOf(...states) {
    const cell = (text, head = false) => make(head ? 'th' : 'td', head ? { scope: 'col' } : {}, text);
    const names = ['V', 'E', 'F', 'V \u2212 E + F'];
    const words = ['Before', 'Now', 'After'];
    const numbers = states.map((state) => [
        state.counts.vertices,
        state.counts.edges,
        state.counts.faces,
        eulerOf(state),
    ]);
    const changes = numbers[2].map((value, i) => value - numbers[0][i]);
    const signed = changes.map((value) => (value > 0 ? `+${value}` : `${value}`.replace('-', '\u2212')));
    return [
        make('tr', {}, make('td'), ...names.map((name) => cell(name, true))),
        ...words.map((word, i) =>
            make('tr', {}, make('th', { scope: 'row' }, word), ...numbers[i].map((value) => cell(`${value}`))),
        ),
        make('tr', {}, make('th', { scope: 'row' }, 'Change'), ...signed.map((value) => cell(value))),
    ];
}
