// theme.js - the light or dark theme of the page. style/base.css has the colours of both.

import { recall, remember } from '../kit/storage.js';

const NAME = 'hedge-theme';
const system = window.matchMedia('(prefers-color-scheme: light)');

// What the user has chosen: 'light', 'dark', or 'system', which follows the settings of the system.
let choice = ['light', 'dark'].find((one) => one === recall(NAME)) ?? 'system';
const listeners = [];

function apply() {
    const { dataset } = document.documentElement;
    if (choice === 'system') {
        delete dataset.theme;
    } else {
        dataset.theme = choice;
    }
    listeners.forEach((act) => act());
}

export function themeChoice() {
    return choice;
}

// Returns the theme that is shown, 'light' or 'dark'.
export function theme() {
    const ofSystem = system.matches ? 'light' : 'dark';
    return choice === 'system' ? ofSystem : choice;
}

export function chooseTheme(wanted) {
    choice = wanted;
    remember(NAME, choice);
    apply();
}

// Calls a function each time when another theme may be shown.
export function onTheme(act) {
    listeners.push(act);
}

system.addEventListener('change', apply);
apply();
