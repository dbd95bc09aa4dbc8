#include "api/ask/bvh_cache.h"

#include <stdatomic.h>

/* The entry for the tree of boxes of a mesh, in which requests find the faces near a ray or a
 * point. The tree is being made, is ready, or could not be made. While the tree is being made,
 * `bvh` is NULL and `abandoned` is false; afterwards one of these members is set, under the lock of
 * st_derived_begin. */
typedef struct api_bvh {
    /* Number of users: 1 while the entry is kept with the mesh, and 1 for each request that uses
     * the tree. */
    _Atomic uint32_t uses;
    uint64_t revision;
    he_bvh *bvh;
    bool abandoned; /* true if the tree could not be made */
} api_bvh;

void api_bvh_release(api_bvh *tree)
{
    if (tree != NULL && atomic_fetch_sub_explicit(&tree->uses, 1, memory_order_acq_rel) == 1) {
        he_bvh_free(tree->bvh);
        he_mem_free(tree);
    }
}

static void destroy(void *value)
{
    api_bvh_release(value);
}

static void hold(api_bvh *tree)
{
    atomic_fetch_add_explicit(&tree->uses, 1, memory_order_relaxed);
}

/* Returns a new entry for a tree that the caller will make. */
static api_bvh *tree_new(const api_asker *a)
{
    api_bvh *tree = he_mem_zero(1, sizeof *tree);
    if (tree != NULL) {
        atomic_init(&tree->uses, 1);
        tree->revision = a->revision;
    }
    return tree;
}

static uint64_t cost_of(const api_asker *a)
{
    return he_mesh_count(a->mesh, HE_HALFEDGE);
}

static bool must_be_made(const api_bvh *tree)
{
    return tree->bvh == NULL && !tree->abandoned;
}

/* Returns the entry that is kept with the mesh in `place`, if the entry is for the revision that
 * the request is about; otherwise a new entry for a tree that the caller must make. The caller
 * holds the lock of `place`. Returns NULL when memory is out, or if the request must start again on
 * another thread (then a->spent is set). */
static api_bvh *take(api_asker *a, const api_in *in, st_derived *place, api_bvh **dropped,
                     bool *made_here)
{
    api_bvh *kept = place->value;
    bool fits = kept != NULL && kept->revision == a->revision;
    if (fits && kept->bvh != NULL) {
        hold(kept);
        return kept;
    }
    if (a->on_worker && (fits || cost_of(a) >= api_asker_left(a))) {
        api_asker_exceed(a, in);
        return NULL;
    }
    if (!api_asker_waits(a, (double)api_elements_of(a->mesh) / API_BVH_PER_SECOND)) {
        return NULL;
    }
    if (fits) {
        hold(kept); /* another request is making the tree */
        return kept;
    }
    api_bvh *tree = tree_new(a);
    if (tree == NULL) {
        he_error err = {0};
        (void)he_fail_plain(&err, HE_NO_MEMORY,
                            "no memory for the search tree of the mesh's faces");
        api_asker_refuse(a, in, &err);
    } else if (kept == NULL || kept->revision < a->revision) {
        hold(tree);
        *dropped = kept;
        *place = (st_derived){tree, destroy};
    }
    *made_here = tree != NULL;
    return tree;
}

/* Returns the entry that is kept with the mesh, if it is for the revision that the request is
 * about. Otherwise returns a new entry, which replaces an entry for an earlier revision, and sets
 * `*made_here`: the caller must make the tree. */
static api_bvh *find(api_asker *a, const api_in *in, bool *made_here)
{
    api_bvh *dropped = NULL;
    st_derived *place = st_derived_begin(a->x->mesh, ST_DERIVED_BVH);
    api_bvh *tree = take(a, in, place, &dropped, made_here);
    st_derived_end(a->x->mesh, ST_DERIVED_BVH);
    api_bvh_release(dropped);
    return tree;
}

/* Waits until another request has made the tree. Returns HE_CANCELLED if the waiting request was
 * cancelled before that. */
static he_status await(const api_asker *a, const api_bvh *tree, he_error *err)
{
    for (;;) {
        st_derived_begin(a->x->mesh, ST_DERIVED_BVH);
        bool waits = must_be_made(tree);
        if (waits) {
            st_derived_wait(a->x->mesh, ST_DERIVED_BVH);
            waits = must_be_made(tree);
        }
        st_derived_end(a->x->mesh, ST_DERIVED_BVH);
        he_status status = waits ? he_progress_step(&a->x->progress, 0, 1, err) : HE_OK;
        if (!waits || status != HE_OK) {
            return status;
        }
    }
}

/* Ends the making of a tree: stores `bvh` in the entry, or marks the entry as abandoned if `bvh` is
 * NULL, and wakes all requests that wait for it. */
static void finish(const api_asker *a, api_bvh *tree, he_bvh *bvh)
{
    st_derived *place = st_derived_begin(a->x->mesh, ST_DERIVED_BVH);
    bool forget = bvh == NULL && place->value == tree;
    tree->bvh = bvh;
    tree->abandoned = bvh == NULL;
    if (forget) {
        *place = (st_derived){NULL, NULL};
    }
    st_derived_end(a->x->mesh, ST_DERIVED_BVH);
    if (forget) {
        api_bvh_release(tree);
    }
}

static he_status make(const api_asker *a, api_bvh *tree, he_error *err)
{
    he_bvh *bvh = NULL;
    he_status status = he_bvh_new(a->mesh, &a->x->progress, &bvh, err);
    finish(a, tree, bvh);
    return status;
}

const he_bvh *api_asker_bvh(api_asker *a, const api_in *in)
{
    while (a->tree == NULL) {
        he_error err = {0};
        bool made_here = false;
        api_bvh *tree = find(a, in, &made_here);
        if (tree == NULL) {
            return NULL;
        }
        if ((made_here ? make(a, tree, &err) : await(a, tree, &err)) != HE_OK) {
            api_bvh_release(tree);
            api_asker_refuse(a, in, &err);
            return NULL;
        }
        if (tree->bvh == NULL) {
            /* The request that was making the tree has given up, so the present request tries
             * again. */
            api_bvh_release(tree);
            continue;
        }
        /* The cost of making the tree is charged even if another request has made it, so that a
         * request is not refused or accepted by chance. A request on a worker thread pays only for
         * a tree that it made itself: if its steps run out, it is not refused, but starts again on
         * the job pool. */
        if (made_here || !a->on_worker) {
            api_asker_pay(a, cost_of(a));
        }
        a->tree = tree;
    }
    return a->tree->bvh;
}
