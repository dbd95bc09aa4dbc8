// slices.js - runs long computations in slices, so that the page answers to the user meanwhile.

// Milliseconds after which a slice ends.
const SLICE = 6;

// Runs a generator to its end and returns what it returns. The generator yields where it may be
// interrupted, at least every few thousand steps. What is short is done at once, in one slice. Throws
// the reason of `signal` when this is aborted, for instance because the data have changed.
export async function inSlices(steps, signal) {
    for (;;) {
        const end = performance.now() + SLICE;
        do {
            const { done, value } = steps.next();
            if (done) {
                return value;
            }
        } while (performance.now() < end);
        await nextTask();
        signal?.throwIfAborted();
    }
}

// Resolves after events that wait have been handled. Timers are not used, because browsers delay
// timers that follow each other by 4 ms each.
function nextTask() {
    return new Promise((resolve) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {
            port1.close();
            resolve();
        };
        port2.postMessage(null);
    });
}
