// request.js - sends requests to the server: the only module that calls fetch. Paths are relative, so
// that the page works behind any prefix.

import { problemOf, unreachable } from './problem.js';
import { renewToken, token } from './token.js';

// Sends a request with the page's token and returns the answer. If the answer is an error, throws a
// Problem; if the server wants another token, asks the user for one and sends the request again.
export async function request(path, options = {}) {
    const bearer = token();
    const headers = { ...options.headers };
    if (bearer !== null) {
        headers.Authorization = `Bearer ${bearer}`;
    }
    let answer;
    try {
        answer = await fetch(path, { cache: 'no-cache', ...options, headers });
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
    if (answer.status === 401 && (await renewToken(bearer))) {
        return request(path, options);
    }
    if (!answer.ok) {
        const problem = problemOf(answer.status, await answer.text());
        problem.mesh = meshOf(path);
        throw problem;
    }
    return answer;
}

// Sends any request, such as an example of the manual, and returns the answer whatever its status is.
export async function sendAny(path, options = {}) {
    const bearer = token();
    const headers = { ...(bearer !== null && { Authorization: `Bearer ${bearer}` }), ...options.headers };
    try {
        return await fetch(path, { cache: 'no-store', ...options, headers });
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
}

// Sends a GET and returns the JSON of the answer.
export async function getJson(path, signal) {
    return (await request(path, { signal })).json();
}

// Returns the id of the mesh that is in the path of a request, or null.
export function meshOf(path) {
    const found = /^v1\/meshes\/([^/?]+)/.exec(path);
    return found === null ? null : decodeURIComponent(found[1]);
}

// Returns the path of a mesh, with which the paths of its parts begin.
export function meshPath(mesh) {
    return `v1/meshes/${encodeURIComponent(mesh)}`;
}

// Returns the query of an address; what is undefined is left out.
export function queryOf(values) {
    return Object.entries(values)
        .filter(([, value]) => value !== undefined)
        .map(([name, value]) => `${name}=${encodeURIComponent(value)}`)
        .join('&');
}

// Reads the next part of a stream; throws a Problem if the connection is lost.
export async function readOn(reader) {
    try {
        return await reader.read();
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
}
