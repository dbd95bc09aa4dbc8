/* delta.h - a delta records what an edit wrote to a mesh, in the order in which it was written.
 *
 * A delta is a list of records of 16 bytes. Most say that one 32-bit word of one row of one column
 * changed from `before` to `after`: every column, links and doubles alike, is seen as rows of
 * words. Others say that a column was added or dropped, that a material was set, replaced or
 * removed, or that the whole content (he_content, all arrays of the mesh) was replaced. Such a
 * record names an object, which is a column, material or content. The delta owns the object that is
 * not in the mesh now: after the edit or a redo the old one, after an undo the new one. Lineage
 * records (this element came from that one, this one merged into that one) change nothing.
 *
 * Applied backwards a delta undoes its edit, applied forwards it does it again, bit for bit. Rows
 * of elements that the edit created stay issued when it is undone: the elements are deleted then,
 * and only a redo revives them. he_delta_rollback is the exception, for edits that were never
 * published: it removes these rows, too. Undo, redo and rollback cannot fail.
 *
 * Deleting an element overwrites its row in all columns, so a delta has all values that are needed
 * to revive the element. The size of a delta is proportional to the edit. */
#ifndef HE_MESH_DELTA_H
#define HE_MESH_DELTA_H

#include "mesh/mesh.h"

/* The columns a record can name. Attribute column i is HE_COL_ATTRIBUTE + i. */
typedef enum he_col {
    HE_COL_NEXT,
    HE_COL_PREV,
    HE_COL_ORIGIN,
    HE_COL_FACE,
    HE_COL_VERTEX_HALFEDGE,
    HE_COL_FACE_HALFEDGE,
    HE_COL_POSITION,
    /* The constants from here to HE_COL_REPLACED name no columns: records with them say something
     * other than that a word changed. */
    /* `row` is the new element, `before` its parent (the element it came from), `word` their
     * kind */
    HE_COL_PARENT,
    /* `row` is the deleted element, `before` the element it was merged into, `word` their kind */
    HE_COL_MERGED,
    /* `row` is the index of the column in the mesh, `before` its index in `objects` */
    HE_COL_COLUMN_ADDED,
    HE_COL_COLUMN_DROPPED,
    /* `row` is the index of the material in the mesh's table, `before` its index in `objects`,
     * `after` the `mark` (hash) of the material that was there before the edit, 0 if none was */
    HE_COL_MATERIAL,
    /* `before` is the index in `objects` of the content; `row` is 1 if ids name other elements than
     * before the replacement */
    HE_COL_REPLACED,
    HE_COL_ATTRIBUTE
} he_col;

typedef struct he_record {
    uint32_t column : 24, word : 8;
    uint32_t row;
    uint32_t before, after;
} he_record;

/* The records of an edit. All code may read the members; only write.h, delta.c and core/stored
 * write them. */
struct he_delta {
    he_record *records;
    size_t count, capacity;
    /* Each object is an he_column, he_material or he_content, depending on the record that names
     * it. */
    void **objects;
    size_t object_count, object_capacity;
};

/* Returns true if the record names an object of its delta (a column, material or content). */
static inline bool he_has_object(const he_record *r)
{
    return r->column >= HE_COL_COLUMN_ADDED && r->column < HE_COL_ATTRIBUTE;
}

/* A point of a recording to which he_delta_rollback can return. */
typedef struct he_savepoint {
    size_t records, objects;
    uint32_t issued[HE_KIND_COUNT];
} he_savepoint;

he_delta *he_delta_new(void); /* makes an empty delta; NULL if memory is out */
/* Allocates memory in a delta for `records` more records and `objects` more objects. */
HE_NODISCARD he_status he_delta_reserve(he_delta *delta, size_t records, size_t objects,
                                        he_error *err);
void he_delta_free(he_delta *delta);
/* Removes the records of a delta but keeps the memory. */
void he_delta_empty(he_delta *delta);
/* Returns the size of a delta in bytes. Spare capacity counts for its records, but not for its
 * columns and contents, so that a delta that is read back from storage counts as much as it did
 * before it was stored. */
size_t he_delta_bytes(const he_delta *delta);
/* Frees the capacity of a delta beyond its records; if memory is out, the capacity stays. */
void he_delta_trim(he_delta *delta);

/* Shortens the part of a delta from record `from` on: all records of one word become one record,
 * with the `before` of the first and the `after` of the last. Lineage records stay. Edits that
 * write a word many times use it, so that the delta has no more records than words that changed.
 * The caller must not roll back to a savepoint after `from`, and no column or content may have been
 * replaced since.
 * Returns HE_NO_MEMORY if memory is out; the records are as they were.
 * Returns HE_CANCELLED if the work was cancelled; some records are folded, and undo and redo
 * still lead to equal states. */
