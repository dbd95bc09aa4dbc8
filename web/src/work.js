// work.js - what takes long: what it is, how far it is, and a button that gives it up.

export class Work {
    #elements;
    #onError;
    #title = '';
    #cancel = null;

    // `box` holds the others and is hidden while there is nothing to show.
    constructor({ box, label, progress, button }, onError) {
        this.#elements = { box, label, progress, button };
        this.#onError = onError;
        button.addEventListener('click', () => this.#giveUp());
    }

    // What is about to begin; `isShown` says whether at once, or when it turns out to take long.
    start(title, isShown) {
        const { box, label, progress, button } = this.#elements;
        this.#title = title;
        label.textContent = title;
        progress.value = 0;
        button.hidden = true;
        box.hidden = !isShown;
    }

    // From now on `cancel()` gives it up; it may return a promise.
    begin(cancel) {
        const { box, button } = this.#elements;
        this.#cancel = cancel;
        button.hidden = false;
        button.disabled = false;
        box.hidden = false;
    }

    // How far it is, 0 to 1, and with what, as a job of the server says.
    show({ progress, phase = null }) {
        const { label, progress: bar } = this.#elements;
        bar.value = progress;
        label.textContent = phase === null ? this.#title : `${this.#title}: ${phase}`;
    }

    end() {
        this.#elements.box.hidden = true;
    }

    async #giveUp() {
        this.#elements.button.disabled = true;
        try {
            await this.#cancel();
        } catch (error) {
            this.#onError(error);
        }
    }
}
