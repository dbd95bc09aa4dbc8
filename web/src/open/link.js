// link.js - writes and reads the fragment of the page's address, which says what is shown, such as
// #mesh=cube&face=3,5&camera=1,2,3,... Other parts of the page add members of their own, see
// share.js. Pure.

const KINDS = ['vertex', 'halfedge', 'edge', 'face'];
const CAMERA_NUMBERS = 6;
const OWN = ['mesh', ...KINDS, 'camera'];

// The most ids of selected elements that a link has.
export const MOST_IDS = 200;

const IDS = /^\d{1,10}(,\d{1,10})*$/;

// Returns what a fragment says, {mesh, kind, ids, camera, parts}; `mesh`, `kind` and `camera` are
// null if the fragment does not have them or has invalid values. `parts` has all other members of
// the fragment.
export function parseLink(fragment) {
    const members = new URLSearchParams(fragment.replace(/^#/, ''));
    const kind = KINDS.find((name) => IDS.test(members.get(name) ?? '')) ?? null;
    const camera = (members.get('camera') ?? '').split(',').map((text) => Number(text || NaN));
    return {
        mesh: members.get('mesh') || null,
        kind,
        ids: kind === null ? [] : members.get(kind).split(',').slice(0, MOST_IDS).map(Number),
        camera:
            camera.length === CAMERA_NUMBERS && camera.every(Number.isFinite) ? camera : null,
        parts: Object.fromEntries([...members].filter(([name]) => !OWN.includes(name))),
    };
}

export function formatLink({ mesh, kind, ids, camera, parts }) {
    const members = new URLSearchParams({ mesh });
    if (kind) {
        members.set(kind, ids.slice(-MOST_IDS).join());
    }
    if (camera) {
        members.set('camera', camera.map((value) => Number(value.toPrecision(6))).join());
    }
    for (const [name, value] of Object.entries(parts)) {
        members.set(name, value);
    }
    // A fragment may contain commas, so they are not escaped.
    return `#${members}`.replaceAll('%2C', ',');
}
