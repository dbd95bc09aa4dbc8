#include "solve/dense.h"

#include <math.h>
#include <string.h>

/* A product is computed in tiles of TILE by TILE numbers, which stay in registers. The numbers of a
 * vector are added separately, so the result does not depend on the machine. */
enum { TILE = 4, BLOCK = 48 };

typedef double pair __attribute__((vector_size(2 * sizeof(double))));

/* Subtracts two numbers from two numbers in memory. */
static inline void subtract_pair(double *to, pair q)
{
    pair before;
    memcpy(&before, to, sizeof before);
    before -= q;
    memcpy(to, &before, sizeof before);
}

/* Subtracts the product of the rows i to i + 3 of A and the rows j to j + 3 of B. */
static void tile(he_panel a, he_panel b, he_panel c, size_t i, size_t j)
{
    pair sums[TILE][2] = {{{0}}};
    const double *left = a.at + i, *right = b.at + j;
    for (size_t k = 0; k < a.columns; k++) {
        pair low, high;
        memcpy(&low, left, sizeof low);
        memcpy(&high, left + 2, sizeof high);
        for (size_t m = 0; m < TILE; m++) {
            sums[m][0] += low * right[m];
            sums[m][1] += high * right[m];
        }
        left += a.step;
        right += b.step;
    }
    double *into = c.at + i + j * c.step;
    for (size_t m = 0; m < TILE; m++) {
        subtract_pair(into + m * c.step, sums[m][0]);
        subtract_pair(into + m * c.step + 2, sums[m][1]);
    }
}

/* Subtracts the product of some rows of A, from row `i` on, and some of B, from row `j` on. */
static void edge(he_panel a, he_panel b, he_panel c, size_t i, size_t j)
{
    for (; j < c.columns; j++) {
        for (size_t r = i; r < c.rows; r++) {
            double sum = 0;
            for (size_t k = 0; k < a.columns; k++) {
                sum += a.at[r + k * a.step] * b.at[j + k * b.step];
            }
            c.at[r + j * c.step] -= sum;
        }
    }
}

void he_dense_subtract(he_panel a, he_panel b, he_panel c)
{
    const size_t rows = c.rows - c.rows % TILE, columns = c.columns - c.columns % TILE;
    for (size_t i = 0; i < rows; i += TILE) {
        for (size_t j = 0; j < columns; j += TILE) {
            tile(a, b, c, i, j);
        }
    }
    if (rows < c.rows) {
        he_panel left = c;
        left.columns = columns;
        edge(a, b, left, rows, 0);
    }
    if (columns < c.columns) {
        edge(a, b, c, 0, columns);
    }
}

/* Factors the columns `from` to `to` - 1, from which earlier columns were subtracted already. */
static size_t factor_block(he_panel a, size_t from, size_t to)
{
    for (size_t j = from; j < to; j++) {
        double *column = a.at + j * a.step;
        for (size_t k = from; k < j; k++) {
            const double *before = a.at + k * a.step, factor = before[j];
            for (size_t i = j; i < a.rows; i++) {
                column[i] -= before[i] * factor;
            }
        }
        if (!(column[j] > 0) || isinf(column[j])) {
            return j;
        }
        const double pivot = sqrt(column[j]);
        for (size_t i = j; i < a.rows; i++) {
            column[i] /= pivot;
        }
        column[j] = pivot;
    }
    return to;
}

size_t he_dense_factor(he_panel a)
{
    for (size_t from = 0, to; from < a.columns; from = to) {
        to = a.columns - from < BLOCK ? a.columns : from + BLOCK;
        const size_t done = factor_block(a, from, to);
        if (done < to) {
            return done;
        }
        const size_t depth = to - from;
        /* Later columns, in strips: of each strip only the rows from its diagonal on are used. */
        for (size_t j = to; j < a.columns; j += BLOCK) {
            const size_t width = a.columns - j < BLOCK ? a.columns - j : BLOCK;
            const he_panel left = {a.at + j + from * a.step, a.rows - j, depth, a.step};
            he_panel right = left, into = {a.at + j + j * a.step, a.rows - j, width, a.step};
            right.rows = width;
            he_dense_subtract(left, right, into);
        }
    }
    return a.columns;
}
