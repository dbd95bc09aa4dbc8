/* glb_groups.h - faces by what a GLB tells apart: a mesh for each object and group, in it a
 * primitive for each material.
 *
 * Primitives share all vertices; their triangles lie one after another. So faces are written in the
 * order of groups, and in that of their ids in each. */
#ifndef HE_FORMAT_GLTF_GLB_GROUPS_H
#define HE_FORMAT_GLTF_GLB_GROUPS_H

#include "format/io/cuts.h"
#include "format/text/notes.h"
#include "mesh/layout.h"

/* Primitives that a file has at most: where there would be more, objects and groups are not told
 * apart, then materials, with a note. */
enum { HE_GLB_PRIMITIVES = 4096 };

enum { HE_GLB_OBJECT, HE_GLB_GROUP, HE_GLB_MATERIAL, HE_GLB_NAMES };

typedef struct he_glb_group {
    uint32_t label[HE_GLB_NAMES]; /* of its faces; of a name that is not told apart 0 */
    uint64_t first, triangles;    /* in the file's order */
} he_glb_group;

/* {0} is empty. */
typedef struct he_glb_groups {
    const he_column *names[HE_GLB_NAMES]; /* face attributes with labels; NULL: not told apart */
    he_glb_group *list;
    size_t count;
    uint32_t *order;   /* live faces as they are written, NULL where that is the order of ids */
    size_t *cut;       /* of each face, where its triangles begin in the corners of cuts */
    he_ids only_names; /* labels of materials that are not in the table */
} he_glb_groups;

/* HE_NO_MEMORY. */
HE_NODISCARD he_status he_glb_groups_make(const he_mesh *mesh, he_notes *notes, he_glb_groups *out,
                                          he_error *err);
void he_glb_groups_clear(he_glb_groups *groups);
/* The name that a group's faces have, "" for none. */
const char *he_glb_name(const he_glb_groups *groups, const he_glb_group *group, size_t which);
/* The number of a group's material among those of the file: rows of the table, then names that are
 * not in it. HE_NONE for none. */
uint32_t he_glb_material(const he_mesh *mesh, const he_glb_groups *groups,
                         const he_glb_group *group);

#endif
