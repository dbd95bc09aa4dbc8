#include "format/gltf/gltf_scene.h"

#include "format/gltf/gltf_surface.h"
#include "format/gltf/gltf_whole.h"

#include <math.h>
#include <string.h>

/* A node whose children are being visited. */
typedef struct level {
    he_gltf_frame frame;
    uint32_t children, child; /* children: the JSON array of the node's children; child: the next
                               * child to visit, or HE_NONE */
} level;

typedef struct scene {
    he_gltf *asset;
    he_gltf_surface surface;
    /* Sets of bits: visited: the nodes that were visited; used: the meshes that nodes used. */
    uint64_t *visited, *used;
    uint64_t instances; /* how many nodes have a mesh that an earlier node has, too */
    level *levels;
    size_t depth, capacity;
} scene;

/* --- transforms --- */

static he_gltf_frame multiply(const he_gltf_frame *a, const he_gltf_frame *b)
{
    he_gltf_frame out;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++) {
            const double *r = a->row[i];
            out.row[i][k] = r[0] * b->row[0][k] + r[1] * b->row[1][k] + r[2] * b->row[2][k] +
                            (k == 3 ? r[3] : 0);
        }
    }
    return out;
}

/* A member of a node that is a list of numbers. */
typedef struct numbers {
    const char *name;
    size_t count;
    double *values; /* where the numbers are stored; not changed if the member is missing */
    bool found;
} numbers;

static he_status get_numbers(const he_json *json, uint32_t node, numbers *n, he_error *err)
{
    uint32_t list = he_json_find(json, node, n->name), item = he_json_first(json, list);
    n->found = list != HE_NONE;
    if (list == HE_NONE) {
        return HE_OK;
    }
    he_status status = HE_OK;
    size_t i = 0;
    for (; item != HE_NONE && i < n->count && status == HE_OK;
         item = he_json_after(json, list, item), i++) {
        status = he_json_number(json, item, &n->values[i], err);
    }
    if (status == HE_OK && (i < n->count || item != HE_NONE || he_json_type(json, list) != '[')) {
        return he_json_fail(json, list, err, HE_BAD_VALUE,
                            "the value must be an array of %zu numbers", n->count);
    }
    return status;
}

/* If the length of a quaternion differs from 1 by no more than this, the difference is taken for
 * rounding. */
static const double UNIT = 1e-4;

/* Normalises the quaternion of a rotation, because one of another length than 1 would also scale.
 */
static he_status make_unit(he_gltf *asset, uint32_t node, double q[4], he_error *err)
{
    const he_json *json = &asset->json;
    double largest = fmax(fmax(fabs(q[0]), fabs(q[1])), fmax(fabs(q[2]), fabs(q[3])));
    if (largest == 0) {
        return he_json_fail(json, he_json_find(json, node, "rotation"), err, HE_BAD_VALUE,
                            "a rotation cannot be a quaternion of length 0");
    }
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        sum += q[i] / largest * (q[i] / largest);
    }
    double length = sqrt(sum) * largest;
    if (fabs(length - 1) > UNIT) {
        he_gltf_note(
            asset, "rotation_made_unit",
            "the quaternion of a rotation is scaled to length 1, because it has another length",
            HE_NONE, node);
    }
    for (int i = 0; i < 4; i++) {
        q[i] = q[i] / largest / sqrt(sum);
    }
    return HE_OK;
}

/* Returns the product of a translation t, the rotation of a unit quaternion q, and a scaling s. */
static he_gltf_frame compose(const double *t, const double *q, const double *s)
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    return (he_gltf_frame){{{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1],
                             2 * (x * z + y * w) * s[2], t[0]},
                            {2 * (x * y + z * w) * s[0], (1 - 2 * (x * x + z * z)) * s[1],
                             2 * (y * z - x * w) * s[2], t[1]},
                            {2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1],
                             (1 - 2 * (x * x + y * y)) * s[2], t[2]}}};
}

