// acts.js - finds in the page what its buttons and switches do, so that the palette offers the same.

import { make } from '../kit/dom.js';

const CONTROLS = [
    'header button',
    'header input[type="radio"]',
    'nav button',
    'aside button',
    'aside input[type="checkbox"]',
].join();

// Returns an item for each button and switch of the page that can be used now: {label, about, run}.
// Those in lists and forms are left out, because they belong to a single element or field.
export function actsOf(page) {
    const items = new Map();
    for (const control of page.querySelectorAll(CONTROLS)) {
        const isPart = control.closest('ul, ol, dl, form, [role="menu"]') !== null;
        if (control.disabled || isPart || !control.checkVisibility()) {
            continue;
        }
        const label = labelOf(control);
        if (!items.has(label)) {
            items.set(label, { label, about: control.title, run: () => control.click() });
        }
    }
    return [...items.values()];
}

// Returns the name of a control, after the title of the group in which it is.
function labelOf(control) {
    const own = control.getAttribute('aria-label') ?? (control.labels?.[0] ?? control).textContent;
    const group = control.closest('section, fieldset')?.querySelector('h2, legend')?.textContent;
    const words = own.trim().replace(/\s+/g, ' ');
    return group === undefined || words.startsWith(group) ? words : `${group}: ${words}`;
}

// Returns a row of the palette for an item.
export function rowOf({ label, about, kind }, id) {
    return make(
        'li',
        { id, role: 'option', 'aria-selected': 'false' },
        make('span', { className: 'act' }, label),
        make('span', { className: 'about' }, about),
        make('span', { className: 'kind' }, kind ?? ''),
    );
}
