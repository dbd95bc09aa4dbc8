// entry.js - says in words what an entry of a mesh's history did. Pure.

// Returns the words for an entry, as the server sent it: the names of the operations of an edit, or
// what was done to an earlier edit.
export function wordsOf({ action, ops }) {
    if (action === 'replace') {
        return 'replaced by another mesh';
    }
    const names = ops.join(', ') || action;
    return action === 'edit' ? names : `${action} of ${names}`;
}
