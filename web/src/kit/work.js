// work.js - shows an upload or an edit that takes long: its name, its progress, and a button that
// cancels it. Such an activity is called work here.

export class Work {
    #elements;
    #onError;
    #title = '';
    #cancel = null;

    // `box` contains the other elements and is hidden when there is no work to show.
    constructor({ box, label, progress, button }, onError) {
        this.#elements = { box, label, progress, button };
        this.#onError = onError;
        button.addEventListener('click', () => this.#giveUp());
    }

    // Called before work begins. If `isShown` is true, the work is shown at once; otherwise it is
    // shown only when begin() is called.
    start(title, isShown) {
        const { box, label, progress, button } = this.#elements;
        this.#title = title;
        label.textContent = title;
        progress.value = 0;
        button.hidden = true;
        box.hidden = !isShown;
    }

    // Shows the work, and a button that cancels it by calling `cancel()`, which may return a
    // promise.
    begin(cancel) {
        const { box, button } = this.#elements;
        this.#cancel = cancel;
        button.hidden = false;
        button.disabled = false;
        box.hidden = false;
    }

    // Shows the progress, 0 to 1, and the name of the phase of the work, as the server's jobs
    // report them.
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
