#include "base/parallel.h"

static const he_parallel *host_of(const he_progress *progress)
{
    return progress != NULL && progress->parallel != NULL && progress->parallel->threads > 1
               ? progress->parallel
               : NULL;
}

/* Runs the parts of a job on the threads of `host` (parallel.h). If there is no host, all parts run
 * on the calling thread. If `progress` is not NULL, progress is reported after each part. */
static he_status run(const he_parallel *host, he_progress *progress, uint32_t parts, he_part part,
                     void *context, he_error *err)
{
    if (host != NULL && parts > 1) {
        return host->run(host->self, parts, part, context, progress, err);
    }
    he_status status = HE_OK;
    for (uint32_t i = 0; i < parts && status == HE_OK; i++) {
        status = he_progress_step(progress, i, parts, err);
        if (status == HE_OK) {
            status = part(context, i, err);
        }
    }
    return status;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

typedef struct ranges {
    he_range work;
    void *context;
    size_t count;
} ranges;

static he_status run_range(void *context, uint32_t part, he_error *err)
{
    const ranges *r = context;
    size_t from = (size_t)part * HE_PART_ROWS;
    return r->work(r->context, part, from, smaller(from + HE_PART_ROWS, r->count), err);
}

size_t he_ranges(size_t count)
{
    return count / HE_PART_ROWS + (count % HE_PART_ROWS != 0);
}

he_status he_run_ranges(he_progress *progress, size_t count, he_range work, void *context,
                        he_error *err)
{
    ranges r = {work, context, count};
    return run(host_of(progress), progress, (uint32_t)he_ranges(count), run_range, &r, err);
}

typedef struct lanes {
    he_range work;
    void *context;
    /* `count`: number of indices that the whole loop runs over; `length`: number of indices in each
     * lane; `done`: number of indices that each lane has handled so far */
    size_t count, length, done;
} lanes;

static he_status run_lane(void *context, uint32_t lane, he_error *err)
{
    const lanes *l = context;
    size_t begin = lane * l->length;
    size_t from = smaller(begin + l->done, l->count);
    size_t to = smaller(from + HE_PART_ROWS, smaller(begin + l->length, l->count));
    return from < to ? l->work(l->context, lane, from, to, err) : HE_OK;
}

uint32_t he_lanes(const he_progress *progress, size_t count)
{
    const he_parallel *host = host_of(progress);
    size_t most = smaller(he_ranges(count), host == NULL ? 1 : host->threads);
    return most < 1 ? 1 : (uint32_t)smaller(most, HE_MOST_LANES);
}

he_status he_run_lanes(he_progress *progress, uint32_t count_of_lanes, size_t count, he_range work,
                       void *context, he_error *err)
{
    lanes l = {work, context, count, (count + count_of_lanes - 1) / count_of_lanes, 0};
    he_status status = HE_OK;
    for (; l.done < l.length && status == HE_OK; l.done += HE_PART_ROWS) {
        status = he_progress_step(progress, l.done, l.length, err);
        if (status == HE_OK) {
            status = run(host_of(progress), NULL, count_of_lanes, run_lane, &l, err);
        }
    }
    return status;
}
