// upload.js - files from the button or dropped on the page, sent one after another.

export class Uploads {
    #progress;
    #label;
    #area;
    #send;
    #onDone;
    #onError;
    #queue = Promise.resolve();
    #depth = 0;

    // `send(file, onProgress)` uploads one file; `onDone(summary)` gets what became of it.
    constructor({ input, progress, label, area }, { send, onDone, onError }) {
        this.#progress = progress;
        this.#label = label;
        this.#area = area;
        this.#send = send;
        this.#onDone = onDone;
        this.#onError = onError;
        input.addEventListener('change', () => {
            this.#add([...input.files]);
            // The same file may be chosen again.
            input.value = '';
        });
        this.#listenToDrops();
    }

    // Entering a child leaves its parent: count, or the hint would flicker.
    #listenToDrops() {
        const hasFiles = (event) => event.dataTransfer?.types.includes('Files');
        document.addEventListener('dragenter', (event) => {
            if (hasFiles(event)) {
                this.#setDepth(this.#depth + 1);
            }
        });
        document.addEventListener('dragleave', (event) => {
            if (hasFiles(event)) {
                this.#setDepth(Math.max(this.#depth - 1, 0));
            }
        });
        document.addEventListener('dragover', (event) => {
            if (hasFiles(event)) {
                event.preventDefault();
            }
        });
        document.addEventListener('drop', (event) => {
            if (hasFiles(event)) {
                event.preventDefault();
                this.#setDepth(0);
                this.#add([...event.dataTransfer.files]);
            }
        });
    }

    #setDepth(depth) {
        this.#depth = depth;
        this.#area.hidden = depth === 0;
    }

    #add(files) {
        for (const file of files) {
            this.#queue = this.#queue.then(() => this.#upload(file));
        }
    }

    async #upload(file) {
        this.#label.textContent = `Uploading ${file.name}`;
        this.#progress.value = 0;
        this.#progress.parentElement.hidden = false;
        try {
            const summary = await this.#send(file, (part) => {
                this.#progress.value = part;
                if (part === 1) {
                    this.#label.textContent = `Reading ${file.name}`;
                }
            });
            await this.#onDone(summary);
        } catch (error) {
            this.#onError(error);
        } finally {
            this.#progress.parentElement.hidden = true;
        }
    }
}
