#include "format/gltf/gltf_whole.h"

#include "build/order.h"
#include "format/gltf/gltf_private.h"

#include <string.h>

static uint32_t find_private(const he_gltf *asset)
{
    const he_json *json = &asset->json;
    return he_json_find(json, he_json_find(json, 0, "extras"), "hedge");
}

/* --- checking whether the scene is as hedge wrote it --- */

/* Returns the JSON object of the accessor whose index is the number at `value`, HE_NONE if there is
 * none. */
static uint32_t accessor_of(const he_gltf *asset, uint32_t value)
{
    uint64_t index = 0;
    return he_json_whole(&asset->json, value, 0, HE_JSON_WHOLE, &index, NULL) == HE_OK &&
                   index < asset->accessors.count
               ? asset->accessors.ids[index]
               : HE_NONE;
}

static bool is_member(const he_json *json, uint32_t object, const char *name, uint64_t *out)
{
    uint32_t value = he_json_find(json, object, name);
    *out = 0;
    return value == HE_NONE || he_json_whole(json, value, 0, HE_JSON_WHOLE, out, NULL) == HE_OK;
}

/* Where an accessor of indices has its elements. */
typedef struct indices {
    uint64_t view, offset, type, count;
} indices;

static bool read_indices(const he_gltf *asset, uint32_t primitive, indices *out)
{
    const he_json *json = &asset->json;
    uint32_t accessor = accessor_of(asset, he_json_find(json, primitive, "indices"));
    return he_json_type(json, accessor) == '{' &&
           he_json_find(json, accessor, "sparse") == HE_NONE &&
           he_json_find(json, accessor, "bufferView") != HE_NONE &&
           is_member(json, accessor, "bufferView", &out->view) &&
           is_member(json, accessor, "byteOffset", &out->offset) &&
           is_member(json, accessor, "componentType", &out->type) &&
           is_member(json, accessor, "count", &out->count);
}

/* Returns true if two JSON objects have members of equal names in the same order, and the values
 * of these members are equal numbers. */
static bool same_attributes(const he_json *json, uint32_t a, uint32_t b)
{
    uint32_t i = he_json_first(json, a), k = he_json_first(json, b);
    bool same = he_json_type(json, a) == '{' && he_json_type(json, b) == '{';
    while (same && i != HE_NONE && k != HE_NONE) {
        size_t length, other;
        uint64_t number = 0, second = 0;
        const char *name = he_json_raw(json, i, &length), *text = he_json_raw(json, k, &other);
        same = length == other && memcmp(name, text, length) == 0 &&
               he_json_whole(json, he_json_of(i), 0, HE_JSON_WHOLE, &number, NULL) == HE_OK &&
               he_json_whole(json, he_json_of(k), 0, HE_JSON_WHOLE, &second, NULL) == HE_OK &&
               number == second;
        i = he_json_after(json, a, i);
        k = he_json_after(json, b, k);
    }
    return same && i == HE_NONE && k == HE_NONE;
}

typedef struct checking {
    he_gltf *asset;
    uint32_t whole; /* the primitive of all faces */
    indices all;
    uint64_t offset; /* byteOffset that the triangles of the next primitive must have */
} checking;

static bool fits_primitive(checking *s, uint32_t primitive)
{
    const he_json *json = &s->asset->json;
    indices part;
    uint64_t mode = 4;
    uint32_t value = he_json_find(json, primitive, "mode");
    bool fits = he_json_type(json, primitive) == '{' && read_indices(s->asset, primitive, &part) &&
                (value == HE_NONE || he_json_whole(json, value, 0, 6, &mode, NULL) == HE_OK) &&
                mode == 4 &&
                same_attributes(json, he_json_find(json, primitive, "attributes"),
                                he_json_find(json, s->whole, "attributes")) &&
                he_json_find(json, primitive, "extras") == HE_NONE &&
                he_json_find(json, primitive, "targets") == HE_NONE && part.view == s->all.view &&
                part.type == s->all.type && part.offset == s->offset && part.count % 3 == 0 &&
                part.count <= s->all.count;
    s->offset += fits ? part.count * he_gltf_type_bytes((he_gltf_type)part.type) : 0;
    return fits;
}

static bool fits_node(checking *s, uint32_t value)
{
    static const char *const moves[] = {"matrix", "translation", "rotation", "scale", "children"};
    const he_gltf *asset = s->asset;
    const he_json *json = &asset->json;
    uint64_t node = 0, mesh = 0;
    if (he_json_whole(json, value, 0, HE_JSON_WHOLE, &node, NULL) != HE_OK ||
        node >= asset->nodes.count) {
        return false;
    }
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        if (he_json_find(json, asset->nodes.ids[node], moves[i]) != HE_NONE) {
            return false;
        }
    }
    value = he_json_find(json, asset->nodes.ids[node], "mesh");
    if (he_json_whole(json, value, 0, HE_JSON_WHOLE, &mesh, NULL) != HE_OK ||
        mesh >= asset->meshes.count) {
        return false;
    }
    uint32_t list = he_json_find(json, asset->meshes.ids[mesh], "primitives");
    bool fits = he_json_type(json, list) == '[';
    for (uint32_t i = he_json_first(json, list); i != HE_NONE && fits;
         i = he_json_after(json, list, i)) {
        fits = fits_primitive(s, i);
    }
    return fits;
}

