#include "mesh/replay.h"

#include "mesh/content.h"
#include "mesh/long_faces.h"

#include <assert.h>
#include <string.h>

/* Attribute columns, materials or whole mesh data (objects) that the copy of a mesh exchanges each
 * time it crosses one delta, that is, undoes or redoes one edit. Before the crossing, the list has
 * the objects that the crossing will put into the copy; afterwards, the objects that it took out of
 * the copy. The objects are in the order of the delta's array `objects`. */
typedef struct other_side {
    uint64_t key;
    void **objects;
    uint32_t *columns; /* for each object, the member `column` of the record that names it */
    size_t count;
    struct other_side *next;
} other_side;

struct he_replay {
    he_mesh *mesh;
    other_side *sides;
};

static void free_side(other_side *side)
{
    for (size_t i = 0; i < side->count; i++) {
        he_object_free(side->columns[i], side->objects[i]);
    }
    he_mem_free(side->objects);
    he_mem_free(side->columns);
    he_mem_free(side);
}

he_status he_replay_new(const he_mesh *mesh, he_replay **out, he_error *err)
{
    he_replay *replay = he_mem_zero(1, sizeof *replay);
    if (replay == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a copy of the mesh");
    }
    he_status status = he_mesh_copy(mesh, &replay->mesh, err);
    if (status == HE_OK) {
        status = he_long_faces_allow(replay->mesh, err);
    }
    if (status != HE_OK) {
        he_replay_free(replay);
        return status;
    }
    *out = replay;
    return HE_OK;
}

void he_replay_free(he_replay *replay)
{
    if (replay == NULL) {
        return;
    }
    while (replay->sides != NULL) {
        other_side *side = replay->sides;
        replay->sides = side->next;
        free_side(side);
    }
    he_mesh_free(replay->mesh);
    he_mem_free(replay);
}

const he_mesh *he_replay_mesh(const he_replay *replay)
{
    return replay->mesh;
}

size_t he_replay_bytes(const he_replay *replay)
{
    size_t bytes = sizeof *replay + he_mesh_bytes(replay->mesh) + he_long_faces_bytes(replay->mesh);
    for (const other_side *side = replay->sides; side != NULL; side = side->next) {
        bytes += sizeof *side + side->count * (sizeof *side->objects + sizeof *side->columns);
        for (size_t i = 0; i < side->count; i++) {
            bytes += he_object_bytes(side->columns[i], side->objects[i]);
        }
    }
    return bytes;
}

static he_status copy_object(void *object, uint32_t of, void **out, he_error *err)
{
    if (object == NULL) {
        return HE_OK;
    }
    if (of == HE_COL_MATERIAL) {
        *out = he_material_retain(object);
        return HE_OK;
    }
    if (of != HE_COL_REPLACED) {
        he_column *column = NULL;
        he_status status = he_column_copy(object, &column, err);
        *out = column;
        return status;
    }
    he_content *copy = he_mem_zero(1, sizeof *copy);
    if (copy == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for a copy of the mesh that an edit replaced");
    }
    *out = copy;
    return he_content_copy(object, NULL, copy, err);
}

/* Makes a list for `count` objects (attribute columns, materials or whole mesh data), whose entries
 * are NULL at first. Returns NULL if memory is out. */
static other_side *side_new(uint64_t key, size_t count)
{
    other_side *side = he_mem_alloc(sizeof *side);
    void **objects = he_mem_zero(count, sizeof *objects);
    uint32_t *columns = he_mem_zero(count, sizeof *columns);
    if (side == NULL || objects == NULL || columns == NULL) {
        he_mem_free(side);
        he_mem_free(objects);
        he_mem_free(columns);
        return NULL;
    }
    *side = (other_side){key, objects, columns, count, NULL};
    return side;
}

/* Makes a list of copies of the objects (attribute columns, materials or whole mesh data) that a
 * delta owns. */
static he_status side_of(const he_delta *delta, uint64_t key, other_side **out, he_error *err)
{
    other_side *side = side_new(key, delta->object_count);
    if (side == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for copies of the attributes and materials of an edit");
    }
    for (size_t i = 0; i < delta->count; i++) {
        const he_record *r = &delta->records[i];
        if (he_has_object(r)) {
            side->columns[r->before] = r->column;
        }
    }
    he_status status = HE_OK;
    for (size_t i = 0; i < side->count && status == HE_OK; i++) {
        status = copy_object(delta->objects[i], side->columns[i], &side->objects[i], err);
    }
    if (status != HE_OK) {
        free_side(side);
        return status;
    }
    *out = side;
    return HE_OK;
}

static other_side *find_side(const he_replay *replay, uint64_t key)
{
    other_side *side = replay->sides;
    while (side != NULL && side->key != key) {
        side = side->next;
    }
    return side;
}

/* Finds the objects (attribute columns, materials or whole mesh data) that crossing a delta will
 * put into the copy of the mesh. *objects becomes NULL if the delta names no objects. */
static he_status require_side(he_replay *replay, const he_crossing *crossing, void ***objects,
                              he_error *err)
{
    *objects = NULL;
    if (crossing->delta->object_count == 0) {
        return HE_OK;
    }
    other_side *side = find_side(replay, crossing->key);
    if (side == NULL && !crossing->held) {
        return he_fail_plain(
            err, HE_UNSUPPORTED,
            "the stored edit lacks attributes or mesh data that are needed to undo or redo it");
    }
    if (side == NULL) {
        he_status status = side_of(crossing->delta, crossing->key, &side, err);
        if (status != HE_OK) {
            return status;
        }
        side->next = replay->sides;
        replay->sides = side;
    }
    *objects = side->objects;
    return HE_OK;
}

/* Undoes a delta (the log of an edit) in the data of the copy. If the edit replaced all mesh data,
 * the undo puts back the old data, in which only the ids are issued that were issued when they were
 * replaced. Ids are then issued or withdrawn until as many are issued as crossing->issued says. */
static he_status back(he_content *c, const he_crossing *crossing, void **objects, he_error *err)
{
    he_content_apply(c, crossing->delta, crossing->delta->count, 0, objects);
    he_status status = he_content_issue(c, crossing->issued, err);
    if (status == HE_OK) {
        he_content_withdraw(c, crossing->issued);
    }
    return status;
}

he_status he_replay_cross(he_replay *replay, const he_crossing *crossing, he_error *err)
{
    he_content *c = &replay->mesh->c;
    void **objects;
    he_long_faces_forget(replay->mesh);
    he_status status = require_side(replay, crossing, &objects, err);
    if (status != HE_OK) {
        return status;
    }
    status = crossing->undo
                 ? back(c, crossing, objects, err)
                 : he_content_forward(c, crossing->delta, objects, crossing->issued, NULL, err);
    /* HE_CORRUPT cannot occur, because the copy is in the state from which the delta's
     * edit began. */
    assert(status != HE_CORRUPT);
    return status;
}

void he_replay_take_positions(he_replay *replay, const he_mesh *mesh)
{
    const uint32_t vertices = he_mesh_issued(mesh, HE_VERTEX);
    assert(he_mesh_issued(replay->mesh, HE_VERTEX) == vertices && vertices > 0);
    he_long_faces_forget(replay->mesh);
    memcpy(replay->mesh->c.position, mesh->c.position, vertices * sizeof *mesh->c.position);
}
