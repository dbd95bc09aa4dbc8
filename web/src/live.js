// live.js - what other clients do to a mesh, as it happens: its event stream, opened again whenever
// it ends before its mesh does. No page in here.
//
//            first open         ends            opens
//   opening ------------> on ---------> lost ---------> on ...
//                                         |
//                                         | the mesh is not there any more
//      (or from any state by `bye`)       v
//                                       gone
//
// The stream goes on after the last event that was seen. Waiting grows with each attempt.

import { listen, getHistory } from './api.js';

// Milliseconds before another attempt; each is up to half as long again, so that many pages do not
// come back at once.
const SOON = 250;
const LATEST = 15000;

// A page is opened without a stream where none opens within this time.
const PATIENCE = 3000;

export class Live {
    state = 'opening';

    #mesh;
    #on;
    #source = null;
    #last = null; // the id of the last event
    #delay = SOON;
    #timer = 0;
    #isClosed = false;

    // `on.event(name, data)`; `on.state(state)` after it has changed; `on.back()` when the stream
    // goes on after it was lost: something may have been missed.
    constructor(mesh, on) {
        this.#mesh = mesh;
        this.#on = on;
    }

    // Begin; resolves when the stream is open, or when there is none for now.
    open() {
        return new Promise((resolve) => {
            const timer = setTimeout(resolve, PATIENCE);
            this.#listen(() => {
                clearTimeout(timer);
                resolve();
            });
        });
    }

    close() {
        this.#isClosed = true;
        this.#source?.close();
        clearTimeout(this.#timer);
    }

    #listen(settled = () => {}) {
        const source = listen(this.#mesh, this.#last, {
            onOpen: () => {
                if (source === this.#source) {
                    this.#opened();
                    settled();
                }
            },
            onEvent: (name, data, id) => {
                if (source === this.#source) {
                    this.#last = id || this.#last;
                    this.#receive(name, data);
                }
            },
            onError: () => {
                if (source === this.#source) {
                    this.#lose();
                    settled();
                }
            },
        });
        this.#source = source;
    }

    #opened() {
        const wasLost = this.state === 'lost';
        this.#setState('on');
        if (wasLost) {
            this.#on.back();
        }
    }

    #receive(name, data) {
        // A stream that brings something is a good one.
        this.#delay = SOON;
        if (name === 'bye' && data.reason === 'deleted') {
            this.close();
            this.#setState('gone');
        } else if (name === 'bye') {
            this.#source.close();
            this.#lose();
        } else {
            this.#on.event(name, data);
        }
    }

    #lose() {
        if (this.#isClosed) {
            return;
        }
        this.#source = null;
        this.#setState('lost');
        this.#timer = setTimeout(() => this.#retry(), this.#delay * (1 + Math.random() / 2));
        this.#delay = Math.min(2 * this.#delay, LATEST);
    }

    // A stream does not say why it is refused; something else that is asked does.
    async #retry() {
        try {
            await getHistory(this.#mesh);
        } catch (error) {
            if (!this.#isClosed && error.status === 404) {
                this.close();
                this.#setState('gone');
            } else {
                this.#lose();
            }
            return;
        }
        if (!this.#isClosed) {
            this.#listen();
        }
    }

    #setState(state) {
        if (this.state !== state) {
            this.state = state;
            this.#on.state(state);
        }
    }
}