static bool same_names(const he_gltf_surface *surface, uint32_t list)
{
    const he_json *json = &surface->asset->json;
    size_t count = he_labels_count(surface->names), i = 0;
    uint32_t item = he_json_first(json, list);
    for (; item != HE_NONE && i < count && he_json_is(json, item, he_labels_get(surface->names, i));
         item = he_json_after(json, list, item)) {
        i++;
    }
    return item == HE_NONE && i == count;
}

/* Checks whether the scene is as hedge wrote it. The JSON values that are visited are charged to
 * the asset's limit. */
static he_status check_scene(he_gltf_surface *surface, uint32_t value, uint32_t private, bool *fits,
                             he_error *err)
{
    he_gltf *asset = surface->asset;
    const he_json *json = &asset->json;
    checking s = {.asset = asset, .whole = he_json_find(json, private, "primitive")};
    uint32_t roots = he_json_find(json, value, "nodes");
    *fits = he_json_type(json, s.whole) == '{' && value != HE_NONE &&
            he_gltf_has_private(asset, s.whole) && read_indices(asset, s.whole, &s.all) &&
            s.all.offset == 0 && same_names(surface, he_json_find(json, private, "materials"));
    size_t nodes = 0;
    he_status status = HE_OK;
    for (uint32_t i = he_json_first(json, roots); i != HE_NONE && *fits && status == HE_OK;
         i = he_json_after(json, roots, i)) {
        *fits = fits_node(&s, i);
        nodes++;
        status = he_gltf_spend(asset, private, 8 * he_json_span(json, s.whole), err);
        if (status == HE_OK) {
            status = he_gltf_poll(asset, err);
        }
    }
    *fits = *fits && nodes == asset->nodes.count && nodes == asset->meshes.count &&
            s.offset == s.all.count * he_gltf_type_bytes((he_gltf_type)s.all.type);
    return status;
}

he_status he_gltf_add_whole(he_gltf_surface *surface, uint32_t scene, bool *whole, he_error *err)
{
    const he_json *json = &surface->asset->json;
    uint32_t private = find_private(surface->asset);
    bool fits = false;
    *whole = false;
    if (he_json_type(json, private) != '{') {
        return HE_OK;
    }
    he_status status = check_scene(surface, scene, private, &fits, err);
    if (status != HE_OK) {
        return status;
    }
    if (!fits) {
        he_gltf_note_stale(surface->asset, private);
        return HE_OK;
    }
    *whole = true;
    return he_gltf_add_primitive(surface, he_json_find(json, private, "primitive"), HE_NONE,
                                 &he_gltf_no_frame, err);
}

/* --- the order of faces --- */

/* Reads the number that each face has in the mesh. Sets *fits to false unless each number below
 * the number of faces occurs once. */
static he_status read_order(he_gltf *asset, const he_gltf_accessor *a, uint32_t *order, bool *fits,
                            he_error *err)
{
    he_gltf_walk walk = {.accessor = a};
    he_status status = HE_OK;
    uint64_t *seen = he_bits_new((size_t)a->count + 1);
    if (seen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to order faces");
    }
    for (uint64_t i = 0; i < a->count && *fits && status == HE_OK; i++) {
        uint32_t number = he_gltf_whole(HE_GLTF_UINT32, he_gltf_next(&walk));
        *fits = number < a->count && !he_bits_get(seen, number);
        if (*fits) {
            he_bits_set(seen, number);
            order[i] = number;
        }
        status = he_gltf_poll(asset, err);
    }
    he_mem_free(seen);
    return status;
}

/* Renumbers the faces of a map that says where in the input each face begins: face i becomes
 * face order[i]. */
static he_status order_source_map(he_source_map *map, const uint32_t *order, size_t count,
                                  he_error *err)
{
    he_source_map made;
    he_status status = HE_OK;
    uint32_t *from = he_mem_array(NULL, count, sizeof *from);
    he_source_map_init(&made, map->unit, map->step);
    if (from == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to order faces");
    }
    for (uint32_t i = 0; i < count; i++) {
        from[order[i]] = i;
    }
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        status = he_source_map_add(&made, i, he_source_map_find(map, from[i]), err);
    }
    he_mem_free(from);
    if (status != HE_OK) {
        he_source_map_clear(&made);
        return status;
    }
    he_source_map_clear(map);
    *map = made;
    return HE_OK;
}

he_status he_gltf_order_whole(he_gltf_surface *surface, he_error *err)
{
    he_gltf *asset = surface->asset;
    he_import *into = asset->into;
    uint32_t value = he_json_find(&asset->json, find_private(asset), "order");
    he_gltf_accessor a = {.bytes = NULL};
    size_t count = into->soup.face_count;
    bool fits = value != HE_NONE && he_gltf_accessor_get(asset, value, &a, NULL) == HE_OK &&
                a.components == 1 && a.type == HE_GLTF_UINT32 && a.bytes != NULL &&
                a.count == count;
    if (!fits) {
        he_gltf_note_stale(asset, find_private(asset));
        return HE_OK;
    }
    he_status status =
        he_gltf_spend(asset, value, count * (2 * sizeof(uint32_t) + sizeof(he_source_run)), err);
    uint32_t *order = status != HE_OK ? NULL : he_mem_array(NULL, count, sizeof *order);
    if (status == HE_OK && order == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to sort %zu faces", count);
    }
    if (status == HE_OK) {
        status = read_order(asset, &a, order, &fits, err);
    }
    if (status == HE_OK && !fits) {
        he_gltf_note_stale(asset, value);
    } else if (status == HE_OK) {
        status = he_soup_order_faces(&into->soup, order, err);
        if (status == HE_OK) {
            status = order_source_map(&into->faces, order, count, err);
        }
    }
    he_mem_free(order);
    return status;
}
