// rows_deform.mjs - the rows of `make bench BENCH=reshape` about deformation. rows.mjs says what the
// members of a row are.
//
// The input is the torus with 50,000 vertices: those on one side are turned and lifted, those on
// the other are fixed. Both programs do ten steps of the method of Sorkine and Alexa. The energy is
// measured by one program for both, with the cotangent weights of the input.

const seconds = (title, ours, more) => ({
    title,
    ours,
    unit: 'ms',
    per: 1e-3,
    whole: true,
    less: true,
    ...more,
});

const energy = (title) => ({
    by: 'deform_energy',
    rows: [{
        title, of: 'value', unit: '', per: 1, whole: true, less: true, target: [['cgal', 0.999]],
    }],
});

export const deform = ['natural', 'shuffled'].map((order) => ({
    part: 'reshape',
    input: 'torus',
    order,
    side: 224,
    sides: ['cgal'],
    rows: [
        seconds('deform 50,000 vertices in ten steps', 'deform', {
            target: [['cgal', 2]],
            errors: [energy('energy after ten steps')],
        }),
        seconds('drag once more, one step', 'deform_drag', {
            target: [['cgal', 1]],
            limit: 50,
            errors: [energy('energy after a drag')],
        }),
        seconds('drag once more, biharmonic', 'deform_biharmonic', { sides: [], limit: 50 }),
    ],
}));
