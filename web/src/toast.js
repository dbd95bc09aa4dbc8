// toast.js - messages about failures. They stay until they are closed: nobody has to read in time.

import { make } from './dom.js';

const MOST = 4;

export class Toasts {
    #region;

    constructor(region) {
        this.#region = region;
    }

    // Show an error: the server's words where it has any.
    show(error) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time: that it is the first says nothing.
        const pointer = error.pointer?.replace(/^\/ops\/0/, '');
        const where = pointer ? ` (at ${pointer})` : '';
        const toast = make(
            'div',
            { className: 'toast', role: 'alert' },
            make(
                'div',
                {},
                make('strong', {}, title),
                make('p', {}, `${detail}${where}`),
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
    }
}
