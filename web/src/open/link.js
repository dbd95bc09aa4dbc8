// link.js - writes and reads the fragment of the page's address, which says what is shown, such as
// #mesh=cube&face=3&camera=1,2,3,... Pure.

const KINDS = ['vertex', 'halfedge', 'edge', 'face'];
const CAMERA_NUMBERS = 6;

// Returns what a fragment says, {mesh, kind, id, camera}; members are null if the fragment does not
// have them or has invalid values.
export function parseLink(fragment) {
    const members = new URLSearchParams(fragment.replace(/^#/, ''));
    const kind = KINDS.find((name) => /^\d{1,10}$/.test(members.get(name) ?? '')) ?? null;
    const camera = (members.get('camera') ?? '').split(',').map((text) => Number(text || NaN));
    return {
        mesh: members.get('mesh') || null,
        kind,
        id: kind === null ? null : Number(members.get(kind)),
        camera:
            camera.length === CAMERA_NUMBERS && camera.every(Number.isFinite) ? camera : null,
    };
}

export function formatLink({ mesh, kind, id, camera }) {
    const members = new URLSearchParams({ mesh });
    if (kind) {
        members.set(kind, id);
    }
    if (camera) {
        members.set('camera', camera.map((value) => Number(value.toPrecision(6))).join());
    }
    // A fragment may contain commas, so they are not escaped.
    return `#${members}`.replaceAll('%2C', ',');
}
