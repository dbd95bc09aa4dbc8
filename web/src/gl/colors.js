// colors.js - the colours of the view on a dark and on a light ground, as style/base.css has those of
// the page.

export const COLORS = {
    dark: {
        paper: 0x0e1116, // --stage
        ink: 0xd3deee,
        boundary: 0x35d0e6,
        preview: 0xf4f6fa,
        field: 0xf4f6fa,
        grid: 0x2c3542,
        box: 0x8a97aa,
        axes: [0xff6b6b, 0x6be675, 0x6ea8ff],
        chosen: 0xffb347, // lines and vertices that are selected, --accent
        chosenStart: 0x7a4a10, // at the origin of a selected half-edge
        ruler: 0xff7ad9, // --ruler
        flash: 0xf4f6fa, // what another client has changed
        // faces that only an earlier revision has, that only the present one has, and that have changed;
        // --gone, --made and --moved
        changes: { gone: 0xff5d5d, made: 0x4fd37a, moved: 0xffd166 },
        // of half-edges by their role, see around.js
        arrows: { self: 0xffb347, next: 0x6be675, prev: 0xe27bff, twin: 0x5fa8ff, near: 0xf4f6fa },
    },
    light: {
        paper: 0xeef1f5,
        ink: 0x232c39,
        boundary: 0x007f96,
        preview: 0x1b2230,
        field: 0x1b2230,
        grid: 0xcbd3de,
        box: 0x5c6878,
        axes: [0xc62828, 0x1b7f2a, 0x1556c0],
        chosen: 0xa05000,
        chosenStart: 0xe8a860,
        ruler: 0xb0127b,
        flash: 0x1b2230,
        changes: { gone: 0xd32f2f, made: 0x1b7f2a, moved: 0xa06a00 },
        arrows: { self: 0xd9780f, next: 0x1a8f2c, prev: 0xa12bc9, twin: 0x1666d6, near: 0x333d4d },
    },
};

// The cut of a section plane, on either ground.
export const CAP = [0.36, 0.62, 0.53];
export const CAP_LINE = 0x18b48c;
