// sign_in.js - asks the user for an access token, and shows the name and the role of the token.

import * as api from '../wire/api.js';
import { byId } from '../kit/dom.js';
import { askBy, forgetToken } from '../wire/token.js';

const ROLES = { read: 'may view', write: 'may edit', admin: 'may do everything' };

export class SignIn {
    mayEdit = true; // until the server says otherwise
    name = null; // the name of the token, which others see; null: there is none

    // `onChange()` is called when the server has said what the token allows.
    constructor(onChange) {
        askBy((reason) => this.#ask(reason));
        byId('who').addEventListener('click', () => {
            forgetToken();
            window.location.reload();
        });
        this.onChange = onChange;
    }

    // Asks the server what the token of this page allows. If the server requires a token and the
    // page has no valid one, the user is asked for one.
    async start() {
        const { name, role, prefixes } = await api.getToken();
        this.mayEdit = role !== 'read';
        this.name = name;
        const who = byId('who');
        who.hidden = name === null;
        who.textContent = `${name} (${role})`;
        const meshes = prefixes.length > 0 ? `; only meshes ${prefixes.join(', ')}\u2026` : '';
        who.title = `${ROLES[role] ?? role}${meshes}. Click to use another token`;
        document.body.classList.toggle('looks-only', !this.mayEdit);
        this.onChange();
    }

    // Asks for a token. `reason` says why the last one is of no use, or is ''.
    #ask(reason) {
        const dialog = byId('sign-in');
        const field = byId('token');
        byId('token-wrong').hidden = reason === '';
        byId('token-wrong').textContent = reason;
        field.value = '';
        dialog.returnValue = '';
        dialog.showModal();
        return new Promise((resolve) => {
            const onClose = () => {
                const given = field.value.trim();
                field.value = '';
                resolve(dialog.returnValue === 'use' && given !== '' ? given : null);
            };
            dialog.addEventListener('close', onClose, { once: true });
        });
    }
}
