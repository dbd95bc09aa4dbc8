// upload.js - uploads files that were chosen or dropped on the page, one after another, each with
// the files that it refers to.

import { batchesOf } from './batches.js';

export class Uploads {
    #work;
    #area;
    #isOpen;
    #send;
    #onDone;
    #onError;
    #queue = Promise.resolve();
    #depth = 0;

    // `send(batch, onProgress, work, repairs)` uploads one batch, see batches.js; `onDone(summary,
    // file)` is called with the summary of the new mesh; `work` shows the progress, see work.js.
    // `onError(error, again)` is called if an upload fails; if the server could read the file with
    // repairs, `again` is {label, run}, where run() uploads the file again with these repairs.
    // Nothing can be dropped on the page while `isOpen()` is false.
    constructor({ input, work, area }, { isOpen, send, onDone, onError }) {
        this.#work = work;
        this.#isOpen = isOpen;
        this.#area = area;
        this.#send = send;
        this.#onDone = onDone;
        this.#onError = onError;
        input.addEventListener('change', () => {
            this.#add([...input.files]);
            // The field is emptied, because otherwise the browser would not report that the user
            // chooses the same file again.
            input.value = '';
        });
        this.#listenToDrops();
    }

    // Shows a hint while files are dragged over the page. When the pointer moves from an element
    // into its child, the parent gets a leave event; therefore enter and leave events are counted,
    // and the hint does not flicker.
    #listenToDrops() {
        const hasFiles = (event) => this.#isOpen() && event.dataTransfer?.types.includes('Files');
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
        this.#queue = this.#queue.then(async () => {
            try {
                for (const batch of await batchesOf(files)) {
                    await this.#upload(batch, []);
                }
            } catch (error) {
                this.#onError(error, false); // a file that cannot be read
            }
        });
    }

    #again(batch, repairs) {
        const run = () => {
            this.#queue = this.#queue.then(() => this.#upload(batch, repairs));
        };
        return { label: `Upload with ${repairs.join(', ')}`, run };
    }

    async #upload(batch, repairs) {
        const { file } = batch;
        this.#work.start(`Uploading ${file.name}`, true);
        try {
            const onProgress = (part) => {
                if (part === 1) {
                    this.#work.start(`Reading ${file.name}`, true);
                }
                this.#work.show({ progress: part });
            };
            await this.#onDone(await this.#send(batch, onProgress, this.#work, repairs), file);
        } catch (error) {
            this.#onError(error, error.repair?.length > 0 && this.#again(batch, error.repair));
        } finally {
            this.#work.end();
        }
    }
}
