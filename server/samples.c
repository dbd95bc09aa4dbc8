#include "server/samples.h"

#include "algo/shape.h"

#include <string.h>

static he_status make(const char *name, he_mesh **out, he_error *err)
{
    const he_shape *shape = he_shape_find(name, strlen(name));
    if (shape == NULL) {
        return he_fail_plain(err, HE_BAD_VALUE, "there is no shape %s", name);
    }
    double args[HE_SHAPE_PARAMS];
    he_soup soup = {0};
    he_shape_defaults(shape, args);
    he_status status = he_shape_make(shape, args, NULL, &soup, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_build(&soup, HE_BUILD_TAKE, out, NULL, err);
    he_soup_clear(&soup);
    return status;
}

static he_status add(const api_store *store, const char *name, he_error *err)
{
    he_mesh *content;
    api_mesh *mesh;
    he_status status = make(name, &content, err);
    if (status != HE_OK) {
        return status;
    }
    switch (store->create(store->self, name, name, content, NULL, &mesh)) {
    case API_STORE_OK:
        store->release(store->self, mesh);
        return HE_OK;
    case API_STORE_TAKEN:
        he_mesh_free(content);
        return HE_OK;
    case API_STORE_ABSENT:
    case API_STORE_NO_MEMORY:
    case API_STORE_BUDGET:
    case API_STORE_TOO_MANY:
    case API_STORE_NOTHING:
    case API_STORE_BUSY:
    case API_STORE_LISTENERS:
    case API_STORE_AHEAD:
    case API_STORE_GONE:
    case API_STORE_ELSEWHERE:
        break;
    }
    he_mesh_free(content);
    return he_fail_plain(err, HE_NO_MEMORY, "the store has no room for the sample %s", name);
}

he_status srv_samples_add(const api_store *store, he_error *err)
{
    static const char *const names[] = {"cube", "icosphere", "torus"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        he_status status = add(store, names[i], err);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}
