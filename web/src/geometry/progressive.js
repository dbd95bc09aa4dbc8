// progressive.js - parses the answer of GET .../progressive, a coarse mesh and the vertex splits
// that refine it, as it arrives in pieces of any size. Pure: no page, no network.
//
//   header     "HEDP", version, revision, counts, bounds of ids, least and largest coordinates
//   vertices   u32 id, 0, f64 x 3
//   edges      u32 id, origin, target, 0: not needed to draw
//   faces      u32 id, three corners
//   splits     coarse to fine:
//
//           c                       c          u is the new vertex. In the faces of the list
//           o                       o          `moved`, u replaces v. The faces `left`, (u, v, c),
//         /   \                   / | \        and `right`, (v, u, d), are new; if v is on a
//        o  v  o      --->       o u-v o       boundary, one of them may be absent.
//         \   /                   \ | /
//           o                       o
//           d                       d

const MAGIC = 0x50444548; // "HEDP"
const VERSION = 1;
const NONE = 0xffffffff;

// The parts of the answer in their order, and how many bytes a row of each part has; the row of a
// split is longer if `moved` is not empty.
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

    // `begin({revision, vertices, faces, splits, vertexIds, faceIds})` is called after the header
    // with the revision of the mesh, the numbers of vertices and faces in the coarse mesh, the
    // number of splits, and upper bounds of ids. It returns an object with the functions that
    // receive the rows: addVertex(id, place), addFace(id, corners) and addSplit({vertex, from,
    // left, right, at, fromAt, moved}). In a split, `vertex` is the id of u, `from` that of v, `at`
    // and `fromAt` are their positions, `left` and `right` are {face, corner} or null. `moved` is
    // valid only during the call.
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
            throw new RangeError('The levels of detail are longer than their header says.');
        }
    }

    // Called when all bytes were passed to push(). Throws a RangeError if some are missing.
    end() {
        if (this.#part <= SPLITS) {
            throw new RangeError('The levels of detail did not arrive completely.');
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

    // Makes the arrays that read #bytes as words and as numbers. Every row is a multiple of 8 bytes
    // long, so all numbers are aligned.
    #view() {
        this.#words = new Uint32Array(this.#bytes.buffer);
        this.#numbers = new Float64Array(this.#bytes.buffer);
    }

    // Returns the number of bytes in the row at an offset, or a lower bound of it if the row has
    // not arrived completely.
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

// Returns the error that is thrown for invalid bytes; the functions that receive the rows throw it,
// too.
export function unreadable() {
    return new RangeError('This page cannot read the levels of detail that the server sent.');
}
