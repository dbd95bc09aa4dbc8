// toast.js - shows messages to the user. Errors stay until they are closed, so that there is no
// time limit for reading. Messages of success disappear by themselves.

import { make } from './dom.js';

const MOST = 4;

// Milliseconds for which a message of success is shown.
const SHORT = 8000;

export class Toasts {
    #region;

    constructor(region) {
        this.#region = region;
    }

    // Shows an error, in the server's words if the error has them. If the user can correct it,
    // `again` is {label, run}, the label and the function of a button.
    show(error, again) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time, so the index of the operation, with which the
        // pointer of an error begins, is not shown.
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

    // Shows a message of success for a while.
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
