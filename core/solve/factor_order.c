/* factor_order.c - an order of the rows of a matrix in which its factor has few entries. */
#include "solve/factor_order.h"

#include <suitesparse/amd.h>

#include <string.h>

/* The arrays of AMD, each with n entries, and the pattern of the matrix, which AMD overwrites. */
enum { ARRAYS = 9 };

typedef struct work {
    int *arrays;  /* ARRAYS * n */
    int *pattern; /* `size` entries */
    int size, used;
} work;

static he_status allocate(const he_sparse *a, work *w, he_error *err)
{
    const size_t entries = a->starts[a->n];
    /* AMD asks for some room beyond the pattern: at least n, better a fifth of the pattern more. */
    const size_t size = entries + entries / 5 + a->n + 1;
    if (size > INT32_MAX) {
        return he_fail_plain(err, HE_LIMIT, "a matrix of %zu entries is too large to be ordered",
                             entries);
    }
    *w = (work){.arrays = he_mem_array(NULL, (size_t)a->n * ARRAYS + 1, sizeof *w->arrays),
                .pattern = he_mem_array(NULL, size, sizeof *w->pattern),
                .size = (int)size};
    return w->arrays != NULL && w->pattern != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to order a matrix of %u rows", a->n);
}

/* Copies the pattern of the matrix without its diagonal. */
static void copy_pattern(const he_sparse *a, work *w, int *begins, int *lengths)
{
    for (uint32_t j = 0; j < a->n; j++) {
        begins[j] = w->used;
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            if (a->rows[i] != j) {
                w->pattern[w->used++] = (int)a->rows[i];
            }
        }
        lengths[j] = w->used - begins[j];
    }
}

he_status he_order_rows(const he_sparse *a, uint32_t *order, he_error *err)
{
    work w = {0};
    he_status status = allocate(a, &w, err);
    if (status == HE_OK && a->n > 0) {
        const size_t n = a->n;
        int *at[ARRAYS];
        for (size_t i = 0; i < ARRAYS; i++) {
            at[i] = w.arrays + i * n;
        }
        copy_pattern(a, &w, at[0], at[1]);
        /* the lists of AMD: Pe, Len, Nv, Next, Last, Head, Elen, Degree, W */
        amd_2((int)n, at[0], w.pattern, at[1], w.size, w.used, at[2], at[3], at[4], at[5], at[6],
              at[7], at[8], NULL, NULL);
        for (size_t i = 0; i < n; i++) {
            order[i] = (uint32_t)at[4][i];
        }
    }
    he_mem_free(w.arrays);
    he_mem_free(w.pattern);
    return status;
}
