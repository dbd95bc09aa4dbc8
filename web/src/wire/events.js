// events.js - a parser for text/event-stream: it is given pieces of text and returns events.
// EventSource cannot send Authorization, so the stream is fetched like other requests.

export class EventReader {
    id = ''; // id of the last event that had one

    #rest = ''; // an incomplete line
    #name = '';
    #data = [];

    // Returns the events that a piece of the stream completes: [{name, data, id}, ...].
    take(text) {
        const lines = (this.#rest + text).split('\n');
        this.#rest = lines.pop();
        return lines.map((line) => this.#take(line.replace(/\r$/, ''))).filter(Boolean);
    }

    #take(line) {
        if (line === '') {
            const event = { name: this.#name || 'message', data: this.#data.join('\n'), id: this.id };
            const isEvent = this.#data.length > 0;
            this.#name = '';
            this.#data = [];
            return isEvent ? event : null;
        }
        const [, field, value] = /^([^:]*):? ?(.*)$/.exec(line);
        if (field === 'event') {
            this.#name = value;
        } else if (field === 'data') {
            this.#data.push(value);
        } else if (field === 'id') {
            this.id = value;
        }
        return null;
    }
}
