#include "format/gltf/glb_groups.h"

#include "base/word_hash.h"
#include "mesh/walk.h"

#include <stdlib.h>
#include <string.h>

static const char *const attributes[HE_GLB_NAMES] = {"object", "group", HE_MATERIAL_ATTRIBUTE};

void he_glb_groups_clear(he_glb_groups *groups)
{
    he_mem_free(groups->list);
    he_mem_free(groups->order);
    he_mem_free(groups->cut);
    he_ids_clear(&groups->only_names);
    *groups = (he_glb_groups){.list = NULL};
}

const char *he_glb_name(const he_glb_groups *groups, const he_glb_group *group, size_t which)
{
    const he_column *column = groups->names[which];
    return column != NULL && group->label[which] < he_labels_count(column->labels)
               ? he_labels_get(column->labels, group->label[which])
               : "";
}

static const he_column *find_names(const he_mesh *m, const char *name)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, name);
    bool named = column != NULL && column->type == HE_UINT32 && column->components == 1 &&
                 column->labels != NULL;
    return named ? column : NULL;
}

/* --- finding the groups --- */

typedef struct finding {
    const he_mesh *mesh;
    he_glb_groups *groups;
    uint32_t *of;    /* group of each face */
    uint32_t *slots; /* hash table: a slot has the number of a group + 1, a free slot 0 */
} finding;

enum { SLOTS = 4 * HE_GLB_PRIMITIVES };

static uint32_t label_of(const he_column *column, uint32_t face)
{
    uint32_t label = 0;
    if (column != NULL) {
        memcpy(&label, he_column_value(column, face), sizeof label);
    }
    return label;
}

/* Finds the group to which a face belongs, or makes a new group. Returns false if there are too
 * many groups. */
static bool find_group(finding *f, uint32_t face, uint32_t *out)
{
    he_glb_groups *g = f->groups;
    he_glb_group wanted = {.first = 0};
    uint64_t hash = (uintptr_t)f->slots;
    for (size_t i = 0; i < HE_GLB_NAMES; i++) {
        wanted.label[i] = label_of(g->names[i], face);
        hash = he_word_hash(hash, wanted.label[i] + hash);
    }
    size_t slot = (size_t)(hash >> 40) % SLOTS;
    while (f->slots[slot] != 0 &&
           memcmp(g->list[f->slots[slot] - 1].label, wanted.label, sizeof wanted.label) != 0) {
        slot = (slot + 1) % SLOTS;
    }
    if (f->slots[slot] == 0) {
        if (g->count == HE_GLB_PRIMITIVES) {
            return false;
        }
        g->list[g->count++] = wanted;
        f->slots[slot] = (uint32_t)g->count;
    }
    *out = f->slots[slot] - 1;
    return true;
}

static bool find_groups(finding *f)
{
    const he_mesh *m = f->mesh;
    memset(f->slots, 0, SLOTS * sizeof *f->slots);
    f->groups->count = 0;
    for (uint32_t face = 0; face < m->c.faces.issued; face++) {
        if (!he_face_is_live(m, (he_face){face})) {
            continue;
        }
        if (!find_group(f, face, &f->of[face])) {
            return false;
        }
        he_glb_group *group = &f->groups->list[f->of[face]];
        group->triangles += he_face_degree(m, (he_face){face}) - 2;
    }
    return true;
}

/* --- their order --- */

typedef struct placed {
    /* Numbers of three groups of faces: `group` is the one to be sorted; `object` is the first
     * one with an equal attribute object; `mesh` is the first one with equal attributes object
     * and group. */
    uint32_t object, mesh, group;
} placed;

static int compare(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    if (a->object != b->object) {
        return a->object < b->object ? -1 : 1;
    }
    if (a->mesh != b->mesh) {
        return a->mesh < b->mesh ? -1 : 1;
    }
    return a->group < b->group ? -1 : a->group > b->group;
}

/* Sorts the groups of faces so that those with equal attributes object and group follow each
 * other, in the order of their first faces. Sets rank[i] to the new number of group i. */
static he_status sort_groups(he_glb_groups *g, uint32_t *rank, he_error *err)
{
    placed *places = he_mem_array(NULL, g->count, sizeof *places);
    he_glb_group *sorted = he_mem_array(NULL, g->count, sizeof *sorted);
    if (places == NULL || sorted == NULL) {
        he_mem_free(places);
        he_mem_free(sorted);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu groups of faces", g->count);
    }
    for (uint32_t i = 0; i < g->count; i++) {
        const uint32_t *label = g->list[i].label;
        places[i] = (placed){i, i, i};
        for (uint32_t k = 0; k < i && places[i].mesh == i; k++) {
            bool same = g->list[k].label[HE_GLB_OBJECT] == label[HE_GLB_OBJECT];
            if (same && places[i].object == i) {
                places[i].object = k;
            }
            if (same && g->list[k].label[HE_GLB_GROUP] == label[HE_GLB_GROUP]) {
                places[i].mesh = k;
            }
        }
    }
    qsort(places, g->count, sizeof *places, compare);
    uint64_t first = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        sorted[i] = g->list[places[i].group];
        sorted[i].first = first;
        first += sorted[i].triangles;
        rank[places[i].group] = i;
    }
    he_mem_free(places);
    he_mem_free(g->list);
    g->list = sorted;
    return HE_OK;
}

