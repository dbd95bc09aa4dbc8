#include "api/tree.h"

#include <stdatomic.h>

typedef struct api_tree {
    _Atomic uint32_t uses; /* one while it is kept, one for each asker */
    uint64_t revision;
    he_bvh *bvh;
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

/* The one that is kept, if it is of this revision; one of an earlier revision is dropped. */
static api_tree *find(const api_asker *a)
{
    const api_store *store = a->x->store;
    api_derived *place = store->derived_begin(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree *kept = place->value, *found = NULL, *dropped = NULL;
    if (kept != NULL && kept->revision == a->revision) {
        atomic_fetch_add_explicit(&kept->uses, 1, memory_order_relaxed);
        found = kept;
    } else if (kept != NULL && kept->revision < a->revision) {
        dropped = kept;
        *place = (api_derived){NULL, NULL};
    }
    store->derived_end(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree_release(dropped);
    return found;
}

/* Unless somebody was faster, perhaps with a later revision. */
static void keep(const api_asker *a, api_tree *tree)
{
    const api_store *store = a->x->store;
    api_derived *place = store->derived_begin(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree *kept = place->value;
    if (kept == NULL || kept->revision < tree->revision) {
        atomic_fetch_add_explicit(&tree->uses, 1, memory_order_relaxed);
        *place = (api_derived){tree, destroy};
    } else {
        kept = NULL;
    }
    store->derived_end(store->self, a->x->mesh, API_DERIVED_TREE);
    api_tree_release(kept);
}

static api_tree *make(api_asker *a, const api_in *in)
{
    uint64_t cost = he_mesh_count(a->mesh, HE_HALFEDGE);
    if (a->on_worker && cost >= a->left) {
        api_asker_exceed(a, in);
        return NULL;
    }
    he_error err = {0};
    api_tree *tree = he_mem_zero(1, sizeof *tree);
    if (tree == NULL) {
        api_in_fail(in, HE_NO_MEMORY, "no memory for a tree of boxes");
        return NULL;
    }
    if (he_bvh_new(a->mesh, a->x->watch, &tree->bvh, &err) != HE_OK) {
        he_mem_free(tree);
        api_asker_refuse(a, in, &err);
        return NULL;
    }
    api_asker_pay(a, cost);
    atomic_init(&tree->uses, 1);
    tree->revision = a->revision;
    keep(a, tree);
    return tree;
}

const he_bvh *api_asker_tree(api_asker *a, const api_in *in)
{
    if (a->tree == NULL) {
        a->tree = find(a);
    }
    if (a->tree == NULL) {
        a->tree = make(a, in);
    }
    return a->tree == NULL ? NULL : a->tree->bvh;
}
