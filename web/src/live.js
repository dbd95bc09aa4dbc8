// live.js - the event stream of a mesh, which reports edits of all clients. It is opened again when
// it ends, unless the mesh was deleted. No page in here.
//
//            first open         ends            opens
//   opening ------------> on ---------> lost ---------> on ...
//                                         |
//                                         | the mesh is not there any more
//      (or from any state by `bye`)       v
//                                       gone
//
// The stream continues after the last event received. The delay grows with each attempt.

import { listen, getHistory } from './api.js';

// Milliseconds before another attempt; a random part of up to a half is added, so that many pages
// do not reconnect at once.
const SOON = 250;
const LATEST = 15000;

// If no stream opens within this time, the page shows the mesh without it.
const PATIENCE = 3000;

export class Live {
    state = 'opening';

    #mesh;
    #on;
    #source = null;
    #last = null; // the id of the last event
    #delay = SOON;
    #timer = 0;
    #isLate = false; // the page did not wait for the stream
    #isClosed = false;

    // `on.event(name, data)` is called for each event, `on.state(state)` after a change of state,
    // `on.back()` when a lost stream continues, or the first one opens after the page has stopped waiting
    // for it: events may have been missed.
    constructor(mesh, on) {
        this.#mesh = mesh;
        this.#on = on;
    }

    // Opens the stream; resolves when it is open, or when there is none for now.
    open() {
        return new Promise((resolve) => {
            const timer = setTimeout(() => {
                this.#isLate = true;
                resolve();
            }, PATIENCE);
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
        const hasMissed = this.state === 'lost' || this.#isLate;
        this.#isLate = false;
        this.#setState('on');
        if (hasMissed) {
            this.#on.back();
        }
    }

    #receive(name, data) {
        // A stream that delivers something works.
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

    // A failed stream does not say why it was refused; another request does.
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
