// download.js - saves what the page has made or read as a file.

import { make } from './dom.js';

// Characters that no file system or shell likes in a name.
const UNSAFE = /[\u0000-\u001f\u007f<>:"/\\|?*]+/g;

// The largest number of characters of a name before its extension.
const MOST = 100;

// Returns the name of a file for a mesh, such as "box 2.obj". Pure.
export function fileNameOf(name, extension) {
    const safe = name.replaceAll(UNSAFE, ' ').replaceAll(/\s+/g, ' ').trim().replace(/^\.+/, '');
    const stem = [...safe].slice(0, MOST).join('').trim().replace(/\.+$/, '');
    return `${stem || 'mesh'}.${extension}`;
}

// Lets the browser save a Blob under a name.
export function save(blob, name) {
    const href = URL.createObjectURL(blob);
    make('a', { href, download: name }).click();
    URL.revokeObjectURL(href);
}

const UNITS = ['bytes', 'kB', 'MB', 'GB'];

// Returns a number of bytes in words, as in "684 bytes" or "1.2 MB". Pure.
export function formatBytes(bytes) {
    let [value, unit] = [bytes, 0];
    while (value >= 1000 && unit < UNITS.length - 1) {
        value /= 1000;
        unit++;
    }
    return `${unit === 0 ? value : Number(value.toPrecision(3))} ${UNITS[unit]}`;
}
