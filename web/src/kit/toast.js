// toast.js - shows messages to the user. Errors stay until they are closed, so that there is no
// time limit for reading. Messages of success disappear by themselves, but not while the pointer or
// the focus is on a message.
//
// The newest messages are shown, and a button shows the earlier ones. A message that is repeated is
// shown once, with a count. A message about a mesh goes away when another mesh is opened.

import { SINGULARS } from '../geometry/kinds.js';
import { make } from './dom.js';

// How many messages are shown at once, and how many are kept.
const MOST = 4;
const MOST_KEPT = 50;

// Milliseconds for which a message of success is shown.
const SHORT = 8000;

export class Toasts {
    #region;
    #bar;
    #more;
    #actions;
    #mesh = null;
    #showsAll = false;

    // The messages are put into the element `region`. `actions` has onElement(kind, id), which is
    // called when the user wants to see the element that an error is about.
    constructor(region, actions) {
        this.#region = region;
        this.#actions = actions;
        this.#more = make('button', { type: 'button', className: 'quiet', onclick: () => this.#toggle() });
        const closeAll = make(
            'button',
            { type: 'button', className: 'quiet', onclick: () => this.#closeAll() },
            'Close all',
        );
        this.#bar = make('div', { className: 'toast-bar', hidden: true }, this.#more, closeAll);
        region.append(this.#bar);
        region.addEventListener('keydown', (event) => {
            if (event.key === 'Escape') {
                this.#close(event.target.closest('.toast:not(.waits)'));
            }
        });
    }

    // Says that another mesh is open. Messages about the mesh that was open before go away.
    setMesh(mesh) {
        if (mesh === this.#mesh) {
            return;
        }
        const left = this.#mesh;
        this.#mesh = mesh;
        if (left !== null) {
            this.#toasts.filter(({ dataset }) => dataset.mesh === left).forEach((one) => one.remove());
            this.#arrange();
        }
    }

    // Shows an error, in the server's words if the error has them.
    show(error) {
        const title = error.title || 'Something went wrong';
        const detail = error.detail || error.message || String(error);
        // The page sends one operation at a time, so the index of the operation, with which the
        // pointer of an error begins, is not shown.
        const pointer = error.pointer?.replace(/^\/ops\/0/, '');
        const where = pointer ? ` (at ${pointer})` : '';
        const { toast, isNew } = this.#add('alert', title, `${detail}${where}`, error.mesh ?? null);
        const { element } = error;
        if (isNew && element && error.code !== 'no_such_element' && error.mesh === this.#mesh) {
            const { kind, id } = element;
            const onclick = () => this.#actions.onElement(kind, id);
            const label = `Show ${SINGULARS[kind]} ${id}`;
            toast.firstElementChild.append(make('button', { type: 'button', onclick }, label));
        }
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

    // Shows a message of success, about the open mesh, for a while. If there is something to do about
    // it, `next` is {label, run}, the label and the function of a button; then the message stays
    // until it is closed, unless `next` has `isOffer`, because it can be done at any other time, too.
    // If there are several things to do, `next` is a list of them, of which some may be null.
    tell(title, detail, next = null) {
        const { toast, isNew } = this.#add('status', title, detail, this.#mesh);
        const all = [next].flat().filter((one) => one !== null);
        if (isNew && all.every(({ isOffer }) => isOffer === true)) {
            this.#closeLater(toast);
        }
        // The buttons of an earlier message with the same words are about what was then.
        toast.querySelectorAll('.next').forEach((button) => button.remove());
        for (const { label, run } of all) {
            const onclick = () => {
                this.#close(toast);
                run();
            };
            toast.firstElementChild.append(
                make('button', { type: 'button', className: 'next', onclick }, label),
            );
        }
    }

    // Returns all messages that can be closed, newest first.
    get #toasts() {
        return [...this.#region.querySelectorAll('.toast:not(.waits)')];
    }

    // Adds a message above all others, and returns {toast, isNew}: its element, and whether it is new. If
    // the same message is there, counts it once more.
    #add(role, title, text, mesh) {
        const same = this.#toasts.find(
            (one) =>
                one.getAttribute('role') === role &&
                one.dataset.mesh === (mesh ?? '') &&
                one.querySelector('strong').textContent === title &&
                one.querySelector('p').textContent === text,
        );
        if (same !== undefined) {
            this.#repeat(same);
            return { toast: same, isNew: false };
        }
        const toast = make('div', { className: role === 'alert' ? 'toast' : 'toast well', role });
        toast.dataset.mesh = mesh ?? '';
        toast.dataset.count = '1';
        toast.append(
            make('div', {}, make('strong', {}, title), make('p', {}, text)),
            make(
                'button',
                {
                    type: 'button',
                    className: 'close',
                    'aria-label': 'Close message',
                    onclick: () => this.#close(toast),
                },
                '\u00d7',
            ),
        );
        this.#region.prepend(toast);
        this.#arrange();
        return { toast, isNew: true };
    }

    // Shows that a message was repeated: counts it, and makes it the newest one.
    #repeat(toast) {
        const count = Number(toast.dataset.count) + 1;
        toast.dataset.count = `${count}`;
        const times = toast.querySelector('.times') ?? make('span', { className: 'times' });
        times.textContent = `${count} times`;
        toast.querySelector('strong').after(times);
        if (toast !== this.#region.firstElementChild) {
            this.#region.prepend(toast);
        }
        this.#arrange();
    }

    // Closes a message after a while, in which neither the pointer nor the focus is on a message.
    #closeLater(toast) {
        let shown = toast.dataset.count;
        const end = () => {
            if (!toast.isConnected) {
                return;
            }
            if (toast.dataset.count !== shown || this.#region.matches(':hover, :focus-within')) {
                shown = toast.dataset.count;
                setTimeout(end, SHORT);
            } else {
                this.#close(toast);
            }
        };
        setTimeout(end, SHORT);
    }

    // Closes a message. If the focus is in it, the next message gets the focus, so that it is not
    // lost.
    #close(toast) {
        if (!toast) {
            return;
        }
        const hadFocus = toast.contains(document.activeElement);
        const next = toast.nextElementSibling?.querySelector('.close');
        toast.remove();
        this.#arrange();
        if (hadFocus) {
            (next ?? this.#toasts[0]?.querySelector('.close'))?.focus({ preventScroll: true });
        }
    }

    #closeAll() {
        this.#toasts.forEach((one) => one.remove());
        this.#arrange();
    }

    #toggle() {
        this.#showsAll = !this.#showsAll;
        this.#arrange();
    }

    // Hides the earlier messages, or shows them if the user wants to see all, and forgets those that
    // are too many to keep.
    #arrange() {
        this.#toasts.slice(MOST_KEPT).forEach((one) => one.remove());
        const all = this.#toasts;
        const earlier = all.slice(MOST);
        this.#showsAll &&= earlier.length > 0;
        all.forEach((one) => {
            one.hidden = false;
        });
        earlier.forEach((one) => {
            one.hidden = !this.#showsAll;
        });
        this.#region.classList.toggle('all', this.#showsAll);
        this.#more.textContent = this.#showsAll ? 'Show fewer' : `${earlier.length} earlier`;
        this.#more.hidden = earlier.length === 0;
        this.#bar.hidden = all.length < 2;
    }
}