static he_status get_frame(he_gltf *asset, uint32_t node, he_gltf_frame *out, bool *moves,
                           he_error *err)
{
    const he_json *json = &asset->json;
    double m[16] = {0}, t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    numbers matrix = {"matrix", 16, m, false}, translation = {"translation", 3, t, false};
    numbers rotation = {"rotation", 4, q, false}, scale = {"scale", 3, s, false};
    he_status status = get_numbers(json, node, &matrix, err);
    if (status == HE_OK) {
        status = get_numbers(json, node, &translation, err);
    }
    if (status == HE_OK) {
        status = get_numbers(json, node, &rotation, err);
    }
    if (status == HE_OK && rotation.found) {
        status = make_unit(asset, node, q, err);
    }
    if (status == HE_OK) {
        status = get_numbers(json, node, &scale, err);
    }
    if (status != HE_OK) {
        return status;
    }
    const bool composed = translation.found || rotation.found || scale.found;
    *moves = matrix.found || composed;
    if (!matrix.found) {
        *out = compose(t, q, s);
        return HE_OK;
    }
    if (composed) {
        he_gltf_note(asset, "matrix_and_more",
                     "the translation, rotation or scale of a node is ignored, because the node "
                     "also has a matrix",
                     HE_NONE, node);
    }
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
        return he_json_fail(json, he_json_find(json, node, "matrix"), err, HE_BAD_VALUE,
                            "the last row of the matrix is not 0 0 0 1");
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++) {
            out->row[i][k] = m[4 * k + i];
        }
    }
    return HE_OK;
}

/* --- nodes --- */

static he_status add_mesh(scene *s, uint32_t node, uint32_t value, const he_gltf_frame *frame,
                          he_error *err)
{
    he_gltf *asset = s->asset;
    const he_json *json = &asset->json;
    uint32_t mesh = HE_NONE;
    uint64_t index = 0;
    he_status status = he_gltf_item(asset, &asset->meshes, value, "mesh", &mesh, err);
    if (status == HE_OK) {
        status = he_json_whole(json, value, 0, HE_JSON_WHOLE, &index, err);
    }
    if (status != HE_OK) {
        return status;
    }
    s->instances += he_bits_get(s->used, index) != 0;
    he_bits_set(s->used, index);
    uint32_t name = he_json_find(json, node, "name");
    name = name != HE_NONE ? name : he_json_find(json, mesh, "name");
    return he_gltf_add_mesh(&s->surface, mesh, name, frame, err);
}

static he_status push(scene *s, const he_gltf_frame *frame, uint32_t children, uint32_t node,
                      he_error *err)
{
    if (s->depth == HE_GLTF_DEPTH) {
        return he_json_fail(&s->asset->json, node, err, HE_LIMIT,
                            "nodes are nested deeper than %d levels", (int)HE_GLTF_DEPTH);
    }
    if (s->depth == s->capacity) {
        size_t capacity = he_mem_grown(s->capacity, s->depth + 1);
        level *levels = he_mem_array(s->levels, capacity, sizeof *levels);
        if (levels == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu levels of nodes", capacity);
        }
        s->levels = levels;
        s->capacity = capacity;
    }
    s->levels[s->depth++] = (level){*frame, children, he_json_first(&s->asset->json, children)};
    return HE_OK;
}

/* Visits node `index`: adds its mesh, and pushes its children. Errors name the JSON number
 * `value`, which refers to the node. */
static he_status visit(scene *s, uint64_t index, uint32_t value, const he_gltf_frame *parent,
                       he_error *err)
{
    he_gltf *asset = s->asset;
    const he_json *json = &asset->json;
    uint32_t node = asset->nodes.ids[index];
    bool moves = false;
    he_gltf_frame frame = he_gltf_no_frame;
    if (he_bits_get(s->visited, index)) {
        return he_json_fail(json, value, err, HE_BAD_VALUE,
                            "node %llu is reached twice: it has two parents, or is inside itself",
                            (unsigned long long)index);
    }
    he_bits_set(s->visited, index);
    he_status status = he_gltf_poll(asset, err);
    if (status == HE_OK) {
        status = get_frame(asset, node, &frame, &moves, err);
    }
    if (status != HE_OK) {
        return status;
    }
    frame = moves ? multiply(parent, &frame) : *parent;
    uint32_t mesh = he_json_find(json, node, "mesh"), children = HE_NONE;
    status = he_gltf_array(asset, node, "children", &children, err);
    if (status == HE_OK && mesh != HE_NONE) {
        status = add_mesh(s, node, mesh, &frame, err);
    }
    if (status == HE_OK && children != HE_NONE) {
        status = push(s, &frame, children, node, err);
    }
    return status;
}

