// rows_compare.mjs - the row of `make bench BENCH=reshape` about distances. rows.mjs says what the
// members of a row are.
//
// The torus, 8 wide, is compared with a copy in which every vertex has moved a little, in both
// directions. The bound is a ten-thousandth, so the distances agree to a twentieth.

export const compare = [
    {
        part: 'reshape',
        input: 'torus',
        order: 'natural',
        side: 200,
        sides: ['cgal'],
        rows: [
            {
                title: 'Hausdorff distance, bound 1e-4',
                ours: 'compare',
                unit: 'Mface/s',
                per: 1e6,
                near: 0.05,
                target: [['cgal', 5]],
                why:
                    'two thirds of the time are the nearest points of samples, three a face, of ' +
                    'which the means and histograms are made, too; CGAL computes neither. ' +
                    'Processor time is told: two threads take half as long (scaling)',
                runs: 3,
                slow: ['cgal'],
            },
        ],
    },
];
