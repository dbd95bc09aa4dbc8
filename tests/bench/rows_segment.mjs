// rows_segment.mjs - the rows of `make bench BENCH=reshape` about patches of faces. rows.mjs says
// what the members of a row are.

// The patches must be the same in both programs, face by face.
const byAngle = (order) => ({
    part: 'reshape',
    input: 'roofs',
    order,
    sides: ['cgal'],
    rows: [
        {
            title: 'patches by sharp edges',
            ours: 'segment_angle',
            unit: 'Mface/s',
            per: 1e6,
            near: 1e-9,
            target: [['cgal', 2]],
            why:
                'a quarter of the time, and most of the first of several runs, is the system ' +
                'clearing fresh pages for the normals of the faces',
        },
    ],
});

// The result is how far the patches are from flat (he_segmented): smaller is better.
const byPlanes = {
    part: 'reshape',
    input: 'torus',
    order: 'natural',
    side: 200,
    sides: ['cgal'],
    rows: [
        {
            title: 'patches by 64 planes',
            ours: 'segment_planes',
            unit: 'Mface/s',
            per: 1e6,
            near: 0.1,
            target: [['cgal', 2]],
            runs: 3,
        },
    ],
};

export const segment = [byAngle('natural'), byAngle('shuffled'), byPlanes];