/* Visits the node whose index is the JSON number at `value`. */
static he_status visit_named(scene *s, uint32_t value, const he_gltf_frame *parent, he_error *err)
{
    uint32_t node;
    uint64_t index = 0;
    he_status status = he_gltf_item(s->asset, &s->asset->nodes, value, "node", &node, err);
    if (status == HE_OK) {
        status = he_json_whole(&s->asset->json, value, 0, HE_JSON_WHOLE, &index, err);
    }
    return status == HE_OK ? visit(s, index, value, parent, err) : status;
}

/* Visits all descendants of the nodes that were visited so far. */
static he_status visit_rest(scene *s, he_error *err)
{
    he_status status = HE_OK;
    while (s->depth > 0 && status == HE_OK) {
        level *top = &s->levels[s->depth - 1];
        if (top->child == HE_NONE) {
            s->depth--;
            continue;
        }
        uint32_t child = top->child;
        he_gltf_frame frame = top->frame; /* a copy, because s->levels may be reallocated */
        top->child = he_json_after(&s->asset->json, top->children, child);
        status = visit_named(s, child, &frame, err);
    }
    return status;
}

/* --- choosing the scene --- */

static he_status find_scene(he_gltf *asset, uint32_t *out, he_error *err)
{
    const he_json *json = &asset->json;
    he_ids scenes = {0};
    uint32_t list = HE_NONE, chosen = he_json_find(json, 0, "scene");
    he_status status = he_gltf_array(asset, 0, "scenes", &list, err);
    *out = HE_NONE;
    for (uint32_t i = status == HE_OK ? he_json_first(json, list) : HE_NONE;
         i != HE_NONE && status == HE_OK; i = he_json_after(json, list, i)) {
        status = he_json_type(json, i) == '{'
                     ? he_ids_add(&scenes, i, err)
                     : he_json_fail(json, i, err, HE_BAD_VALUE, "a scene must be an object");
    }
    if (status == HE_OK && chosen != HE_NONE) {
        status = he_gltf_item(asset, &scenes, chosen, "scene", out, err);
    } else if (status == HE_OK && scenes.count > 0) {
        *out = scenes.ids[0];
    }
    if (status == HE_OK && scenes.count > 1) {
        he_gltf_note(asset, "other_scenes",
                     "all scenes but one are ignored, because a mesh is made of one scene", HE_NONE,
                     list);
    }
    he_ids_clear(&scenes);
    return status;
}

static he_status visit_scene(scene *s, uint32_t value, he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t roots = HE_NONE;
    he_status status = he_gltf_array(s->asset, value, "nodes", &roots, err);
    for (uint32_t i = status == HE_OK ? he_json_first(json, roots) : HE_NONE;
         i != HE_NONE && status == HE_OK; i = he_json_after(json, roots, i)) {
        status = visit_named(s, i, &he_gltf_no_frame, err);
        if (status == HE_OK) {
            status = visit_rest(s, err);
        }
    }
    return status;
}

/* The parent of a node: the JSON value that refers to the node as a child, and the node that
 * contains this value; HE_NONE if there is none. */
typedef struct parent {
    uint32_t value, node;
} parent;

static he_status find_parents(he_gltf *asset, parent *parents, he_error *err)
{
    const he_json *json = &asset->json;
    he_status status = HE_OK;
    for (size_t i = 0; i < asset->nodes.count && status == HE_OK; i++) {
        uint32_t list = HE_NONE;
        status = he_gltf_array(asset, asset->nodes.ids[i], "children", &list, err);
        for (uint32_t k = status == HE_OK ? he_json_first(json, list) : HE_NONE;
             k != HE_NONE && status == HE_OK; k = he_json_after(json, list, k)) {
            uint64_t index = 0;
            status = he_json_whole(json, k, 0, asset->nodes.count - 1, &index, err);
            if (status == HE_OK) {
                parents[index] = (parent){k, (uint32_t)i};
                status = he_gltf_poll(asset, err);
            }
        }
    }
    return status;
}

