// Tests that the parser of event streams returns the same events in whatever pieces a stream
// arrives.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { EventReader } from '../../web/src/wire/events.js';

const STREAM =
    'retry: 3000\nid: a.1\n\n: comment\n\nevent: edit\nid: a.2\ndata: {"x":1}\n\n' +
    'data: one\ndata: two\r\n\r\nevent: nothing\n\nevent: bye\ndata:plain\n\nevent: cut\ndata: x';

const EVENTS = [
    { name: 'edit', data: '{"x":1}', id: 'a.2' },
    { name: 'message', data: 'one\ntwo', id: 'a.2' },
    { name: 'bye', data: 'plain', id: 'a.2' },
];

test('events are those of the stream, wherever it is cut', () => {
    for (let size = 1; size <= STREAM.length; size++) {
        const reader = new EventReader();
        const events = [];
        for (let at = 0; at < STREAM.length; at += size) {
            events.push(...reader.take(STREAM.slice(at, at + size)));
        }
        assert.deepEqual(events, EVENTS, `pieces of ${size}`);
    }
});

test('an id without an event counts', () => {
    const reader = new EventReader();
    reader.take('id: a.7\n\n');
    assert.equal(reader.id, 'a.7');
});
