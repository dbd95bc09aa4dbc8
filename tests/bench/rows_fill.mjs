// rows_fill.mjs - the rows of `make bench BENCH=reshape` about holes. rows.mjs says what the members
// of a row are.
//
// The input is a torus from which a cap was cut. Both programs cover the hole with triangles as
// large as those around it, and continue the tangent planes of the mesh. The distances of the new
// vertices from the torus before the cut are measured by one program for both.
//
// The first row is the first edit of the mesh that makes elements, so ours grows its arrays of
// elements, which had no room: ids are not used again. CGAL puts the new faces into the places of
// the deleted ones. Before the second row the cap at the other side was cut and filled, so there is
// room.

export const fill = ['natural', 'shuffled'].map((order) => ({
    part: 'reshape',
    input: 'torus',
    order,
    side: 360,
    sides: ['cgal'],
    rows: [{
        title: 'fill a hole, refine and fair it',
        ours: 'fill',
        unit: 'ms',
        per: 1e-3,
        whole: true,
        less: true,
        target: [['cgal', 3]],
        why:
            'a third is the growth of the arrays of the mesh, which the second hole is spared: pages ' +
            'are moved and cleared',
        errors: [{
            by: 'fill_error',
            rows: [{
                title: 'distance from the surface before, root mean square',
                of: 'value',
                unit: 'thousandths',
                per: 1e-3,
                whole: true,
                less: true,
                target: [['cgal', 1]],
            }, {
                title: 'new vertices', of: 'amount', unit: '', per: 1, whole: true,
            }],
        }],
    }, {
        title: 'fill a second hole',
        ours: 'fill_again',
        unit: 'ms',
        per: 1e-3,
        whole: true,
        less: true,
        target: [['cgal', 3]],
    }],
}));
