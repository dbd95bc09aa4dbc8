// token.js - the access token that requests carry, if the server requires one. It is kept in the
// storage of the browser's tab and lost when the tab is closed.

const PLACE = 'hedge-token';

let ask = () => Promise.resolve(null);
let asked = null;

export function token() {
    return sessionStorage.getItem(PLACE);
}

export function forgetToken() {
    sessionStorage.removeItem(PLACE);
}

// Sets the function that asks the user for a token. The function returns a promise of the token, or
// of null if the user gives none. Its argument `wasWrong` says that the server has refused a token.
export function askBy(show) {
    ask = show;
}

// Called when a request with the token `refused`, or with none (null), was answered 401. Returns
// whether there is now another token to try. If several requests are refused at once, the user is
// asked only once.
export async function renewToken(refused) {
    if (token() === refused) {
        asked ??= ask(refused !== null).finally(() => {
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
