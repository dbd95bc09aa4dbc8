// rows_remesh.mjs - the rows of `make bench BENCH=reshape` about remeshing. rows.mjs says what the
// members of a row are.
//
// The input is the torus, whose triangles are up to four times as long as wide, and the wanted
// length is that of regular triangles of which as many cover it.

const shape = (title, of, unit, more) => ({
    title,
    of,
    unit,
    per: 1,
    whole: true,
    target: [['cgal', 1]],
    ...more,
});

// The distances are in the unit of the coordinates, in which the torus is 8 wide.
const distance = (title, of) => shape(title, of, 'millionths', { per: 1e-6, less: true });

export const remesh = ['natural', 'shuffled'].map((order) => ({
    part: 'reshape',
    input: 'torus',
    order,
    sides: ['cgal'],
    rows: [
        {
            title: 'remesh, CGAL with 3 iterations',
            ours: 'remesh',
            unit: 's',
            per: 1,
            whole: true,
            less: true,
            target: [['cgal', 3]],
            runs: 3,
            slow: ['cgal'],
            errors: [
                {
                    by: 'remesh_shape',
                    rows: [
                        shape('smallest angle', 'near', 'degrees'),
                        shape('mean of the smallest angles of faces', 'value', 'degrees'),
                        shape('faces with an angle below 30 degrees', 'amount', '%', { less: true }),
                    ],
                },
                {
                    by: 'remesh_error',
                    rows: [
                        distance('distance, root mean square', 'value'),
                        distance('distance, Hausdorff', 'near'),
                    ],
                },
            ],
        },
        {
            title: 'remesh a million faces, with its report',
            ours: 'remesh_reported',
            unit: 's',
            per: 1,
            whole: true,
            less: true,
            sides: [],
            limit: 6,
            runs: 1,
            why:
                'an eighth is the system clearing fresh pages; where ids are shuffled, the nearest ' +
                'points of the given faces are waited for; the report is a tenth',
        },
    ],
}));
