// names.js - how names are shown that users, files or other clients have chosen. Pure.

// Characters that control how text is shown: the server refuses them in names, but meshes that were
// stored earlier may have them, and so may files.
const UNSEEN = /[\u0000-\u001f\u007f-\u009f\u2028-\u202e\u2066-\u2069]/g;

// Letters of scripts that are written from right to left.
const FROM_RIGHT = /[\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc\u{10800}-\u{10fff}\u{1e800}-\u{1efff}]/u;

// Returns a name as it is shown by itself: each character that controls text is replaced by a sign.
export function seenName(name) {
    return name.replaceAll(UNSEEN, '\ufffd');
}

// Returns a name as it is shown inside a sentence. A name with letters that run from right to left is
// put between marks, so that it does not turn the words and numbers after it.
export function nameInText(name) {
    const seen = seenName(name);
    return FROM_RIGHT.test(seen) ? `\u2068${seen}\u2069` : seen;
}

// Returns the name under which the mesh of a file is stored: the server refuses characters that control
// text.
export function storableName(name) {
    return name.replaceAll(UNSEEN, ' ').trim();
}
