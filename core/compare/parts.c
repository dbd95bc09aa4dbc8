#include "base/parallel.h"
#include "compare/comparing.h"

#include <string.h>

/* A part that takes more steps than this is done again by the caller's thread, which can be
 * cancelled meanwhile. Ordinary parts take a few millions. */
static const uint64_t MOST_STEPS = UINT64_C(1) << 26;

/* A triangle counts as so many rows of a parallel loop, because it takes much longer. */
enum { ROWS = HE_PART_ROWS / HE_COMPARE_PART };

typedef struct part {
    he_comparing c;
    uint64_t steps; /* steps that the part might take when it began */
    bool done;
} part;

typedef struct parts {
    const he_comparing *whole;
    he_compare_part work;
    part *parts;
} parts;

/* Begins a part, with the sums and samples of no triangle. */
static void begin(part *p, const he_comparing *whole, he_budget budget)
{
    p->c = *whole;
    p->c.budget = budget;
    p->steps = budget.left;
    p->c.samples = NULL;
    p->c.sample_count = p->c.sample_capacity = 0;
    p->c.weight = p->c.sum = p->c.squares = 0;
}

static he_status run_part(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    const parts *all = context;
    part *p = &all->parts[which];
    he_error why = {.status = HE_OK};
    const uint64_t left = all->whole->budget.left;
    begin(p, all->whole, (he_budget){.left = left < MOST_STEPS ? left : MOST_STEPS});
    he_status status = all->work(&p->c, (uint32_t)(from / ROWS), (uint32_t)(to / ROWS), &why);
    p->done = status == HE_OK;
    if (!p->done) {
        he_mem_free(p->c.samples);
        p->c.samples = NULL;
    }
    if (status != HE_OK && status != HE_LIMIT && err != NULL) {
        *err = why;
    }
    return status == HE_LIMIT ? HE_OK : status;
}

/* Adds what a part has found. */
static he_status join(he_comparing *c, const he_comparing *of, he_error *err)
{
    if (of->triangle != HE_NONE && (of->lower > c->lower || c->triangle == HE_NONE)) {
        c->lower = of->lower;
        c->target = of->target;
        c->at = of->at;
        c->triangle = of->triangle;
        c->found = of->found;
    }
    c->weight += of->weight;
    c->sum += of->sum;
    c->squares += of->squares;
    const size_t count = c->sample_count + of->sample_count;
    if (count > c->sample_capacity) {
        const size_t capacity = he_mem_grown(c->sample_capacity, count);
        he_sample *samples = he_mem_array(c->samples, capacity, sizeof *samples);
        if (samples == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the distances at samples");
        }
        c->samples = samples;
        c->sample_capacity = capacity;
    }
    if (of->sample_count > 0) {
        memcpy(c->samples + c->sample_count, of->samples, of->sample_count * sizeof *of->samples);
    }
    c->sample_count = count;
    return HE_OK;
}

/* Does a part that no thread has done, and pays for it; or pays for what was done. */
static he_status finish(const parts *all, he_comparing *c, uint32_t which, he_error *err)
{
    part *p = &all->parts[which];
    const uint32_t from = which * HE_COMPARE_PART, count = c->from.tree->count;
    const uint32_t to = count - from < HE_COMPARE_PART ? count : from + HE_COMPARE_PART;
    if (p->done) {
        return he_budget_take(&c->budget, p->steps - p->c.budget.left, err);
    }
    begin(p, all->whole, c->budget);
    he_status status = all->work(&p->c, from, to, err);
    c->budget = p->c.budget;
    return status;
}

he_status he_compare_in_parts(he_comparing *c, he_compare_part work, he_error *err)
{
    const uint32_t triangles = c->from.tree->count;
    const size_t rows = (size_t)triangles * ROWS, count = he_ranges(rows);
    const he_comparing whole = *c; /* what all parts begin with */
    parts all = {&whole, work, he_mem_zero(count, sizeof *all.parts)};
    if (all.parts == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %u triangles", triangles);
    }
    he_status status = HE_OK;
    /* Without more threads, each part is done below, with reports of its progress. */
    if (he_lanes(c->budget.progress, rows) > 1) {
        status = he_run_ranges(c->budget.progress, rows, run_part, &all, err);
    }
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        status = finish(&all, c, i, err);
        if (status == HE_OK) {
            status = join(c, &all.parts[i].c, err);
        }
        he_mem_free(all.parts[i].c.samples);
        all.parts[i].c.samples = NULL;
    }
    for (size_t i = 0; i < count; i++) {
        he_mem_free(all.parts[i].c.samples);
    }
    he_mem_free(all.parts);
    return status;
}
