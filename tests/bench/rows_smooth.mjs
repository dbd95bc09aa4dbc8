// rows_smooth.mjs - the rows of `make bench BENCH=reshape` about smoothing. rows.mjs says what the
// members of a row are.
//
// Both programs do one implicit step of the same flow for the same time. The areas of the results
// are measured by one program for both: they differ by what the weights and masses differ.

export const smooth = ['natural', 'shuffled'].map((order) => ({
    part: 'reshape',
    input: 'torus',
    order,
    side: 360,
    sides: ['cgal'],
    rows: [{
        title: 'smooth by an implicit step',
        ours: 'smooth',
        unit: 'ms',
        per: 1e-3,
        whole: true,
        less: true,
        target: [['cgal', 2]],
        errors: [{
            by: 'smooth_area',
            rows: [{
                title: 'area left by the step', of: 'value', unit: '%', per: 1e-2, whole: true,
            }],
        }],
    }],
}));
