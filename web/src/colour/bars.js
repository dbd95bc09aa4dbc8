// bars.js - draws a histogram and the colours of a range, side by side with the same horizontal axis.

const SVG = 'http://www.w3.org/2000/svg';
const HEIGHT = 48; // of the histogram, in its own units
const LEAST = 1.5; // height of the smallest bar that is not empty

export const BINS = 40;

function shape(name, attributes) {
    const node = document.createElementNS(SVG, name);
    Object.entries(attributes).forEach(([key, value]) => node.setAttribute(key, value));
    return node;
}

// Returns a picture of a histogram. `counts` are the numbers of elements in equal parts of the range
// from `least` to `most`; `axis` are the values at the left and the right end of the picture;
// `colourAt(value)` returns a colour. `onBin(bin)` is called when a bar is clicked.
export function histogramOf({ counts, least, most, axis, colourAt }, onBin) {
    const highest = counts.reduce((a, b) => Math.max(a, b), 1);
    const width = axis[1] - axis[0] || 1;
    const placeOf = (value) => (100 * (value - axis[0])) / width;
    const svg = shape('svg', {
        class: 'histogram',
        viewBox: `0 0 100 ${HEIGHT}`,
        preserveAspectRatio: 'none',
        'aria-hidden': 'true',
    });
    counts.forEach((count, bin) => {
        if (count === 0) {
            return;
        }
        const from = least + ((most - least) * bin) / counts.length;
        const to = least + ((most - least) * (bin + 1)) / counts.length;
        const height = Math.max((HEIGHT * count) / highest, LEAST);
        const bar = shape('rect', {
            x: placeOf(from),
            y: HEIGHT - height,
            width: Math.max(placeOf(to) - placeOf(from) - 0.3, 1),
            height,
            fill: colourAt((from + to) / 2),
        });
        bar.dataset.bin = bin;
        bar.addEventListener('click', () => onBin(bin));
        svg.append(bar);
    });
    return svg;
}

// Paints the colours of the values from axis[0] to axis[1] into a canvas.
export function paint(canvas, axis, colourAt) {
    canvas.width = 200;
    canvas.height = 1;
    const context = canvas.getContext('2d');
    for (let x = 0; x < canvas.width; x++) {
        context.fillStyle = colourAt(axis[0] + ((axis[1] - axis[0]) * (x + 0.5)) / canvas.width);
        context.fillRect(x, 0, 1, 1);
    }
}
