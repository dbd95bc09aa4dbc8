// work.js - shows long work: its name, its progress, and a button that cancels it.

export class Work {
    #elements;
    #onError;
    #title = '';
    #cancel = null;

    // `box` contains the others and is hidden when there is nothing to show.
    constructor({ box, label, progress, button }, onError) {
        this.#elements = { box, label, progress, button };
        this.#onError = onError;
        button.addEventListener('click', () => this.#giveUp());
    }

    // Called when work is about to begin; `isShown`: it is shown at once, rather than when it turns
    // out to take long.
    start(title, isShown) {
        const { box, label, progress, button } = this.#elements;
        this.#title = title;
        label.textContent = title;
        progress.value = 0;
        button.hidden = true;
        box.hidden = !isShown;
    }

    // Called when the work begins: from now on `cancel()` cancels it, which may return a promise.
    begin(cancel) {
        const { box, button } = this.#elements;
        this.#cancel = cancel;
        button.hidden = false;
        button.disabled = false;
        box.hidden = false;
    }

    // Shows progress, 0 to 1, and the phase, as a job of the server reports them.
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
