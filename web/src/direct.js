// direct.js - tools used in the view itself: armed by a key or a button, then a drag shows what it
// will do, and letting go does it. A click does the usual; Esc gives up.

import { enable } from './dom.js';

// A pointer that moved no further than this between down and up has clicked.
const CLICK_PIXELS = 4;

const HINTS = {
    move: 'Drag to move what is selected.',
    extrude: 'Drag to extrude, or click.',
    inset: 'Drag to inset, or click.',
};

export class Direct {
    #canvas;
    #elements;
    #acts;
    #tool = null;
    #gesture = null;
    #down = null; // where and with which pointer the drag began
    #isEnabled = false;

    // `note` holds `hint`, `amount` and a button, `giveUp`; `buttons` has one for each tool.
    // `begin(tool)` gives a gesture or null, `drag(gesture, moved)` what it comes to (see
    // gesture.js), `onShow(lines)` shows lines (null: none) and `onRun(operation)` does it.
    constructor(canvas, { note, hint, amount, giveUp, buttons }, acts) {
        this.#canvas = canvas;
        this.#elements = { note, hint, amount, buttons };
        this.#acts = acts;
        giveUp.addEventListener('click', () => this.cancel());
        // Before all others that listen: to them it is as if nothing had happened.
        const listen = (type, act) =>
            canvas.addEventListener(type, (event) => act(event), { capture: true });
        listen('pointerdown', (event) => this.#press(event));
        listen('pointermove', (event) => this.#move(event));
        listen('pointerup', (event) => this.#release(event));
        listen('pointercancel', () => this.#down !== null && this.cancel());
    }

    get isArmed() {
        return this.#gesture !== null;
    }

    // False when the tool does not fit what is selected.
    arm(tool) {
        this.cancel();
        const gesture = this.#isEnabled ? this.#acts.begin(tool) : null;
        if (gesture === null) {
            return false;
        }
        [this.#tool, this.#gesture] = [tool, gesture];
        const { note, hint, amount, buttons } = this.#elements;
        hint.textContent = `${HINTS[tool]} Esc gives up.`;
        amount.textContent = '';
        note.hidden = false;
        buttons[tool].setAttribute('aria-pressed', 'true');
        this.#canvas.focus();
        return true;
    }

    // Press a tool's button: arm it, or give it up.
    toggle(tool) {
        const isOn = this.#tool === tool;
        this.cancel();
        return isOn || this.arm(tool);
    }

    cancel() {
        if (this.#gesture !== null) {
            this.#elements.buttons[this.#tool].setAttribute('aria-pressed', 'false');
            this.#elements.note.hidden = true;
            [this.#tool, this.#gesture, this.#down] = [null, null, null];
            this.#acts.onShow(null);
        }
    }

    // The mesh has changed: go on with what is selected as it is now.
    refresh() {
        const gesture = this.#gesture && this.#acts.begin(this.#tool);
        if (gesture === null) {
            this.cancel();
        } else {
            this.#gesture = gesture;
        }
    }

    setEnabled(enabled) {
        this.#isEnabled = enabled;
        for (const button of Object.values(this.#elements.buttons)) {
            enable(button, enabled);
        }
        if (!enabled) {
            this.cancel();
        }
    }

    #press(event) {
        if (this.#gesture === null || event.button !== 0) {
            return;
        }
        event.stopImmediatePropagation();
        if (this.#down === null) {
            this.#down = { x: event.clientX, y: event.clientY, pointer: event.pointerId };
            this.#canvas.setPointerCapture(event.pointerId);
        }
    }

    #move(event) {
        if (this.#down?.pointer === event.pointerId) {
            event.stopImmediatePropagation();
            const { lines, text } = this.#acts.drag(this.#gesture, this.#movedTo(event));
            this.#elements.amount.textContent = text;
            this.#acts.onShow(lines);
        }
    }

    #release(event) {
        if (this.#down?.pointer !== event.pointerId) {
            return;
        }
        event.stopImmediatePropagation();
        const { operation } = this.#acts.drag(this.#gesture, this.#movedTo(event));
        this.cancel();
        if (operation !== null) {
            this.#acts.onRun(operation);
        }
    }

    // How far the pointer has moved, null for a click.
    #movedTo({ clientX, clientY }) {
        const moved = [clientX - this.#down.x, clientY - this.#down.y];
        return Math.hypot(...moved) > CLICK_PIXELS ? moved : null;
    }
}
