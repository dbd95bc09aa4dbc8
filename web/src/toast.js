// toast.js - messages. Errors stay until they are closed, so that there is no time limit for
// reading. Messages of success disappear.

import { make } from './dom.js';

const MOST = 4;

// Milliseconds for which a message of success is shown.
const SHORT = 8000;

export class Toasts {
    #region;

    constructor(region) {
        this.#region = region;
    }

    // Shows an error, with the server's words if it has any. `again` (a label and a function) makes
    // a button that corrects it.
    show(error, again) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time, so its index is left out.
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

    // Shows a success.
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
