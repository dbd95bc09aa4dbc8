// live.js - the event stream of a mesh, which reports edits of all clients. When the stream ends it
// is opened again, unless the mesh was deleted. This module does not touch the page.
//
//            first open         ends            opens
//   opening ------------> on ---------> lost ---------> on ...
//                                         |
//                                         | the mesh is not there any more
//   (in any state, after an event `bye`)  v
//                                       gone
//
// A stream that is opened again continues after the last event received. The delay before each
// attempt to open it is longer than the one before.

import { listen, getHistory } from './api.js';

// Milliseconds before the stream is opened again: SOON at first, then twice as long each time, up
// to LATEST. A random part of up to a half is added, so that many pages do not reconnect at once.
const SOON = 250;
const LATEST = 15000;

// If the stream has not opened after this many milliseconds, the page shows the mesh without
// waiting for the stream.
const PATIENCE = 3000;

export class Live {
    state = 'opening';

    #mesh;
    #on;
    #source = null;
    #last = null; // the id of the last event received
    #delay = SOON;
    #timer = 0;
    #isLate = false; // PATIENCE ended before the stream opened
    #isClosed = false;

    // `on.event(name, data)` is called for each event, and `on.state(state)` after a change of
    // state. `on.back()` is called when events may have been missed: when a lost stream continues,
    // or when the first stream opens after the page has stopped waiting for it.
    constructor(mesh, on) {
        this.#mesh = mesh;
        this.#on = on;
    }

    // Opens the stream. The promise resolves when the stream is open, when opening it fails, or
    // after PATIENCE milliseconds.
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
        // An event has arrived, so the connection works, and the delay before the next attempt to
        // open the stream is short again.
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

    // Opens the stream again, unless the mesh was deleted. listen() does not report why the stream
    // failed, so another request finds out whether the mesh still exists.
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
