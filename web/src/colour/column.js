// column.js - one number for each element of a kind, and what the legend says about these numbers.
// Pure.
//
// The numbers are in a Float64Array by id. An element without a number, and an id without an element,
// has NaN; `ids` lists the elements that exist.

// If the values beyond the first and the last percent spread over more than this many times the range
// of the others, the colours show the range of the others.
const MOST_SPREAD = 4;

// At most so many numbers are looked at to find the extreme ones.
const MOST_SAMPLES = 50000;

// A map of categories is offered for at most this many different values.
const MOST_CATEGORIES = 256;

export class Column {
    numbers;
    ids;
    least = Infinity; // the smallest and the largest number; if there is none, least > most
    most = -Infinity;
    count = 0; // how many elements have a number
    missing = 0; // how many elements have none
    isWhole = true; // all numbers are integers
    #counts = new Map(); // histograms by their number of bins
    #inner = null; // the range of the numbers without the first and the last percent
    #categories; // undefined until they are asked for

    constructor(numbers, ids) {
        [this.numbers, this.ids] = [numbers, ids];
        for (const id of ids) {
            const number = id < numbers.length ? numbers[id] : NaN;
            if (Number.isFinite(number)) {
                this.least = Math.min(this.least, number);
                this.most = Math.max(this.most, number);
                this.isWhole &&= Number.isInteger(number);
                this.count++;
            } else {
                this.missing++;
            }
        }
    }

    // Returns the number of an element, or NaN.
    at(id) {
        const number = this.numbers[id] ?? NaN;
        return Number.isFinite(number) ? number : NaN;
    }

    // Returns how many elements have a number in each of `bins` parts of the range from the least to
    // the largest number.
    histogram(bins) {
        if (!this.#counts.has(bins)) {
            this.#counts.set(bins, this.#count(bins));
        }
        return this.#counts.get(bins);
    }

    #count(bins) {
        const counts = new Uint32Array(bins);
        for (const id of this.ids) {
            const number = this.at(id);
            if (!Number.isNaN(number)) {
                counts[this.#binOf(number, bins)]++;
            }
        }
        return counts;
    }

    #binOf(number, bins) {
        const width = this.most - this.least;
        const part = width > 0 ? (number - this.least) / width : 0;
        return Math.min(Math.floor(part * bins), bins - 1);
    }

    // Returns the ids whose numbers pass a test.
    find(test) {
        return [...this.ids].filter((id) => test(this.at(id)));
    }

    // Returns a test for find(): whether a number is in a part of the histogram.
    isInBin(bin, bins) {
        return (number) => !Number.isNaN(number) && this.#binOf(number, bins) === bin;
    }

    // Returns the range [from, to] that the colours show if the user has chosen none. A few extreme
    // values do not make all others look equal. If `isEven` is true, 0 is in the middle.
    usualRange(isEven) {
        if (this.count === 0) {
            return [0, 0];
        }
        this.#inner ??= this.#innerRange();
        const [low, high] = this.#inner;
        const isSpread = this.most - this.least > MOST_SPREAD * (high - low) && high > low;
        const [from, to] = isSpread ? [low, high] : [this.least, this.most];
        const reach = Math.max(Math.abs(from), Math.abs(to));
        return isEven ? [-reach, reach] : [from, to];
    }

    // Of many elements, every second, third, ... one is looked at.
    #innerRange() {
        const step = Math.ceil(this.ids.length / MOST_SAMPLES);
        const samples = [];
        for (let i = 0; i < this.ids.length; i += step) {
            const number = this.at(this.ids[i]);
            if (!Number.isNaN(number)) {
                samples.push(number);
            }
        }
        const sorted = Float64Array.from(samples).sort();
        const at = (part) => sorted[Math.round(part * (sorted.length - 1))] ?? this.least;
        return [at(0.01), at(0.99)];
    }

    // Returns {value, count} of each different number in ascending order, or null if there are more
    // than MOST_CATEGORIES.
    get categories() {
        if (this.#categories === undefined) {
            this.#categories = this.#findCategories();
        }
        return this.#categories;
    }

    #findCategories() {
        const counts = new Map();
        for (const id of this.ids) {
            const number = this.at(id);
            if (!Number.isNaN(number)) {
                counts.set(number, (counts.get(number) ?? 0) + 1);
                if (counts.size > MOST_CATEGORIES) {
                    return null;
                }
            }
        }
        const sorted = [...counts].sort(([a], [b]) => a - b);
        return sorted.map(([value, count]) => ({ value, count }));
    }
}
