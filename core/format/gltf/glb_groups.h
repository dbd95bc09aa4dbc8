/* glb_groups.h - groups the faces of a mesh by their attributes object, group and material. A GLB
 * file has a glTF mesh for each pair of object and group, and in this mesh a primitive for each
 * material.
 *
 * All primitives share the same vertices; their triangles are stored one primitive after another.
 * So faces are written in the order of these groups, and inside each group in the order of their
 * ids. */
#ifndef HE_FORMAT_GLTF_GLB_GROUPS_H
#define HE_FORMAT_GLTF_GLB_GROUPS_H

#include "format/io/export_triangles.h"
#include "format/text/warnings.h"
#include "mesh/layout.h"

/* The most primitives that a file may have. If there would be more, faces are not separated by
 * object and group; if there still are too many, not by material either. A warning says so. */
enum { HE_GLB_PRIMITIVES = 4096 };

enum { HE_GLB_OBJECT, HE_GLB_GROUP, HE_GLB_MATERIAL, HE_GLB_NAMES };

typedef struct he_glb_group {
    /* The labels (numbers that stand for names) that the group's faces have in the attributes
     * object, group and material; 0 for an attribute by which faces are not separated. */
    uint32_t label[HE_GLB_NAMES];
    uint64_t first, triangles; /* `first` is the index of the group's first triangle in the file,
                                  `triangles` is their number */
} he_glb_group;

/* {0} is empty. */
typedef struct he_glb_groups {
    const he_column *names[HE_GLB_NAMES]; /* the attributes object, group and material; NULL for an
                                             attribute by which faces are not separated */
    he_glb_group *list;
    size_t count;
    uint32_t *order; /* live faces in the order in which they are written, NULL if that is the order
                        of ids */
    /* index in he_export_triangles.corners at which the triangles of each face begin */
    size_t *cut;
    /* Labels of those materials of faces that are not in the mesh's table of materials. */
    he_ids only_names;
} he_glb_groups;

/* Groups the faces of a mesh by object, group and material.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_glb_groups_make(const he_mesh *mesh, he_warnings *warnings,
                                          he_glb_groups *out, he_error *err);
void he_glb_groups_clear(he_glb_groups *groups);
/* Returns the name that the faces of a group have in the attribute `which`, such as
 * HE_GLB_OBJECT; "" if they have no name in that attribute. */
const char *he_glb_name(const he_glb_groups *groups, const he_glb_group *group, size_t which);
/* Returns the number of a group's material in the file; HE_NONE if the group has no material. The
 * file numbers first the materials of the mesh's table, then the material names that are not in the
 * table. */
uint32_t he_glb_material(const he_mesh *mesh, const he_glb_groups *groups,
                         const he_glb_group *group);

#endif
