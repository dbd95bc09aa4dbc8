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

static he_status add(st_store *store, const char *name, he_error *err)
{
    he_mesh *content;
    st_mesh *mesh;
    he_status status = make(name, &content, err);
    if (status != HE_OK) {
        return status;
    }
    switch (st_create(store, name, name, content, NULL, &mesh)) {
    case ST_OK:
        st_release(mesh);
        return HE_OK;
    case ST_TAKEN:
        he_mesh_free(content);
        return HE_OK;
    case ST_ABSENT:
    case ST_NO_MEMORY:
    case ST_BUDGET:
    case ST_TOO_MANY:
    case ST_NOTHING:
    case ST_BUSY:
    case ST_LISTENERS:
    case ST_AHEAD:
    case ST_GONE:
    case ST_ELSEWHERE:
    case ST_LOST:
    case ST_COLD:
    case ST_LOADING:
    case ST_DAMAGED:
    case ST_NEWER:
    case ST_BEHIND:
    case ST_FULL:
    case ST_FAILED:
        break;
    }
    he_mesh_free(content);
    return he_fail_plain(err, HE_NO_MEMORY, "the store has no room for the sample %s", name);
}

he_status srv_samples_add(st_store *store, he_error *err)
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
