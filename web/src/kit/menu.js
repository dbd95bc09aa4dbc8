// menu.js - a menu of actions that opens at a button.

import { make } from './dom.js';

// Pixels between the button and the menu, and between the menu and the edge of the window.
const GAP = 4;

export class Menu {
    #box = make('div', { className: 'menu', role: 'menu', popover: 'auto' });
    #button = null;

    constructor() {
        this.#box.addEventListener('keydown', (event) => this.#onKey(event));
        this.#box.addEventListener('beforetoggle', ({ newState }) => {
            this.#button?.setAttribute('aria-expanded', `${newState === 'open'}`);
        });
        window.addEventListener('resize', () => this.#close());
    }

    // Opens the menu at a button. `items` are {label, run, isGrave}: `run()` is called when the
    // user chooses the item; a grave item is shown in the colour of warnings.
    open(button, label, items) {
        this.#button = button;
        this.#box.setAttribute('aria-label', label);
        this.#box.replaceChildren(
            ...items.map((item) =>
                make(
                    'button',
                    {
                        type: 'button',
                        role: 'menuitem',
                        tabIndex: -1,
                        className: item.isGrave ? 'grave' : '',
                        onclick: () => {
                            this.#close();
                            this.#button.focus();
                            item.run();
                        },
                    },
                    item.label,
                ),
            ),
        );
        // Assistive programs look for the menu in the part of the page to which it belongs.
        button.closest('header, nav').append(this.#box);
        this.#box.showPopover();
        this.#place(button.getBoundingClientRect());
        this.#box.firstElementChild.focus();
    }

    #place({ left, top, bottom }) {
        const { offsetWidth: width, offsetHeight: height } = this.#box;
        const x = Math.min(left, window.innerWidth - width - GAP);
        const below = bottom + GAP;
        const y = below + height > window.innerHeight ? top - GAP - height : below;
        this.#box.style.left = `${Math.max(x, GAP)}px`;
        this.#box.style.top = `${Math.max(y, GAP)}px`;
    }

    #close() {
        if (this.#box.isConnected) {
            this.#box.hidePopover();
        }
    }

    #onKey(event) {
        const items = [...this.#box.children];
        const at = items.indexOf(document.activeElement);
        const next = {
            ArrowDown: (at + 1) % items.length,
            ArrowUp: (at - 1 + items.length) % items.length,
            Home: 0,
            End: items.length - 1,
        }[event.key];
        if (next !== undefined) {
            event.preventDefault();
            items[next].focus();
        } else if (event.key === 'Tab') {
            event.preventDefault();
            this.#close();
            this.#button.focus();
        }
    }
}
