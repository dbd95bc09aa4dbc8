#include "solve/factor_pattern.h"

#include "solve/factor_order.h"

#include <string.h>

/* --- memory --- */

void he_pattern_clear(he_pattern *pattern)
{
    he_mem_free(pattern->order);
    he_mem_free(pattern->number);
    he_mem_free(pattern->begins);
    he_mem_free(pattern->supernode_of);
    he_mem_free(pattern->starts);
    he_mem_free(pattern->below);
    he_mem_free(pattern->values);
    *pattern = (he_pattern){0};
}

/* Lists over the columns that are needed only until the pattern is known. */
typedef struct scratch {
    uint32_t *parent; /* in the elimination tree: the first row below the diagonal in a column of
                         the factor; UINT32_MAX for a root */
    uint32_t *counts; /* entries of the column of the factor, with its diagonal */
    uint32_t *a, *b, *c;
    size_t *zeros; /* of a supernode: values of its dense matrix that no merge would have stored */
} scratch;

static void clear_scratch(scratch *s)
{
    he_mem_free(s->parent);
    he_mem_free(s->counts);
    he_mem_free(s->a);
    he_mem_free(s->b);
    he_mem_free(s->c);
    he_mem_free(s->zeros);
}

static he_status allocate(uint32_t n, he_pattern *pattern, scratch *s, he_error *err)
{
    const size_t room = (size_t)n + 1;
    *pattern = (he_pattern){.n = n,
                            .order = he_mem_array(NULL, room, sizeof(uint32_t)),
                            .number = he_mem_array(NULL, room, sizeof(uint32_t)),
                            .begins = he_mem_zero(room, sizeof(uint32_t)),
                            .supernode_of = he_mem_array(NULL, room, sizeof(uint32_t)),
                            .starts = he_mem_zero(room, sizeof(size_t)),
                            .values = he_mem_zero(room, sizeof(size_t))};
    *s = (scratch){.parent = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .counts = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .a = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .b = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .c = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .zeros = he_mem_array(NULL, room, sizeof(size_t))};
    if (pattern->order == NULL || pattern->number == NULL || pattern->begins == NULL ||
        pattern->supernode_of == NULL || pattern->starts == NULL || pattern->values == NULL ||
        s->parent == NULL || s->counts == NULL || s->a == NULL || s->b == NULL || s->c == NULL ||
        s->zeros == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix of %u rows", n);
    }
    return HE_OK;
}

static void invert(he_pattern *pattern)
{
    for (uint32_t i = 0; i < pattern->n; i++) {
        pattern->number[pattern->order[i]] = i;
    }
}

/* --- the elimination tree (Liu 1990) --- */

static void find_parents(const he_sparse *a, const he_pattern *pattern, uint32_t *parent,
                         uint32_t *ancestor)
{
    for (uint32_t k = 0; k < a->n; k++) {
        const uint32_t old = pattern->order[k];
        parent[k] = ancestor[k] = UINT32_MAX;
        for (size_t i = a->starts[old]; i < a->starts[old + 1]; i++) {
            uint32_t at = pattern->number[a->rows[i]];
            while (at < k) {
                const uint32_t next = ancestor[at];
                ancestor[at] = k;
                if (next == UINT32_MAX) {
                    parent[at] = k;
                    break;
                }
                at = next;
            }
        }
    }
}

/* Renumbers the columns so that each comes directly after the subtrees of its children. Uses a and
 * b for the first child and the next sibling, c for the new order. */
static void order_by_tree(he_pattern *pattern, scratch *s)
{
    const uint32_t n = pattern->n, none = UINT32_MAX;
    uint32_t *first = s->a, *next = s->b, *order = s->c, count = 0;
    for (uint32_t i = 0; i < n; i++) {
        first[i] = none;
    }
    for (uint32_t i = n; i-- > 0;) {
        if (s->parent[i] != none) {
            next[i] = first[s->parent[i]];
            first[s->parent[i]] = i;
        }
    }
    for (uint32_t root = 0; root < n; root++) {
        if (s->parent[root] != none) {
            continue;
        }
        /* Walks down to the first leaf, and from each column to the first leaf of its next
         * sibling, or up. */
        for (uint32_t at = root;;) {
            while (first[at] != none) {
                at = first[at];
            }
            order[count++] = at;
            while (at != root && next[at] == none) {
                at = s->parent[at];
                order[count++] = at;
            }
            if (at == root) {
                break;
            }
            at = next[at];
        }
    }
    /* order[] lists columns of the present numbering; number[] is free to hold the new numbers. */
    for (uint32_t i = 0; i < n; i++) {
        pattern->number[order[i]] = i;
        s->b[i] = pattern->order[order[i]];
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t parent = s->parent[i];
        s->a[pattern->number[i]] = parent == none ? none : pattern->number[parent];
    }
    memcpy(pattern->order, s->b, n * sizeof *s->b);
    memcpy(s->parent, s->a, n * sizeof *s->a);
    invert(pattern);
}

/* Counts the entries of each column of the factor: row k has an entry in all columns of the tree on
 * the ways from the columns of the matrix's row k up to k. */
static he_status count_entries(const he_sparse *a, const he_pattern *pattern, scratch *s,
                               he_progress *progress, he_error *err)
{
    uint32_t *mark = s->a;
    he_status status = HE_OK;
    for (uint32_t k = 0; k < a->n && status == HE_OK; k++) {
        const uint32_t old = pattern->order[k];
        status = he_progress_at(progress, k, a->n, err);
        s->counts[k] = 1;
        mark[k] = k;
        for (size_t i = a->starts[old]; i < a->starts[old + 1]; i++) {
            uint32_t at = pattern->number[a->rows[i]];
            while (at < k && mark[at] != k) {
                mark[at] = k;
                s->counts[at]++;
                at = s->parent[at];
            }
        }
    }
    return status;
}

