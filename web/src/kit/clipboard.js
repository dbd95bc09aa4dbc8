// clipboard.js - copies a text.

import { make } from './dom.js';

// Copies a text. Browsers have a clipboard for pages of secure origins only; on other pages, a text
// field is selected and copied. Throws an Error if the browser refuses.
export async function copyText(text) {
    if (navigator.clipboard !== undefined) {
        await navigator.clipboard.writeText(text);
        return;
    }
    const before = document.activeElement;
    const field = make('textarea', { value: text, className: 'unseen' });
    document.body.append(field);
    field.select();
    const isDone = document.execCommand('copy');
    field.remove();
    before?.focus();
    if (!isDone) {
        throw new Error('The browser does not let the page copy.');
    }
}
