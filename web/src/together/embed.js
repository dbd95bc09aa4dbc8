// embed.js - the page in a frame of another page, /?embed: only the view, with a link to the whole
// page.

import { byId } from '../kit/dom.js';

// Whether the page is shown this way.
export const isEmbedded = new URLSearchParams(window.location.search).has('embed');

// Hides everything but the view. `link()` returns the address of what is shown.
export function embed(link) {
    document.documentElement.classList.add('embed');
    const anchor = byId('embed-link');
    anchor.hidden = false;
    // The address changes with the camera and the selection, so it is made when the link is used.
    const update = () => {
        const address = new URL(link());
        address.search = '';
        anchor.href = address.href;
    };
    update();
    for (const type of ['pointerenter', 'focus', 'pointerdown']) {
        anchor.addEventListener(type, update);
    }
}
