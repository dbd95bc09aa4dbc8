// moments.js - the part of a row of the history that names a revision, and that looks at it.

import { make } from '../kit/dom.js';

// Most bytes of a name, as the server allows.
const MOST_BYTES = 200;

// Returns the buttons of an entry of the history: one looks at the revision, one names it.
// `onLook(revision)` and `onName(revision, name)` are called; the latter returns a promise, and
// `name` is null if the revision loses its name. An event `cancel` at the field gives up the name that is
// being written.
export function momentButtons(
    { revision, name = '' },
    { onLook, onName, onError },
    isEnabled,
) {
    const look = small('Look', `Look at revision ${revision}`, () => onLook(revision));
    const write = small('Name', `Name revision ${revision}`, () => edit());
    write.classList.add('edits');
    write.disabled = !isEnabled;
    const box = make('span', { className: 'moment' }, look, write);

    function edit() {
        const field = make('input', {
            type: 'text',
            value: name,
            className: 'moment-name',
            'aria-label': `Name of revision ${revision}`,
            placeholder: 'Name of this moment',
            autocomplete: 'off',
        });
        let isOver = false;
        const end = () => {
            if (!isOver) {
                isOver = true;
                field.replaceWith(look, write);
            }
        };
        const save = async () => {
            const text = field.value.trim();
            if (isOver || text === name) {
                end();
                return;
            }
            end();
            await onName(revision, text === '' ? null : text);
        };
        field.addEventListener('input', () => {
            const tooLong = new TextEncoder().encode(field.value.trim()).length > MOST_BYTES;
            field.setCustomValidity(tooLong ? `A name has at most ${MOST_BYTES} bytes.` : '');
            field.reportValidity();
        });
        field.addEventListener('keydown', (event) => {
            if (event.key === 'Enter' && field.validity.valid) {
                // The key would also press the button that gets the focus.
                event.preventDefault();
                save().catch(onError);
                write.focus();
            } else if (event.key === 'Escape') {
                end();
                write.focus();
            }
            event.stopPropagation();
        });
        field.addEventListener('cancel', end);
        field.addEventListener('blur', () => {
            if (field.validity.valid) {
                save().catch(onError);
            } else {
                end();
            }
        });
        look.remove();
        write.replaceWith(field);
        field.focus();
        field.select();
    }

    return box;
}

function small(text, label, onclick) {
    return make(
        'button',
        { type: 'button', className: 'quiet', 'aria-label': label, title: label, onclick },
        text,
    );
}
