// listen.js - listens to the events of a mesh, and shows this page to its other clients.

import { EventReader } from './events.js';
import { meshPath, request } from './request.js';

const HEARD = ['edit', 'metadata', 'moment', 'presence', 'resync', 'bye'];

// Listens to the events of a mesh. The first event is the one after `since`, which is the id of an
// event or a revision; if `since` is null, the next one that happens. Calls onOpen when the server
// has answered, onEvent with the name, the data and the id of each event, and onError, once, when
// the stream has ended. Returns an object with close().
export function listen(mesh, since, { onOpen, onEvent, onError }) {
    const closing = new AbortController();
    follow(`${meshPath(mesh)}/events`, since, { onOpen, onEvent }, closing.signal)
        .catch(() => {})
        .then(() => closing.signal.aborted || onError());
    return { close: () => closing.abort() };
}

async function follow(path, since, { onOpen, onEvent }, signal) {
    const headers = { Accept: 'text/event-stream' };
    if (since !== null) {
        headers['Last-Event-ID'] = since;
    }
    const answer = await request(path, { headers, signal, cache: 'no-store' });
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    const events = new EventReader();
    onOpen();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
        for (const { name, data, id } of events.take(part.value)) {
            if (!signal.aborted && HEARD.includes(name)) {
                onEvent(name, JSON.parse(data), id);
            }
        }
    }
}

// Shows something of this page to the other clients of a mesh: {client, name, selection, camera,
// leaves}. `isLeaving` says that the page is being left, and that the request must outlive it.
export function putPresence(mesh, presence, isLeaving = false) {
    return request(`${meshPath(mesh)}/presence`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json', Prefer: 'return=minimal' },
        body: JSON.stringify(presence),
        keepalive: isLeaving,
    });
}
