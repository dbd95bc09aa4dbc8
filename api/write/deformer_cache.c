#include "api/write/deformer_cache.h"

#include <stdatomic.h>
#include <string.h>

struct api_deformer {
    /* Number of users: 1 while the entry is kept with the mesh, and 1 for each request that uses
     * it. */
    _Atomic uint32_t uses;
    uint64_t revision;
    he_deform_sets sets; /* their lists are in `lists` */
    uint32_t *lists;
    he_deformer *deformer;
};

void api_deformer_release(api_deformer *entry)
{
    if (entry != NULL && atomic_fetch_sub_explicit(&entry->uses, 1, memory_order_acq_rel) == 1) {
        he_deformer_free(entry->deformer);
        he_mem_free(entry->lists);
        he_mem_free(entry);
    }
}

const he_deformer *api_deformer_get(const api_deformer *entry)
{
    return entry->deformer;
}

static void destroy(void *value)
{
    api_deformer_release(value);
}

static void hold(api_deformer *entry)
{
    atomic_fetch_add_explicit(&entry->uses, 1, memory_order_relaxed);
}

static bool are_equal(const uint32_t *a, size_t a_count, const uint32_t *b, size_t b_count)
{
    return a_count == b_count && (a_count == 0 || memcmp(a, b, a_count * sizeof *a) == 0);
}

static bool fits(const api_deformer *entry, uint64_t revision, const he_deform_sets *sets)
{
    const he_deform_sets *own = &entry->sets;
    return entry->revision == revision && own->method == sets->method &&
           are_equal(own->handles, own->handle_count, sets->handles, sets->handle_count) &&
           are_equal(own->fixed, own->fixed_count, sets->fixed, sets->fixed_count);
}

/* Returns the kept entry if it fits, or NULL. */
static api_deformer *find(api_exchange *x, const he_deform_sets *sets)
{
    const st_derived *place = st_derived_begin(x->mesh, ST_DERIVED_DEFORMER);
    api_deformer *kept = place->value;
    kept = kept != NULL && fits(kept, x->info.revision, sets) ? kept : NULL;
    if (kept != NULL) {
        hold(kept);
    }
    st_derived_end(x->mesh, ST_DERIVED_DEFORMER);
    return kept;
}

static void keep(const api_exchange *x, api_deformer *entry)
{
    hold(entry);
    st_derived *place = st_derived_begin(x->mesh, ST_DERIVED_DEFORMER);
    api_deformer *dropped = place->value;
    *place = (st_derived){entry, destroy};
    st_derived_end(x->mesh, ST_DERIVED_DEFORMER);
    api_deformer_release(dropped);
}

static he_status copy_sets(api_deformer *entry, const he_deform_sets *sets, he_error *err)
{
    const size_t handles = sets->handle_count, fixed = sets->fixed_count;
    entry->lists = he_mem_array(NULL, handles + fixed + 1, sizeof *entry->lists);
    if (entry->lists == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the lists of vertices");
    }
    memcpy(entry->lists, sets->handles, handles * sizeof *entry->lists);
    if (fixed > 0) {
        memcpy(entry->lists + handles, sets->fixed, fixed * sizeof *entry->lists);
    }
    entry->sets =
        (he_deform_sets){sets->method, entry->lists, handles, entry->lists + handles, fixed};
    return HE_OK;
}

he_status api_deformer_take(api_exchange *x, const he_deform_sets *sets, api_deformer **out,
                            he_error *err)
{
    api_deformer *entry = find(x, sets);
    if (entry != NULL) {
        *out = entry;
        return HE_OK;
    }
    entry = he_mem_zero(1, sizeof *entry);
    if (entry == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform a mesh");
    }
    atomic_init(&entry->uses, 1);
    entry->revision = x->info.revision;
    he_status status = copy_sets(entry, sets, err);
    if (status == HE_OK) {
        status = he_deformer_make(x->content, sets, &x->progress, &entry->deformer, err);
    }
    if (status != HE_OK) {
        api_deformer_release(entry);
        return status;
    }
    keep(x, entry);
    *out = entry;
    return HE_OK;
}
