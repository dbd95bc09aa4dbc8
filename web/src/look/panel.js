// panel.js - the panel "View": the controls for the theme and the look, except those of the section.

import { chooseTheme, themeChoice } from './theme.js';

export class ViewPanel {
    #elements;
    #acts;

    // `button` opens and closes `box`, which contains `form` and `close`. `onChange(part)` is called
    // with the changed members of the look, see state.js, and `onReset()` to go back to the first look;
    // `onOpen()` when the panel was opened.
    constructor({ button, box, close, form, reset }, { onChange, onReset, onOpen }) {
        this.#elements = { button, box, form };
        this.#acts = { onChange, onOpen };
        button.addEventListener('click', () => this.toggle());
        close.addEventListener('click', () => this.#close());
        reset.addEventListener('click', onReset);
        box.addEventListener('keydown', (event) => {
            if (event.key === 'Escape') {
                this.#close();
            }
        });
        form.addEventListener('submit', (event) => event.preventDefault());
        form.addEventListener('input', ({ target }) => this.#changed(target));
        form.elements.theme.value = themeChoice();
    }

    get isOpen() {
        return !this.#elements.box.hidden;
    }

    // Opens the panel with the focus in it, or closes it.
    toggle() {
        if (this.isOpen) {
            this.#close();
        } else {
            this.#elements.box.hidden = false;
            this.#elements.button.setAttribute('aria-expanded', 'true');
            this.#elements.form.querySelector('input:checked').focus({ preventScroll: true });
            this.#acts.onOpen();
        }
    }

    #close() {
        const { button, box } = this.#elements;
        const hadFocus = box.contains(document.activeElement);
        box.hidden = true;
        button.setAttribute('aria-expanded', 'false');
        if (hadFocus) {
            button.focus();
        }
    }

    // The controls have the names of the members of the look; those of the section have no name there.
    #changed({ name, type, value, checked }) {
        if (name === 'theme') {
            chooseTheme(value);
        } else if (name === 'isSmooth') {
            this.#acts.onChange({ isSmooth: value === 'smooth' });
        } else if (name === 'crease') {
            this.#acts.onChange({ crease: Number(value) });
        } else if (type === 'checkbox') {
            this.#acts.onChange({ [name]: checked });
        } else if (['way', 'matcap', 'unit', 'hurry'].includes(name)) {
            this.#acts.onChange({ [name]: value });
        }
    }

    // Shows a look.
    show(state) {
        const { elements } = this.#elements.form;
        for (const name of ['way', 'matcap', 'unit', 'hurry', 'crease']) {
            elements[name].value = state[name];
        }
        elements.isSmooth.value = state.isSmooth ? 'smooth' : 'flat';
        for (const name of ['hasEdges', 'marksBacks', 'hasAxes', 'hasGrid', 'hasBox']) {
            elements[name].checked = state[name];
        }
        elements.crease.closest('label').hidden = !state.isSmooth;
        elements.crease.setAttribute('aria-valuetext', `${state.crease}\u00b0`);
        elements.crease.parentElement.querySelector('output').textContent = `${state.crease}\u00b0`;
    }
}
