#include "api/tree.h"

#include <stdatomic.h>

/* `bvh` and `abandoned` are written once, under the place; both unset, it is being made. */
typedef struct api_tree {
    _Atomic uint32_t uses; /* one while it is kept, one for each asker */
    uint64_t revision;
    he_bvh *bvh;
    bool abandoned; /* it could not be made */
} api_tree;

void api_tree_release(api_tree *tree)
{
    if (tree != NULL && atomic_fetch_sub_explicit(&tree->uses, 1, memory_order_acq_rel) == 1) {
        he_bvh_free(tree->bvh);
        he_mem_free(tree);
    }
}

static void destroy(void *value)
{
    api_tree_release(value);
}

static void hold(api_tree *tree)
{
    atomic_fetch_add_explicit(&tree->uses, 1, memory_order_relaxed);
}

/* One that is still to be made. */
static api_tree *tree_new(const api_asker *a)
{
    api_tree *tree = he_mem_zero(1, sizeof *tree);
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

/* Under the place. NULL when memory is out, or with a->spent. */
static api_tree *take(api_asker *a, const api_in *in, api_derived *place, api_tree **dropped)
{
    const api_store *store = a->x->store;
    api_tree *kept = place->value;
    while (kept != NULL && kept->revision == a->revision) {
        if (kept->bvh == NULL && a->on_worker) {
            api_asker_exceed(a, in);
            return NULL;
        }
        hold(kept);
        while (kept->bvh == NULL && !kept->abandoned) {
            store->derived_wait(store->self, a->x->mesh, API_DERIVED_TREE);
        }
        if (kept->bvh != NULL) {
            return kept;
        }
        api_tree_release(kept); /* there is no tree in it: nothing that takes long */
        kept = place->value;
    }
    if (a->on_worker && cost_of(a) >= a->left) {
        api_asker_exceed(a, in);
        return NULL;
    }
    api_tree *tree = tree_new(a);
    if (tree == NULL) {
        he_error err = {0};
        (void)he_fail_plain(&err, HE_NO_MEMORY, "no memory for a tree of boxes");
        api_asker_refuse(a, in, &err);
    } else if (kept == NULL || kept->revision < a->revision) {
        hold(tree);
        *dropped = kept;
        *place = (api_derived){tree, destroy};
    }
    return tree;
}

/* The one that is kept, if it is of this revision; else one that the asker has to make, which takes
 * the place of one of an earlier revision. */
static api_tree *find(api_asker *a, const api_in *in)
{
    const api_store *store = a->x->store;
    api_tree *dropped = NULL;
    api_derived *place = store->derived_begin(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree *tree = take(a, in, place, &dropped);
    store->derived_end(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree_release(dropped);
    return tree;
}

/* Once made, or given up with NULL: whoever waits for it goes on. */
static void finish(const api_asker *a, api_tree *tree, he_bvh *bvh)
{
    const api_store *store = a->x->store;
    api_derived *place = store->derived_begin(store->self, a->x->mesh, API_DERIVED_TREE);
    bool forget = bvh == NULL && place->value == tree;
    tree->bvh = bvh;
    tree->abandoned = bvh == NULL;
    if (forget) {
        *place = (api_derived){NULL, NULL};
    }
    store->derived_end(store->self, a->x->mesh, API_DERIVED_TREE);
    if (forget) {
        api_tree_release(tree);
    }
}

static bool make(api_asker *a, const api_in *in, api_tree *tree)
{
    he_error err = {0};
    he_bvh *bvh = NULL;
    bool made = he_bvh_new(a->mesh, &a->x->watch, &bvh, &err) == HE_OK;
    finish(a, tree, bvh);
    if (!made) {
        api_tree_release(tree);
        return api_asker_refuse(a, in, &err);
    }
    api_asker_pay(a, cost_of(a));
    return true;
}

const he_bvh *api_asker_tree(api_asker *a, const api_in *in)
{
    if (a->tree == NULL) {
        api_tree *tree = find(a, in);
        if (tree == NULL || (tree->bvh == NULL && !make(a, in, tree))) {
            return NULL;
        }
        a->tree = tree;
    }
    return a->tree->bvh;
}