HE_NODISCARD he_status he_delta_fold(he_delta *delta, size_t from, he_progress *progress,
                                     he_error *err);

/* From this call on, all writes to `mesh` are recorded in `delta`; NULL ends the recording. Returns
 * the delta that was recording before, or NULL. */
he_delta *he_mesh_record(he_mesh *mesh, he_delta *delta);

/* These functions undo and redo a delta without recording. The mesh must be in the state after the
 * delta for an undo, before the delta for a redo. */
void he_delta_undo(he_delta *delta, he_mesh *mesh);
void he_delta_redo(he_delta *delta, he_mesh *mesh);

/* Applies a delta forwards to a mesh that has not issued the delta's rows, such as one just loaded.
 * The delta must own the objects (columns, materials, a content) that its edit put into the mesh,
 * as after an undo; afterwards it owns the objects that the edit took out of the mesh. Afterwards
 * the mesh has also issued as many rows of each kind as `issued` says, and undo and redo work as
 * usual. On failure the mesh is as it was.
 * Returns HE_CORRUPT if the mesh is not in the state the edit was made on; *refused, which may be
 * NULL, is then the index of the first record that differs.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_forward(he_delta *delta, he_mesh *mesh,
                                        const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                        he_error *err);

/* The caller must call this before it undoes or redoes a delta that replaced the content. It
 * extends the content that the delta owns by deleted elements, one for each id that `mesh` has
 * issued since the replacement. Otherwise these ids would be issued a second time.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_ready(he_delta *delta, const he_mesh *mesh, he_error *err);

/* Frees an object that a record with this `column` names; NULL is allowed. Only core/mesh calls
 * this. */
void he_object_free(uint32_t column, void *object);
/* Returns the bytes of memory of an object that a record with this `column` names. */
size_t he_object_bytes(uint32_t column, const void *object);

/* Issues dead rows (rows of deleted elements) until the mesh has issued as many as `issued` says
 * for each kind; if it has issued more, nothing changes. A replay needs this for ids that were
 * issued and deleted before the revision at which it starts.
 * Returns HE_NO_MEMORY if memory is out; some of the rows may then be issued. */
HE_NODISCARD he_status he_mesh_issue(he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT],
                                     he_error *err);

/* Returns the present end of the recorded delta, to which he_delta_rollback can return. The mesh
 * must be recording. */
he_savepoint he_delta_mark(const he_mesh *mesh);
void he_delta_rollback(he_mesh *mesh, he_savepoint to);

/* The net effect of records on elements. Each list is sorted and has no repeats. An element is
 * modified if it exists before and after the records and one of its published links or values
 * differs: a vertex's position, attributes or stored half-edge; an edge's ends, faces or
 * attributes; a face's corners, stored half-edge, attributes or attributes of corners. `parents`
 * has pairs (new element, element it came from), and `merged` has pairs (deleted element, element
 * it was merged into), in the order in which the edit recorded them. A pair is left out if its
 * first element is not in `created`, or not in `deleted`. */
typedef struct he_changes {
    he_ids created[HE_KIND_COUNT], deleted[HE_KIND_COUNT], modified[HE_KIND_COUNT];
    he_ids parents[HE_KIND_COUNT], merged[HE_KIND_COUNT];
    bool replaced; /* all data of the mesh were replaced; the lists are empty */
    /* all data of the mesh were replaced, and ids name other elements than before */
    bool renumbered;
    /* There are changes that no list shows: a column or material was added or removed, or a value
     * of the mesh, or a link or value of a boundary half-edge, differs. If a column with labels was
     * added, removed or replaced by another with its name, `modified` has the elements whose label
     * differs; where the column does not exist, an element counts as having the default label. */
    bool others;
} he_changes;

/* Finds the net changes of the records `from`..`to` of `delta`, with `mesh` in the state after
 * `to`. If `undone`, the records were undone: `mesh` is in the state before `from`, and the changes
 * are those that the undo made. The lists for HE_HALFEDGE stay empty, because half-edges change
 * with their edges. */
HE_NODISCARD he_status he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from,
                                       size_t to, bool undone, he_changes *out, he_error *err);
/* A part of a delta, which was applied forwards or backwards. he_changes_sum finds the net changes
 * of several parts, in the order in which they were applied, with `mesh` in the state after the
 * last one; changes that cancel each other out are not listed. */
typedef struct he_change_part {
    const he_delta *delta;
    size_t from, to;
    bool undone;
} he_change_part;
HE_NODISCARD he_status he_changes_sum(const he_mesh *mesh, const he_change_part *parts,
                                      size_t count, he_changes *out, he_error *err);
void he_changes_clear(he_changes *changes);
/* Returns true if there are no changes at all. The store then makes no revision. */
bool he_changes_none(const he_changes *changes);

#endif
