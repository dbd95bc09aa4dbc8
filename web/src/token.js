// token.js - the token that requests carry, if the server asks for one. It is kept for the tab
// only, and lost with it.

const PLACE = 'hedge-token';

let ask = () => Promise.resolve(null);
let asked = null;

export function token() {
    return sessionStorage.getItem(PLACE);
}

export function forgetToken() {
    sessionStorage.removeItem(PLACE);
}

// `show(wasWrong)` asks the user: it returns a promise of a token, or of null.
export function askBy(show) {
    ask = show;
}

// A request with `refused`, a token or null, was answered 401. Returns whether there is another
// token to try. The user is asked once, however many requests are refused at a time.
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
