// affine.js - the matrix of an affine map, made from scaling, rotation and translation. Pure.
//
// A matrix is an array of 16 numbers, row by row. It is multiplied by a column vector on its right.

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const translation = ([x, y, z]) => [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1];
const scaling = ([x, y, z]) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1];

// Returns the product of two matrices: the map of the right one is applied first.
function multiply(a, b) {
    return IDENTITY.map((_, at) => {
        const [row, column] = [4 * Math.floor(at / 4), at % 4];
        return [0, 1, 2, 3].reduce((sum, i) => sum + a[row + i] * b[4 * i + column], 0);
    });
}

// Returns [cosine, sine] of an angle in degrees, without rounding errors for multiples of 90.
function turnOf(degrees) {
    const quarters = (((degrees / 90) % 4) + 4) % 4;
    const exact = [[1, 0], [0, 1], [-1, 0], [0, -1]][quarters];
    const angle = (degrees * Math.PI) / 180;
    return exact ?? [Math.cos(angle), Math.sin(angle)];
}

// Returns the rotation around one axis, 0 to 2, counter-clockwise seen from the tip of the axis.
function rotation(axis, degrees) {
    const [cosine, sine] = turnOf(degrees);
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const matrix = [...IDENTITY];
    matrix[5 * u] = cosine;
    matrix[5 * v] = cosine;
    matrix[4 * u + v] = -sine;
    matrix[4 * v + u] = sine;
    return matrix;
}

// Returns the map that first scales, then rotates (around the x, y and z axes one after another,
// angles in degrees), and then translates; `about` is the fixed point of scaling and rotation.
export function compose({ scale, rotate, translate, about }) {
    const there = about.map((value) => -value);
    return [
        translation(there),
        scaling(scale),
        ...rotate.map((degrees, axis) => rotation(axis, degrees)),
        translation(about),
        translation(translate),
    ].reduce((done, next) => multiply(next, done), IDENTITY);
}

// Returns the matrix as text: four lines of four numbers.
export function textOf(matrix) {
    return [0, 4, 8, 12].map((row) => matrix.slice(row, row + 4).join(' ')).join('\n');
}
