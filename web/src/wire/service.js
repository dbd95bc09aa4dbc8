// service.js - reads what the server says about itself: its token, its description, its operations.

import { getJson } from './request.js';
import { renewToken, token } from './token.js';

// Returns a description of the access token that the page's requests carry now: {name, role,
// prefixes, expires}; `name` is null if the server does not require tokens.
export async function getToken() {
    const bearer = token();
    try {
        return await getJson('v1/token');
    } catch (error) {
        // A token with the role `metrics` may not even ask this, so the page cannot use it.
        const reason = 'The token may only read metrics. The page needs the role read or write.';
        if (error.status === 403 && (await renewToken(bearer, reason))) {
            return getToken();
        }
        throw error;
    }
}

// Returns the list of the manual's pages in which its search looks.
export function readIndex(address) {
    return getJson(address);
}

let description = null;

// Returns the server's OpenAPI document, which is read once.
export function getDescription() {
    description ??= getJson('v1/openapi.json').catch((error) => {
        description = null;
        throw error;
    });
    return description;
}

// Returns the table of operations: [{name, doc, params, ...}].
export async function getOperations() {
    return (await getJson('v1/operations')).operations;
}
