// wiper.js - the line that divides the view into before and now: it is dragged, or moved by a
// slider.

export class Wiper {
    part = 0.5; // how much of the view's width shows what was before, 0 to 1
    #slider;
    #line;
    #onMove;

    // `line` lies over the view, `slider` moves it by keys. `onMove(part)` is called when it moves.
    constructor({ slider, line }, onMove) {
        this.#slider = slider;
        this.#line = line;
        this.#onMove = onMove;
        slider.addEventListener('input', () => this.#moveTo(slider.valueAsNumber / 100));
        line.addEventListener('pointerdown', (event) => {
            line.setPointerCapture(event.pointerId);
            event.preventDefault();
        });
        line.addEventListener('pointermove', (event) => {
            if (line.hasPointerCapture(event.pointerId)) {
                const { left, width } = line.parentElement.getBoundingClientRect();
                this.#moveTo((event.clientX - left) / width);
            }
        });
    }

    // Shows or hides the line and its slider.
    show(isShown) {
        this.#line.hidden = !isShown;
        this.#slider.parentElement.hidden = !isShown;
        if (isShown) {
            this.#place();
        }
    }

    #moveTo(part) {
        this.part = Math.min(Math.max(part, 0), 1);
        this.#place();
        this.#onMove(this.part);
    }

    #place() {
        const percent = Math.round(100 * this.part);
        this.#slider.value = percent;
        this.#slider.setAttribute('aria-valuetext', `${percent} % before`);
        this.#line.style.left = `${100 * this.part}%`;
    }
}
