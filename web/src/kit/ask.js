// ask.js - a dialog with a form: its fields, what is wrong with them, the progress of what the form
// starts, and two buttons. The dialog exists only while it is open.

import { enable, make } from './dom.js';

let asks = 0; // how many dialogs were opened

export class Ask {
    #dialog;
    #go;
    #back;
    #alert;
    #progress;
    #label;
    #bar;
    #onGo;
    #cancel = null; // cancels what the form has started; null if nothing is in progress
    #rows = new Map(); // name of a field -> its row

    // `go` is the label of the button that calls `onGo(ask)`. onGo() may return a promise; if it
    // fails, the error is shown in the dialog, else the dialog is closed, unless onGo() returned
    // false. `onClose()` is called when the dialog is closed, for whatever reason. `foot` are nodes
    // above the buttons that are always seen. If `isRead` is true, the dialog is to be read first:
    // then its title gets the focus, and not the first field.
    constructor({ title, go, onGo, onClose = () => {}, foot = [], isRead = false }, ...nodes) {
        this.#onGo = onGo;
        const id = `ask-${++asks}`; // several dialogs may be open, one above the other
        this.#alert = make('p', { id: `${id}-refusal`, className: 'refusal', role: 'alert' });
        this.#label = make('span', { id: `${id}-progress` });
        this.#bar = make('progress', { max: 1, 'aria-labelledby': `${id}-progress` });
        this.#progress = make(
            'div',
            { className: 'uploading', role: 'status', hidden: true },
            this.#label,
            this.#bar,
        );
        this.#go = make('button', { type: 'submit', className: 'primary' }, go);
        const onclick = () => this.close();
        this.#back = make('button', { type: 'button', onclick }, 'Cancel');
        const heading = make('h2', { id: `${id}-title` }, title);
        if (isRead) {
            [heading.tabIndex, heading.autofocus] = [-1, true];
        }
        const form = make(
            'form',
            { className: 'ask', noValidate: true },
            heading,
            ...nodes,
            this.#alert,
            make(
                'div',
                { className: 'ask-foot' },
                ...foot,
                this.#progress,
                make('div', { className: 'ask-buttons' }, this.#back, this.#go),
            ),
        );
        form.addEventListener('submit', (event) => {
            event.preventDefault();
            this.#run();
        });
        this.#dialog = make('dialog', { 'aria-labelledby': heading.id }, form);
        this.#dialog.addEventListener('close', () => {
            this.#cancel?.();
            this.#dialog.remove();
            onClose();
        });
        for (const row of form.querySelectorAll('.field')) {
            this.#rows.set(row.dataset.name, row);
        }
        document.body.append(this.#dialog);
        this.#dialog.showModal();
    }

    close() {
        this.#dialog.close();
    }

    get isOpen() {
        return this.#dialog.open;
    }

    // Changes the labels of the two buttons.
    setLabels(go, back) {
        [this.#go.textContent, this.#back.textContent] = [go, back];
    }

    setEnabled(isEnabled) {
        enable(this.#go, isEnabled);
    }

    // Replaces the rows of some fields by others; see field().
    setRows(box, rows) {
        this.#clear();
        for (const name of [...box.querySelectorAll('.field')].map(({ dataset }) => dataset.name)) {
            this.#rows.delete(name);
        }
        rows.forEach((row) => this.#rows.set(row.dataset.name, row));
        box.replaceChildren(...rows);
    }

    // --- progress; the interface of Work in work.js ---

    // Shows that something has begun that takes a while.
    start(title) {
        this.#label.textContent = title;
        this.#bar.removeAttribute('value');
        this.#progress.hidden = false;
    }

    begin(cancel) {
        this.#cancel = cancel;
    }

    show({ progress, phase = null }) {
        if (progress !== undefined) {
            this.#bar.value = progress;
        }
        if (phase !== null) {
            this.#label.textContent = phase;
        }
    }

    end() {
        this.#progress.hidden = true;
        this.#cancel = null;
    }

    // --- the form ---

    // Shows why the form was refused: below the field that is wrong, which gets the focus, or else
    // below all fields.
    refuse(error) {
        this.#clear();
        const name = nameIn(error.pointer ?? '');
        const row = this.#rows.get(name);
        if (row !== undefined) {
            const main = row.querySelector('input, select, textarea');
            row.classList.add('wrong');
            row.append(this.#alert);
            main.setAttribute('aria-invalid', 'true');
            main.setAttribute('aria-errormessage', this.#alert.id);
            main.focus();
        }
        this.#alert.textContent = error.detail || error.message || error.title;
    }

    // Forgets why the form was refused.
    #clear() {
        this.#alert.textContent = '';
        this.#progress.parentElement.before(this.#alert);
        for (const row of this.#rows.values()) {
            row.classList.remove('wrong');
            row.querySelector('input, select, textarea').setAttribute('aria-invalid', 'false');
        }
    }

    async #run() {
        this.#clear();
        this.setEnabled(false);
        try {
            if ((await this.#onGo(this)) !== false && this.isOpen) {
                this.end();
                this.close();
            }
        } catch (error) {
            if (this.isOpen && error.name !== 'AbortError' && error.code !== 'cancelled') {
                this.refuse(error);
            }
        } finally {
            this.end();
            this.setEnabled(true);
        }
    }
}

// Returns the member that a problem's pointer names, such as "radius" for /radius, or /ops/0/radius
// as the mistakes of fields.js name it.
function nameIn(pointer) {
    return pointer.split('/').at(-1);
}

let rows = 0;

// Returns a row of a dialog: the label of a control, the control and an explanation. `name` is the
// member of the request that the control fills.
export function field(name, label, control, ...help) {
    const id = `ask-${name}-${++rows}`;
    const { main, node } = control;
    const isFlag = main.type === 'checkbox';
    const doc = make('p', { id: `${id}-doc`, className: 'small' }, ...help);
    main.id = id;
    main.setAttribute('aria-describedby', doc.id);
    const text = make('label', { htmlFor: id, className: 'label' }, label);
    const parts = isFlag ? [node, text] : [text, node];
    const row = make('div', { className: isFlag ? 'field flag' : 'field' }, ...parts, doc);
    row.dataset.name = name;
    doc.hidden = help.length === 0;
    return row;
}
