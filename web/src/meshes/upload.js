// upload.js - uploads files that were chosen, pasted or dropped on the page, one after another, each
// with the files that it refers to.

import { Problem } from '../wire/api.js';
import { batchesOf } from '../wire/batches.js';
import { nameInText } from '../wire/names.js';
import { fileOf } from './paste.js';

export class Uploads {
    #work;
    #area;
    #isOpen;
    #send;
    #onDone;
    #onRefused;
    #onError;
    #queue = Promise.resolve();
    #depth = 0;

    // `send(batch, onProgress, work)` uploads one batch, see batches.js; `onDone(summary, batch)` is
    // called with the summary of the new mesh; `work` shows the progress, see work.js. If an upload
    // fails, `onRefused(error, batch)` is called, and `onError(error)` for other errors. Nothing can
    // be dropped or pasted while `isOpen()` is false.
    constructor({ input, work, area }, { isOpen, send, onDone, onRefused, onError }) {
        this.#work = work;
        this.#isOpen = isOpen;
        this.#area = area;
        this.#send = send;
        this.#onDone = onDone;
        this.#onRefused = onRefused;
        this.#onError = onError;
        input.addEventListener('change', () => {
            this.#add([...input.files]);
            // The field is emptied, because otherwise the browser would not report that the user
            // chooses the same file again.
            input.value = '';
        });
        this.#listenToDrops();
        document.addEventListener('paste', (event) => this.#paste(event));
    }

    // Uploads what is pasted: files, or the text of a mesh. What is pasted into a field or a dialog
    // is not for the page.
    #paste(event) {
        const isTaken = event.target.closest?.('input, textarea, select, dialog') ?? null;
        if (!this.#isOpen() || isTaken !== null || document.querySelector('dialog[open]') !== null) {
            return;
        }
        event.preventDefault();
        const { files } = event.clipboardData;
        const text = files.length > 0 ? '' : event.clipboardData.getData('text');
        const file = text === '' ? null : fileOf(text);
        if (files.length > 0 || file !== null) {
            this.#add(file === null ? [...files] : [file]);
        } else if (text !== '') {
            const detail = 'The text is not a mesh in the format OBJ, OFF, PLY, STL, glTF or JSON.';
            this.#onError(new Problem({ title: 'Nothing to paste', detail }));
        }
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
                    await this.#upload(batch);
                }
            } catch (error) {
                this.#onError(error); // a file that cannot be read
            }
        });
    }

    async #upload(batch) {
        const { file } = batch;
        this.#work.start(`Uploading ${nameInText(file.name)}`, true);
        try {
            const onProgress = (part) => {
                if (part === 1) {
                    this.#work.start(`Reading ${nameInText(file.name)}`, true);
                }
                this.#work.show({ progress: part });
            };
            const summary = await this.#send(batch, onProgress, this.#work);
            this.#work.end();
            await this.#onDone(summary, batch);
        } catch (error) {
            this.#work.end();
            await this.#onRefused(error, batch);
        }
    }
}
