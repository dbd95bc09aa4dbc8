// toast.js - messages. Those about failures stay until they are closed: nobody has to read in time.
// What went well goes by itself.

import { make } from './dom.js';

const MOST = 4;

// Milliseconds that a message about what went well is shown.
const SHORT = 8000;

export class Toasts {
    #region;

    constructor(region) {
        this.#region = region;
    }

    // Show an error: the server's words where it has any. `again` (a label and what to run) is a
    // button that mends it.
    show(error, again) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time: that it is the first says nothing.
        const pointer = error.pointer?.replace(/^\/ops\/0/, '');
        const where = pointer ? ` (at ${pointer})` : '';
        const toast = this.#add('alert', title, `${detail}${where}`);
        if (again) {
            const onclick = () => {
                toast.remove();
                again.run();
            };
            toast.firstElementChild.append(
                make('button', { type: 'button', onclick }, again.label),
            );
        }
    }

    // Show what went well.
    tell(title, detail) {
        const toast = this.#add('status', title, detail);
        setTimeout(() => toast.remove(), SHORT);
    }

    #add(role, title, text) {
        const toast = make(
            'div',
            { className: role === 'alert' ? 'toast' : 'toast well', role },
            make(
                'div',
                {},
                make('strong', {}, title),
                make('p', {}, text),
            ),
            make(
                'button',
                {
                    type: 'button',
                    className: 'close',
                    'aria-label': 'Close message',
                    onclick: () => toast.remove(),
                },
                '\u00d7',
            ),
        );
        this.#region.prepend(toast);
        while (this.#region.children.length > MOST) {
            this.#region.lastElementChild.remove();
        }
        return toast;
    }
}
