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

    // Shows an error, in the server's words if the error has them.
    show(error) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time, so the index of the operation, with which the
        // pointer of an error begins, is not shown.
        const pointer = error.pointer?.replace(/^\/ops\/0/, '');
        const where = pointer ? ` (at ${pointer})` : '';
        this.#add('alert', title, `${detail}${where}`);
    }

    // Shows a message about something that is about to happen, until it is closed by the page. `text`
    // is for screen readers, which do not read the texts that show() gives later. The button
    // {label, run} gets the focus, so that there is time to press it; when the toast is closed, the
    // element that had the focus before gets it back. Returns {show(text), close()}.
    wait(title, text, { label, run }) {
        const before = document.activeElement;
        const shown = make('p', { 'aria-hidden': 'true' });
        const button = make('button', { type: 'button', onclick: run }, label);
        const toast = make(
            'div',
            { className: 'toast well waits', role: 'status' },
            make('div', {}, make('strong', {}, title), make('p', { className: 'unseen' }, text), shown),
            button,
        );
        this.#region.prepend(toast);
        button.focus({ preventScroll: true });
        return {
            show: (words) => {
                shown.textContent = words;
            },
            close: () => {
                const hadFocus = toast.contains(document.activeElement);
                toast.remove();
                if (hadFocus && before?.isConnected) {
                    before.focus({ preventScroll: true });
                }
            },
        };
    }

    // Shows a message of success for a while. If there is something to do about it, `next` is
    // {label, run}, the label and the function of a button; then the message stays until it is
    // closed.
    tell(title, detail, next = null) {
        const toast = this.#add('status', title, detail);
        if (next === null) {
            setTimeout(() => toast.remove(), SHORT);
            return;
        }
        const onclick = () => {
            toast.remove();
            next.run();
        };
        toast.firstElementChild.append(make('button', { type: 'button', onclick }, next.label));
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
        const old = [...this.#region.querySelectorAll('.toast:not(.waits)')].slice(MOST);
        old.forEach((one) => one.remove());
        return toast;
    }
}
