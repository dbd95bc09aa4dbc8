// token.js - the access token that requests carry, if the server requires one. It is kept in the
// storage of the browser's tab and lost when the tab is closed.

const PLACE = 'hedge-token';
const UNKNOWN = 'The token is unknown, expired or revoked.';

let ask = () => Promise.resolve(null);
let asked = null;

export function token() {
    return sessionStorage.getItem(PLACE);
}

export function forgetToken() {
    sessionStorage.removeItem(PLACE);
}

// Sets the function that asks the user for a token. The function returns a promise of the token, or
// of null if the user gives none. Its argument says why the last token is of no use; it is '' if
// there was none.
export function askBy(show) {
    ask = show;
}

// Called when the server has refused the token `refused`, or a request without a token (null).
// `reason` says why this token is of no use. Returns whether there is now another token to try. If
// several requests are refused at once, the user is asked only once.
export async function renewToken(refused, reason = UNKNOWN) {
    if (token() === refused) {
        asked ??= ask(refused === null ? '' : reason).finally(() => {
            asked = null;
        });
        const given = await asked;
        if (given === null) {
            return false;
        }
        sessionStorage.setItem(PLACE, given);
    }
    return true;
}
