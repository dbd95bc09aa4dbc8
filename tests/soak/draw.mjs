// draw.mjs - draws the memory of each minute as a picture.

const WIDTH = 760;
const HEIGHT = 340;
const AREA = { left: 60, right: WIDTH - 150, top: 20, bottom: HEIGHT - 45 };
const LINES = [
    ['most', 'most in the minute', '#8a8a8a'],
    ['loaded', 'mean under load', '#2f7fc1'],
    ['rest', 'at rest', '#d1741f'],
    ['counted', 'counted at rest', '#3a9a4b'],
];

// Returns a step of the axis, 1, 2 or 5 times a power of ten, so that about five steps reach
// `most`.
function stepFor(most) {
    const rough = most / 5;
    const power = 10 ** Math.floor(Math.log10(rough));
    return power * [1, 2, 5, 10].find((times) => times * power >= rough);
}

export function drawSoak(minutes) {
    const most = Math.max(...minutes.map((line) => line.most));
    const step = stepFor(most);
    const top = Math.ceil(most / step) * step;
    const last = Math.max(1, minutes.at(-1).minute);
    const x = (minute) => AREA.left + ((AREA.right - AREA.left) * minute) / last;
    const y = (mib) => AREA.bottom - ((AREA.bottom - AREA.top) * mib) / top;
    const parts = [];
    for (let mib = 0; mib <= top; mib += step) {
        parts.push(
            `<line class="grid" x1="${AREA.left}" x2="${AREA.right}" y1="${y(mib)}" y2="${y(mib)}"/>`,
            `<text x="${AREA.left - 8}" y="${y(mib) + 4}" text-anchor="end">${mib}</text>`,
        );
    }
    const every = Math.max(1, stepFor(last));
    for (let minute = 0; minute <= last; minute += every) {
        parts.push(
            `<text x="${x(minute)}" y="${AREA.bottom + 18}" text-anchor="middle">${minute}</text>`,
        );
    }
    LINES.forEach(([member, title, colour], i) => {
        const points = minutes.map((line) => `${x(line.minute).toFixed(1)},${y(line[member]).toFixed(1)}`);
        const at = AREA.top + 10 + 20 * i;
        parts.push(
            `<polyline fill="none" stroke="${colour}" stroke-width="2" points="${points.join(' ')}"/>`,
            `<line stroke="${colour}" stroke-width="2" x1="${AREA.right + 12}" x2="${AREA.right + 30}" ` +
                `y1="${at}" y2="${at}"/>`,
            `<text x="${AREA.right + 36}" y="${at + 4}">${title}</text>`,
        );
    });
    const middle = (AREA.left + AREA.right) / 2;
    parts.push(
        `<text x="${middle}" y="${HEIGHT - 8}" text-anchor="middle">minutes</text>`,
        `<text x="${AREA.left}" y="12">MiB</text>`,
    );
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img">
<title>Memory of the daemon by the minute</title>
<style>text { font: 12px sans-serif; fill: #1a1a1a } .grid { stroke: #d8d8d8 }
.paper { fill: #ffffff }
@media (prefers-color-scheme: dark) { text { fill: #e6e6e6 } .grid { stroke: #444444 }
.paper { fill: #16181c } }</style>
<rect class="paper" width="${WIDTH}" height="${HEIGHT}"/>
${parts.join('\n')}
</svg>
`;
}