/* Sorts the faces by groups, and finds where the triangles of each face begin in
 * he_export_triangles.corners. */
static he_status order_faces(finding *f, const uint32_t *rank, he_error *err)
{
    const he_mesh *m = f->mesh;
    he_glb_groups *g = f->groups;
    uint32_t issued = m->c.faces.issued;
    size_t *next = he_mem_zero(g->count + 1, sizeof *next);
    g->order = he_mem_array(NULL, m->c.faces.live, sizeof *g->order);
    g->cut = he_mem_array(NULL, issued, sizeof *g->cut);
    if (next == NULL || g->order == NULL || g->cut == NULL) {
        he_mem_free(next);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to order %u faces", issued);
    }
    size_t corner = 0;
    for (uint32_t face = 0; face < issued; face++) {
        if (he_face_is_live(m, (he_face){face})) {
            uint32_t degree = he_face_degree(m, (he_face){face});
            g->cut[face] = corner;
            corner += degree == 3 ? 0 : 3 * ((size_t)degree - 2);
            next[rank[f->of[face]] + 1]++;
        }
    }
    for (size_t i = 1; i <= g->count; i++) {
        next[i] += next[i - 1];
    }
    for (uint32_t face = 0; face < issued; face++) {
        if (he_face_is_live(m, (he_face){face})) {
            g->order[next[rank[f->of[face]]]++] = face;
        }
    }
    he_mem_free(next);
    return HE_OK;
}

/* --- materials --- */

static size_t row_of(const he_mesh *m, const char *name)
{
    return he_materials_find(he_mesh_materials(m), name, strlen(name));
}

static he_status list_names(const he_mesh *m, he_glb_groups *g, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < g->count && status == HE_OK; i++) {
        const char *name = he_glb_name(g, &g->list[i], HE_GLB_MATERIAL);
        uint32_t label = g->list[i].label[HE_GLB_MATERIAL];
        size_t k = 0;
        while (k < g->only_names.count && g->only_names.ids[k] != label) {
            k++;
        }
        if (*name != '\0' && k == g->only_names.count && row_of(m, name) == SIZE_MAX) {
            status = he_ids_add(&g->only_names, label, err);
        }
    }
    return status;
}

uint32_t he_glb_material(const he_mesh *m, const he_glb_groups *g, const he_glb_group *group)
{
    const he_materials *table = he_mesh_materials(m);
    const char *name = he_glb_name(g, group, HE_GLB_MATERIAL);
    size_t slot = row_of(m, name), number = 0;
    if (*name == '\0') {
        return HE_NONE;
    }
    for (size_t i = 0; i < table->count && i < slot; i++) {
        number += table->rows[i] != NULL;
    }
    for (size_t k = 0; slot == SIZE_MAX && g->only_names.ids[k] != group->label[HE_GLB_MATERIAL];
         k++) {
        number++;
    }
    return (uint32_t)number;
}

/* --- the whole --- */

static he_status make(finding *f, he_warnings *warnings, he_error *err)
{
    static const char *const told[] = {"objects and groups", "materials"};
    he_glb_groups *g = f->groups;
    for (size_t i = 0; i < HE_GLB_NAMES; i++) {
        g->names[i] = find_names(f->mesh, attributes[i]);
    }
    bool found = find_groups(f);
    for (size_t tries = 0; !found && tries < 2; tries++) {
        he_warnings_add(warnings,
                        &(he_occurrence){.code = "not_apart",
                                         .text = "faces are not separated by % for other programs, "
                                                 "because there would be more than 4096 primitives",
                                         .subject = told[tries],
                                         .length = strlen(told[tries])});
        g->names[HE_GLB_OBJECT] = g->names[HE_GLB_GROUP] = NULL;
        g->names[HE_GLB_MATERIAL] = tries > 0 ? NULL : g->names[HE_GLB_MATERIAL];
        found = find_groups(f);
    }
    he_status status = list_names(f->mesh, g, err);
    if (status != HE_OK || g->count < 2) {
        return status;
    }
    uint32_t *rank = he_mem_array(NULL, g->count, sizeof *rank);
    status = rank == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory for groups of faces")
                          : sort_groups(g, rank, err);
    if (status == HE_OK) {
        status = order_faces(f, rank, err);
    }
    he_mem_free(rank);
    return status;
}

he_status he_glb_groups_make(const he_mesh *mesh, he_warnings *warnings, he_glb_groups *out,
                             he_error *err)
{
    he_glb_groups made = {.list = he_mem_array(NULL, HE_GLB_PRIMITIVES, sizeof *made.list)};
    finding f = {.mesh = mesh, .groups = &made};
    f.of = he_mem_array(NULL, mesh->c.faces.issued, sizeof *f.of);
    f.slots = he_mem_array(NULL, SLOTS, sizeof *f.slots);
    he_status status = made.list == NULL || f.of == NULL || f.slots == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory for groups of faces")
                           : make(&f, warnings, err);
    he_mem_free(f.of);
    he_mem_free(f.slots);
    if (status != HE_OK) {
        he_glb_groups_clear(&made);
        return status;
    }
    *out = made;
    return HE_OK;
}
