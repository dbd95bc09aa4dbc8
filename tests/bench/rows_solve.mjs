// rows_solve.mjs - the rows of `make bench BENCH=reshape` about linear systems (core/solve).
// rows.mjs says what the members of a row are.
//
// Both programs read the same matrices: M + t L and its biharmonic counterpart, with the lumped
// masses M and the cotangent weights L of a torus of 250,000 vertices. Eigen's solver is
// SimplicialLDLT with its default order, AMD.

const seconds = (title, ours, times, more) => ({
    title,
    ours,
    unit: 's',
    per: 1,
    whole: true,
    less: true,
    target: [['eigen', times]],
    ...more,
});

export const solve = ['natural', 'shuffled'].map((order) => ({
    part: 'reshape',
    input: 'torus',
    order,
    side: 500,
    before: ['make_matrices'],
    sides: ['eigen'],
    rows: [
        seconds('factor, 250,000 vertices, cotangents', 'factor', 1.5, { slow: ['eigen'] }),
        seconds('solve it for three right sides', 'solve', 1, { near: 1e-9 }),
        ...(order === 'natural'
            ? [seconds('factor, 250,000 vertices, biharmonic', 'factor_biharmonic', 1.5, { runs: 1 })]
            : []),
    ],
}));