/* --- supernodes --- */

/* A merge of supernodes stores zeros, but makes the dense matrices larger, which is quicker. These
 * limits of the share of zeros are those of CHOLMOD (Chen, Davis, Hager and Rajamanickam 2008). */
static int may_merge(uint32_t columns, double zeros, double all)
{
    return columns <= 4 || (columns <= 16 && zeros < 0.8 * all) ||
           (columns <= 48 && zeros < 0.1 * all) || zeros < 0.05 * all;
}

static size_t values_of(size_t columns, size_t below)
{
    return columns * (columns + 1) / 2 + columns * below;
}

/* Cuts the columns into supernodes: first runs of columns with the same rows, then merges of a
 * supernode into its parent if that comes directly after it. The list begins[] is a stack. */
static void find_supernodes(he_pattern *pattern, scratch *s)
{
    uint32_t *begins = pattern->begins, top = 0;
    const uint32_t n = pattern->n;
    for (uint32_t end, begin = 0; begin < n; begin = end) {
        for (end = begin + 1;
             end < n && s->parent[end - 1] == end && s->counts[end - 1] == s->counts[end] + 1;
             end++) {
        }
        const size_t below = s->counts[end - 1] - 1;
        uint32_t from = begin;
        size_t zeros = 0;
        while (top > 0) {
            /* the supernode on the stack has the columns before `from` */
            const uint32_t last = from - 1, first = begins[top - 1];
            if (s->parent[last] == UINT32_MAX || s->parent[last] >= end) {
                break;
            }
            const size_t columns = from - first, apart = s->counts[last] - 1;
            const size_t more = zeros + s->zeros[top - 1] + columns * (end - from + below - apart);
            const size_t all = values_of(end - first, below);
            if (!may_merge(end - first, (double)more, (double)all)) {
                break;
            }
            zeros = more;
            from = first;
            top--;
        }
        begins[top] = from;
        s->zeros[top] = zeros;
        top++;
    }
    begins[top] = n;
    pattern->supernodes = top;
    for (uint32_t k = 0; k < top; k++) {
        for (uint32_t j = begins[k]; j < begins[k + 1]; j++) {
            pattern->supernode_of[j] = k;
        }
    }
}

static he_status allocate_rows(he_pattern *pattern, const scratch *s, he_error *err)
{
    size_t rows = 0, values = 0;
    for (uint32_t k = 0; k < pattern->supernodes; k++) {
        const size_t columns = he_pattern_columns(pattern, k);
        const size_t below = s->counts[pattern->begins[k + 1] - 1] - 1;
        pattern->starts[k] = rows;
        pattern->values[k] = values;
        rows += below;
        values += columns * (columns + below);
        if (values > SIZE_MAX / 2 / sizeof(double)) {
            return he_fail_plain(err, HE_LIMIT, "the factor of the matrix is too large");
        }
    }
    pattern->starts[pattern->supernodes] = rows;
    pattern->values[pattern->supernodes] = values;
    pattern->below = he_mem_array(NULL, rows + 1, sizeof *pattern->below);
    return pattern->below != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix of %u rows",
                               pattern->n);
}

/* Lists the rows below each supernode. They are found in ascending order, as in count_entries, but
 * in the tree of supernodes. */
static he_status find_rows(const he_sparse *a, he_pattern *pattern, scratch *s,
                           he_progress *progress, he_error *err)
{
    uint32_t *mark = s->a, *used = s->b;
    he_status status = HE_OK;
    memset(used, 0, pattern->supernodes * sizeof *used);
    for (uint32_t k = 0; k < pattern->supernodes; k++) {
        mark[k] = UINT32_MAX;
    }
    for (uint32_t k = 0; k < a->n && status == HE_OK; k++) {
        const uint32_t old = pattern->order[k], own = pattern->supernode_of[k];
        status = he_progress_at(progress, k, a->n, err);
        for (size_t i = a->starts[old]; i < a->starts[old + 1]; i++) {
            const uint32_t column = pattern->number[a->rows[i]];
            if (column >= k) {
                continue;
            }
            uint32_t at = pattern->supernode_of[column];
            while (at != own && mark[at] != k) {
                mark[at] = k;
                pattern->below[pattern->starts[at] + used[at]++] = k;
                at = pattern->supernode_of[s->parent[pattern->begins[at + 1] - 1]];
            }
        }
    }
    return status;
}

he_status he_pattern_make(const he_sparse *a, he_progress *progress, he_pattern *out, he_error *err)
{
    he_pattern pattern;
    scratch s;
    he_status status = allocate(a->n, &pattern, &s, err);
    if (status == HE_OK) {
        status = he_order_rows(a, pattern.order, err);
    }
    if (status == HE_OK) {
        invert(&pattern);
        find_parents(a, &pattern, s.parent, s.a);
        order_by_tree(&pattern, &s);
        status = count_entries(a, &pattern, &s, progress, err);
    }
    if (status == HE_OK) {
        find_supernodes(&pattern, &s);
        status = allocate_rows(&pattern, &s, err);
    }
    if (status == HE_OK) {
        status = find_rows(a, &pattern, &s, progress, err);
    }
    clear_scratch(&s);
    if (status != HE_OK) {
        he_pattern_clear(&pattern);
    }
    *out = pattern;
    return status;
}
