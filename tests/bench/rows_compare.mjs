// rows_compare.mjs - the rows of `make bench BENCH=reshape` about distances. rows.mjs says what the
// members of a row are.
//
// The torus, 8 wide, is compared with a copy in which every vertex has moved a little, in both
// directions. The bound is a ten-thousandth, so the distances agree to a twentieth. Trees of boxes
// are made within the time on both sides. The second row measures what CGAL does not compute, too.

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
                why: 'half of the time is that of making both trees of boxes',
                runs: 3,
                slow: ['cgal'],
            },
            {
                title: 'with means, histogram; CGAL has neither',
                ours: 'compare_with_means',
                theirs: 'compare',
                unit: 'Mface/s',
                per: 1e6,
                near: 0.05,
                target: [['cgal', 5]],
                why:
                    'nearly two thirds of the time are the nearest points of samples, three for two ' +
                    'faces, of which the means and the histogram are made: about 0.9 us each, ' +
                    'where 0.2 us would do. CGAL computes the distance alone',
                runs: 3,
                slow: ['cgal'],
            },
        ],
    },
];
