// plot.mjs - draws lines on two logarithmic axes, each with its name at its end.

const WIDTH = 900;
const HEIGHT = 600;
const AREA = { left: 62, right: WIDTH - 262, top: 40, bottom: HEIGHT - 58 };
const LABEL_STEP = 17;

const escape = (text) => text.replace(/[&<>]/g, (sign) => `&#${sign.charCodeAt(0)};`);

// Returns the positions of labels: as near to their lines as possible without touching each other.
function spread(wanted) {
    const order = wanted.map((y, i) => [y, i]).sort(([a], [b]) => a - b);
    const places = [];
    order.forEach(([y], k) => {
        places[k] = Math.max(y, k > 0 ? places[k - 1] + LABEL_STEP : AREA.top);
    });
    for (let k = places.length - 1, most = AREA.bottom; k >= 0; k--, most -= LABEL_STEP) {
        places[k] = Math.min(places[k], most);
        most = places[k];
    }
    return order.reduce((all, [, i], k) => Object.assign(all, { [i]: places[k] }), {});
}

// Returns an SVG of `lines`, each {title, colour, dashed, values}, over `sizes`, whose names on the
// axis are `names`.
export function plot({ sizes, names, caption, lines }) {
    const values = lines.flatMap((line) => line.values);
    const [low, high] = [Math.floor(Math.log10(Math.min(...values))),
        Math.log10(Math.max(...values)) + 0.05];
    const [first, last] = [sizes[0], sizes.at(-1)].map(Math.log10);
    const x = (size) =>
        AREA.left + ((AREA.right - AREA.left) * (Math.log10(size) - first)) / (last - first);
    const y = (value) =>
        AREA.bottom - ((AREA.bottom - AREA.top) * (Math.log10(value) - low)) / (high - low);
    const parts = [];
    for (let power = low; power <= high; power++) {
        for (const times of [1, 2, 5]) {
            const value = times * 10 ** power;
            if (Math.log10(value) > high) {
                continue;
            }
            parts.push(
                `<line class="grid" x1="${AREA.left}" x2="${AREA.right}" ` +
                    `y1="${y(value).toFixed(1)}" y2="${y(value).toFixed(1)}"/>`,
                `<text x="${AREA.left - 8}" y="${(y(value) + 4).toFixed(1)}" text-anchor="end">` +
                    `${Number(value.toPrecision(1))}</text>`,
            );
        }
    }
    sizes.forEach((size, i) => {
        const at = x(size).toFixed(1);
        parts.push(
            `<line class="grid" x1="${at}" x2="${at}" y1="${AREA.top}" y2="${AREA.bottom}"/>`,
            `<text x="${at}" y="${AREA.bottom + 18}" text-anchor="middle">${names[i]}</text>`,
        );
    });
    const labels = spread(lines.map((line) => y(line.values.at(-1))));
    lines.forEach(({ title, colour, dashed, values: list }, i) => {
        const points = list.map((value, k) => `${x(sizes[k]).toFixed(1)},${y(value).toFixed(1)}`);
        const dash = dashed ? ' stroke-dasharray="6 4"' : '';
        const [from, to] = [y(list.at(-1)), labels[i]].map((place) => place.toFixed(1));
        const end = `${AREA.right + 4},${from} ${AREA.right + 18},${to}`;
        parts.push(
            `<polyline fill="none" stroke="${colour}" stroke-width="2"${dash} ` +
                `points="${points.join(' ')}"/>`,
            ...points.map((point) => {
                const [cx, cy] = point.split(',');
                return `<circle cx="${cx}" cy="${cy}" r="3" fill="${colour}"/>`;
            }),
            `<polyline fill="none" stroke="${colour}" points="${end}"/>`,
            `<text x="${AREA.right + 22}" y="${(labels[i] + 4).toFixed(1)}">` +
                `${escape(title)}</text>`,
        );
    });
    const middle = (AREA.left + AREA.right) / 2;
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img">
<title>Nanoseconds an element by the size of the mesh</title>
<style>text { font: 12px sans-serif; fill: #1a1a1a } .grid { stroke: #dcdcdc }
.paper { fill: #ffffff } .note { font-size: 11px }
@media (prefers-color-scheme: dark) { text { fill: #e6e6e6 } .grid { stroke: #3c4048 }
.paper { fill: #16181c } }</style>
<rect class="paper" width="${WIDTH}" height="${HEIGHT}"/>
<text x="8" y="20">nanoseconds an element; one thread, processor time; dashed: ids shuffled</text>
${parts.join('\n')}
<text x="${middle}" y="${AREA.bottom + 36}" text-anchor="middle">faces of the mesh</text>
<text class="note" x="8" y="${HEIGHT - 6}">${escape(caption)}</text>
</svg>
`;
}
