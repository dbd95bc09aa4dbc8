// progressive.js - parses the answer of GET .../progressive, a coarse mesh and the vertex splits
// that refine it, as it arrives in pieces of any size. Pure: no page, no network.
//
//   header     "HEDP", version, revision, counts, bounds of ids, least and largest coordinates
//   vertices   u32 id, 0, f64 x 3
//   edges      u32 id, origin, target, 0: not needed to draw
//   faces      u32 id, three corners
//   splits     coarse to fine:
//
//           c                       c          `moved` faces take u where they have v, and `left`
//           o                       o          and `right`, (u, v, c) and (v, u, d), are new; a
//         /   \                   / | \        side without a face has none
//        o  v  o      --->       o u-v o
//         \   /                   \ | /
//           o                       o
//           d                       d

const MAGIC = 0x50444548; // "HEDP"
const VERSION = 1;
const NONE = 0xffffffff;

// The parts in their order, and the bytes per row of each; a split is longer if it moves faces.
const [HEADER, VERTICES, EDGES, FACES, SPLITS] = [0, 1, 2, 3, 4];
const ROW_BYTES = [104, 32, 16, 16, 96];

export class ProgressiveReader {
    #begin;
    #sink = null;
    #bytes = new Uint8Array(65536);
    #words;
    #numbers;
    #held = 0; // bytes that have arrived and are not parsed yet
    #part = HEADER;
    #left = [1, 0, 0, 0, 0]; // rows of each part that are still to arrive

    // `begin({revision, vertices, faces, splits, vertexIds, faceIds})` is called with the mesh's
    // revision, the counts of the base and of the splits, and upper bounds of ids. It returns an
    // object that receives the rows: addVertex(id, place), addFace(id, corners) and
    // addSplit({vertex, from, left, right, at, fromAt, moved}), where `left` and `right` are {face,
    // corner} or null. `moved` is valid only during the call.
    constructor(begin) {
        this.#begin = begin;
        this.#view();
    }

    // Parses the next bytes. Throws a RangeError if they are invalid.
    push(bytes) {
        this.#take(bytes);
        let at = 0;
        while (this.#part <= SPLITS) {
            const length = this.#left[this.#part] > 0 ? this.#lengthAt(at) : 0;
            if (length > this.#held - at) {
                break;
            }
            if (length === 0) {
                this.#part++;
            } else {
                this.#read(at);
                this.#left[this.#part]--;
                at += length;
            }
        }
        this.#bytes.copyWithin(0, at, this.#held);
        this.#held -= at;
        if (this.#part > SPLITS && this.#held > 0) {
            throw new RangeError('The levels of the mesh are longer than their header says.');
        }
    }

    // Ends the input. Throws a RangeError if bytes are missing.
    end() {
        if (this.#part <= SPLITS) {
            throw new RangeError('The levels of the mesh did not arrive completely.');
        }
    }

    #take(bytes) {
        const length = this.#held + bytes.length;
        if (length > this.#bytes.length) {
            const longer = new Uint8Array(8 * Math.ceil(length / 4));
            longer.set(this.#bytes.subarray(0, this.#held));
            this.#bytes = longer;
            this.#view();
        }
        this.#bytes.set(bytes, this.#held);
        this.#held = length;
    }

    // All rows are multiples of 8 bytes long, so numbers are aligned.
    #view() {
        this.#words = new Uint32Array(this.#bytes.buffer);
        this.#numbers = new Float64Array(this.#bytes.buffer);
    }

    // Returns the length of the row at an offset, or a lower bound if it has not arrived
    // completely.
    #lengthAt(at) {
        const least = ROW_BYTES[this.#part];
        if (this.#part !== SPLITS || this.#held - at < least) {
            return least;
        }
        const [length, moved] = [this.#words[at / 4], this.#words[at / 4 + 10]];
        if (length !== least + 8 * Math.ceil(moved / 2)) {
            throw unreadable();
        }
        return length;
    }

    #read(at) {
        const word = at / 4;
        if (this.#part === HEADER) {
            this.#readHeader(word);
        } else if (this.#part === VERTICES) {
            this.#sink.addVertex(this.#words[word], this.#placeAt(at + 8));
        } else if (this.#part === FACES) {
            this.#sink.addFace(this.#words[word], this.#words.subarray(word + 1, word + 4));
        } else if (this.#part === SPLITS) {
            this.#readSplit(at);
        }
    }

    #readHeader(word) {
        const words = this.#words.subarray(word, word + 14);
        if (words[0] !== MAGIC || words[1] !== VERSION) {
            throw unreadable();
        }
        const revision = words[2] + 2 ** 32 * words[3];
        const [vertices, edges, faces, splits] = words.subarray(4, 8);
        const [vertexIds, , faceIds] = words.subarray(10, 13);
        this.#left = [1, vertices, edges, faces, splits];
        this.#sink = this.#begin({ revision, vertices, faces, splits, vertexIds, faceIds });
    }

    #readSplit(at) {
        const word = at / 4;
        const words = this.#words;
        const side = (face, corner) => (face === NONE ? null : { face, corner });
        this.#sink.addSplit({
            vertex: words[word + 1],
            from: words[word + 2],
            left: side(words[word + 8], words[word + 3]),
            right: side(words[word + 9], words[word + 4]),
            at: this.#placeAt(at + 48),
            fromAt: this.#placeAt(at + 72),
            moved: words.subarray(word + 24, word + 24 + words[word + 10]),
        });
    }

    #placeAt(at) {
        const i = at / 8;
        return [this.#numbers[i], this.#numbers[i + 1], this.#numbers[i + 2]];
    }
}

// Returns the error for invalid bytes, also for faults that the receiver of the rows finds.
export function unreadable() {
    return new RangeError('This page cannot read the levels that the server sent.');
}
