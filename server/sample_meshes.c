#include "server/sample_meshes.h"

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
    st_status stored = st_create(store, name, name, content, NULL, &mesh);
    if (stored == ST_OK) {
        st_release(mesh);
        return HE_OK;
    }
    he_mesh_free(content);
    return stored == ST_TAKEN
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "the store has no room for the sample %s", name);
}

he_status srv_sample_meshes_add(st_store *store, he_error *err)
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
