// upload.js - sends files to the server, with the progress of sending.

import { finish } from './jobs.js';
import { storableName } from './names.js';
import { Problem, cancelled, problemOf, unreachable } from './problem.js';
import { queryOf } from './request.js';
import { renewToken, token } from './token.js';

// Media type of each extension of file names; the server refuses files with another extension.
const MEDIA_TYPES = {
    obj: 'model/obj',
    off: 'model/x-off',
    ply: 'model/ply',
    stl: 'model/stl',
    glb: 'model/gltf-binary',
    gltf: 'model/gltf+json',
    json: 'application/json',
};

// Creates a mesh from `batch`, {file, beside}: a file and the files that it refers to. `choices` are
// further query parameters, such as {repair: 'weld,orient'}. Calls `onProgress` with the fraction that
// has been sent, 0 to 1; `work` is as in jobs.js. Returns the summary of the new mesh. XMLHttpRequest
// is used because fetch does not report how much was sent.
export async function upload(batch, onProgress, work, choices = {}) {
    const bearer = token();
    const { status, answer } = await send(batch, onProgress, work, choices, bearer);
    if (status === 401) {
        if (await renewToken(bearer)) {
            return upload(batch, onProgress, work, choices);
        }
        throw new Problem({ ...answer, status });
    }
    onProgress(1);
    return status === 202 ? finish(answer, work) : answer;
}

// Returns a multipart form that contains several files.
function formOf(files) {
    const form = new FormData();
    files.forEach((file) => form.append('files', file, file.name));
    return form;
}

// Sends a file, or a form if several files belong together. An answer with status 401 does not
// reject the promise, so that upload() can ask the user for a token.
function send({ file, beside }, onProgress, work, choices, bearer) {
    const dot = file.name.lastIndexOf('.');
    const name = storableName(dot > 0 ? file.name.slice(0, dot) : file.name);
    const type = MEDIA_TYPES[file.name.slice(dot + 1).toLowerCase()];
    return new Promise((resolve, reject) => {
        const sender = new XMLHttpRequest();
        sender.open('POST', `v1/meshes?${queryOf({ name, ...choices })}`);
        if (beside.length === 0) {
            const other = file.type || 'application/octet-stream';
            sender.setRequestHeader('Content-Type', type ?? other);
        }
        sender.setRequestHeader('Prefer', 'respond-async');
        if (bearer !== null) {
            sender.setRequestHeader('Authorization', `Bearer ${bearer}`);
        }
        sender.upload.onprogress = (event) => {
            onProgress(event.lengthComputable ? event.loaded / event.total : 0);
        };
        sender.onload = () => {
            const { status, responseText: text } = sender;
            if ((status >= 200 && status < 300) || status === 401) {
                resolve({ status, answer: JSON.parse(text) });
            } else {
                reject(problemOf(status, text));
            }
        };
        sender.onerror = () => reject(unreachable());
        sender.onabort = () => reject(cancelled());
        work.begin(() => sender.abort());
        sender.send(beside.length === 0 ? file : formOf([file, ...beside]));
    });
}