/* Refuses a cycle of nodes. A node that cannot be reached from a root (a node without a parent)
 * has a parent, and so has each of its ancestors: going from parent to parent must therefore end
 * in a cycle. */
static he_status refuse_cycle(const scene *s, const parent *parents, uint32_t node, he_error *err)
{
    for (size_t i = 0; i < s->asset->nodes.count; i++) {
        node = parents[node].node;
    }
    return he_json_fail(&s->asset->json, parents[node].value, err, HE_BAD_VALUE,
                        "node %u is inside itself", node);
}

/* Visits the nodes that are no children of others, if the file has no scenes. */
static he_status visit_roots(scene *s, he_error *err)
{
    const he_ids *nodes = &s->asset->nodes;
    parent *parents = he_mem_array(NULL, nodes->count, sizeof *parents);
    if (parents == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu nodes", nodes->count);
    }
    for (size_t i = 0; i < nodes->count; i++) {
        parents[i] = (parent){HE_NONE, HE_NONE};
    }
    he_status status = find_parents(s->asset, parents, err);
    for (size_t i = 0; i < nodes->count && status == HE_OK; i++) {
        if (parents[i].node == HE_NONE) {
            status = visit(s, i, nodes->ids[i], &he_gltf_no_frame, err);
        }
        if (status == HE_OK) {
            status = visit_rest(s, err);
        }
    }
    for (size_t i = 0; i < nodes->count && status == HE_OK; i++) {
        if (!he_bits_get(s->visited, i)) {
            status = refuse_cycle(s, parents, (uint32_t)i, err);
        }
    }
    he_mem_free(parents);
    return status;
}

static he_status add_all_meshes(scene *s, he_error *err)
{
    const he_ids *meshes = &s->asset->meshes;
    he_status status = HE_OK;
    for (size_t i = 0; i < meshes->count && status == HE_OK; i++) {
        uint32_t name = he_json_find(&s->asset->json, meshes->ids[i], "name");
        he_bits_set(s->used, i);
        status = he_gltf_add_mesh(&s->surface, meshes->ids[i], name, &he_gltf_no_frame, err);
    }
    return status;
}

static void note_meshes(const scene *s)
{
    he_warnings *warnings = &s->asset->into->warnings;
    uint64_t unused = 0;
    for (size_t i = 0; i < s->asset->meshes.count; i++) {
        unused += he_bits_get(s->used, i) == 0;
    }
    he_warnings_add_count(warnings, "unused_meshes",
                          "a mesh is left out, because no node of the scene uses it", unused);
    he_warnings_add_count(warnings, "instances", "a mesh is copied, because several nodes use it",
                          s->instances);
}

he_status he_gltf_read_scene(he_gltf *asset, he_error *err)
{
    scene s = {.asset = asset, .surface = {.asset = asset}};
    uint32_t chosen = HE_NONE;
    he_status status = HE_OK;
    s.visited = he_bits_new(asset->nodes.count + 1);
    s.used = he_bits_new(asset->meshes.count + 1);
    if (s.visited == NULL || s.used == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for nodes and meshes");
    }
    if (status == HE_OK) {
        status = he_gltf_read_materials(asset, &s.surface.names, err);
    }
    if (status == HE_OK) {
        status = find_scene(asset, &chosen, err);
    }
    bool whole = false;
    if (status == HE_OK) {
        status = he_gltf_add_whole(&s.surface, chosen, &whole, err);
    }
    if (status == HE_OK && !whole) {
        status = chosen != HE_NONE        ? visit_scene(&s, chosen, err)
                 : asset->nodes.count > 0 ? visit_roots(&s, err)
                                          : add_all_meshes(&s, err);
    }
    if (status == HE_OK) {
        status = he_gltf_surface_finish(&s.surface, err);
    }
    if (status == HE_OK && whole) {
        status = he_gltf_order_whole(&s.surface, err);
    } else if (status == HE_OK) {
        note_meshes(&s);
    }
    he_labels_release(s.surface.names);
    he_gltf_surface_clear(&s.surface);
    he_mem_free(s.visited);
    he_mem_free(s.used);
    he_mem_free(s.levels);
    return status;
}
