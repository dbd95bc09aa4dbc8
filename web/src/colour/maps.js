// maps.js - colour maps: which colour stands for a value. Pure.
//
// The maps are computed in OKLCH (lightness, chroma, hue), where equal steps look equally large, so
// that no value stands out that is not special. Lightness alone orders the colours of a sequential
// map, so it can also be read by people who see few colours, and in grey.

// The number of colours of a map. The shader rounds a value to one of them.
export const COLOURS = 256;

// The colour of elements without a value, as sRGB from 0 to 255; value_shader.js has it, too.
export const MISSING = [128, 128, 128];

// Converts a colour from OKLCH (hue in degrees) to linear sRGB; parts of a colour that a screen cannot
// show are below 0 or above 1. The matrices are those of Bjoern Ottosson's definition of OKLab.
function linearOf(lightness, chroma, hue) {
    const angle = (hue * Math.PI) / 180;
    const [a, b] = [chroma * Math.cos(angle), chroma * Math.sin(angle)];
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    return [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
}

const isShown = (linear) => linear.every((part) => part >= -1e-6 && part <= 1 + 1e-6);

// Converts a linear part of a colour to sRGB (IEC 61966-2-1), 0 to 255.
function byteOf(linear) {
    const part = Math.min(Math.max(linear, 0), 1);
    return Math.round(255 * (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055));
}

// Returns a colour as sRGB, 0 to 255. If a screen cannot show it, its chroma is reduced until it can.
export function colourOf(lightness, chroma, hue) {
    let linear = linearOf(lightness, chroma, hue);
    if (!isShown(linear)) {
        let [low, high] = [0, chroma];
        for (let i = 0; i < 20; i++) {
            const middle = (low + high) / 2;
            [low, high] = isShown(linearOf(lightness, middle, hue)) ? [middle, high] : [low, middle];
        }
        linear = linearOf(lightness, low, hue);
    }
    return linear.map(byteOf);
}

// From dark violet over green to light yellow.
function sequential(t) {
    return colourOf(0.27 + 0.66 * t, 0.1, 295 - 190 * t);
}

// From blue over a light grey in the middle to red: for values on both sides of zero.
function diverging(t) {
    const away = Math.abs(2 * t - 1);
    return colourOf(0.93 - 0.45 * away, 0.17 * away, t < 0.5 ? 255 : 30);
}

// Distinct colours: neighbours in the list differ by the golden angle of hue, and in lightness.
export function categorical(i) {
    return colourOf([0.7, 0.52, 0.86][i % 3], 0.15, 30 + 137.50776405 * i);
}

const FORMULAS = {
    sequential: (i) => sequential(i / (COLOURS - 1)),
    diverging: (i) => diverging(i / (COLOURS - 1)),
    categorical,
};

// Returns the colours of a map, four bytes each: red, green, blue and 255.
export function mapOf(name) {
    const bytes = new Uint8Array(4 * COLOURS);
    for (let i = 0; i < COLOURS; i++) {
        bytes.set([...FORMULAS[name](i), 255], 4 * i);
    }
    return bytes;
}

// Returns the index of the colour that stands for a value in a range, in a map that is not categorical.
export function indexOf(value, [from, to]) {
    const part = to > from ? (value - from) / (to - from) : value >= to ? 1 : 0;
    return Math.round(Math.min(Math.max(part, 0), 1) * (COLOURS - 1));
}
