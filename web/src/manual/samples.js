// samples.js - what readers do with the code of a page: choose a language, which all pages remember,
// and copy it.

import { copyText } from '../kit/clipboard.js';
import { make } from '../kit/dom.js';
import { recall, remember } from '../kit/storage.js';

const PLACE = 'hedge-language';
// The address in the pages as they were made.
const BASE = 'http://127.0.0.1:8080';
// Milliseconds for which a button says that it has copied.
const TOLD = 1500;

// Returns the code that a block shows.
function shownIn(block) {
    return [...block.querySelectorAll('pre')].find((pre) => getComputedStyle(pre).display !== 'none').textContent;
}

function addCopy(block) {
    const button = make('button', { type: 'button', className: 'copy' }, 'Copy');
    button.addEventListener('click', async () => {
        try {
            await copyText(shownIn(block));
            button.textContent = 'Copied';
        } catch {
            button.textContent = 'Not allowed';
        }
        setTimeout(() => {
            button.textContent = 'Copy';
        }, TOLD);
    });
    block.append(button);
}

function choose(language) {
    document.querySelectorAll(`.sample input.${language}`).forEach((input) => {
        input.checked = true;
    });
}

// Makes the code of the page that of this server at the address `root`.
export function startSamples(root) {
    const base = new URL(root, document.baseURI).href.replace(/\/$/, '');
    for (const code of document.querySelectorAll('.sample code, .plain-code code')) {
        code.textContent = code.textContent.replaceAll(BASE, base);
    }
    const kept = recall(PLACE);
    if (['curl', 'python', 'fetch'].includes(kept)) {
        choose(kept);
    }
    document.addEventListener('change', ({ target }) => {
        if (target.matches('.sample input')) {
            remember(PLACE, target.value);
            choose(target.value);
        }
    });
    document.querySelectorAll('.sample, .plain-code').forEach(addCopy);
}
