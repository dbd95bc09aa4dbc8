// direct.js - tools that work in the view: a key or a button selects a tool, a drag previews the
// tool's edit, and releasing the pointer runs the edit. A click applies a default amount; Esc
// cancels.

import { enable } from '../kit/dom.js';

// A press of the pointer is a click if the pointer moves at most this far before it is released.
const CLICK_PIXELS = 4;

const HINTS = {
    move: 'Drag to move the selection, or type how far.',
    extrude: 'Drag to extrude, type a distance, or click for a default distance.',
    inset: 'Drag to inset, type an amount, or click for a default amount.',
};

export class Direct {
    #canvas;
    #elements;
    #acts;
    #tool = null;
    #gesture = null;
    #down = null; // position and id of the pointer when the drag began
    #isEnabled = false;

    // `note` is an element that is shown while a tool is selected; it contains `hint`, `amount` and
    // a button, `giveUp`. `buttons` has one button for each tool. `acts` are four functions:
    // begin(tool) returns a gesture or null, and drag(gesture, moved) returns the gesture's result
    // (see gesture.js); onShow(lines) draws a preview, or removes it if `lines` is null;
    // onRun(operation) runs an edit.
    constructor(canvas, { note, hint, amount, giveUp, buttons }, acts) {
        this.#canvas = canvas;
        this.#elements = { note, hint, amount, buttons };
        this.#acts = acts;
        giveUp.addEventListener('click', () => this.cancel());
        note.addEventListener('keydown', ({ key }) => {
            if (key === 'Escape') {
                this.cancel();
                canvas.focus();
            }
        });
        // Listens in the capture phase, so that other listeners do not see the events of a drag.
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

    // The name of the operation that the selected tool runs, or null.
    get operation() {
        return this.#gesture?.op ?? null;
    }

    // Selects a tool; returns false if the tool cannot work on the selected elements.
    arm(tool) {
        this.cancel();
        const gesture = this.#isEnabled ? this.#acts.begin(tool) : null;
        if (gesture === null) {
            return false;
        }
        [this.#tool, this.#gesture] = [tool, gesture];
        const { note, hint, amount, buttons } = this.#elements;
        hint.textContent = `${HINTS[tool]} Press Esc to cancel.`;
        amount.textContent = '';
        note.hidden = false;
        buttons[tool].setAttribute('aria-pressed', 'true');
        this.#canvas.focus();
        return true;
    }

    // Called when the button of a tool was pressed: selects the tool, or cancels it if it was
    // selected.
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

    // Called when the mesh has changed. A selected tool stays selected, and a drag continues on the
    // changed mesh; but if the tool no longer fits the selection, it is cancelled.
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
            this.#canvas.focus();
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
        if (operation !== null) {
            this.#acts.onRun(operation);
        }
        this.cancel();
    }

    // Returns how far the pointer has moved since it was pressed; null if it has moved so little
    // that the press is a click.
    #movedTo({ clientX, clientY }) {
        const moved = [clientX - this.#down.x, clientY - this.#down.y];
        return Math.hypot(...moved) > CLICK_PIXELS ? moved : null;
    }
}
