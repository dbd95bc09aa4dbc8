/* delta.h - a delta is the log of an edit: it records everything that the edit wrote to a mesh, in
 * the order in which it was written.
 *
 * A delta is a list of records of 16 bytes. Most records say that one 32-bit word in the entry
 * (row) of one element in one array (column) of the mesh changed from `before` to `after`. Links,
 * positions and attribute values are all taken as arrays of such words. Other records say that an
 * attribute column was added or dropped, that a material was set, replaced or removed, that all
 * positions were written at once, or that the whole content (all arrays of the mesh, he_content)
 * was replaced. Such a record names an object: the column, material, positions or content. The
 * delta owns the object if it is not in the mesh: after an edit or a redo the delta owns the old
 * object, after an undo the new one. Lineage records (this element came from that one, this one was
 * merged into that one) change nothing in the mesh.
 *
 * Applied backwards, a delta undoes its edit; applied forwards, it does the edit again, bit for
 * bit. The ids of elements that an edit has made stay issued when the edit is undone: the elements
 * are then deleted, and only a redo revives them. he_delta_rollback, which is for edits that were
 * never published, withdraws these ids, too. Undo, redo and rollback cannot fail.
 *
 * Deleting an element overwrites its entry in all arrays, so the delta of the edit has all values
 * that are needed to revive the element. The size of a delta is proportional to the size of the
 * edit. */
#ifndef HE_MESH_DELTA_H
#define HE_MESH_DELTA_H

#include "mesh/mesh.h"

/* What a record is about: an array of the mesh, or something else. The array of attribute column i
 * has the number HE_COL_ATTRIBUTE + i. */
typedef enum he_col {
    HE_COL_NEXT,
    HE_COL_PREV,
    HE_COL_ORIGIN,
    HE_COL_FACE,
    HE_COL_VERTEX_HALFEDGE,
    HE_COL_FACE_HALFEDGE,
    HE_COL_POSITION,
    /* The constants from here to HE_COL_REPLACED name no arrays. A record with such a constant does
     * not say that a word changed. */
    /* `row` is the id of a new element, `before` the id of its parent (the element it came from),
     * `word` their kind */
    HE_COL_PARENT,
    /* `row` is the id of a deleted element, `before` the id of the element it was merged into,
     * `word` their kind */
    HE_COL_MERGED,
    /* `row` is the index of the column in the mesh, `before` the column's index in `objects` */
    HE_COL_COLUMN_ADDED,
    HE_COL_COLUMN_DROPPED,
    /* `row` is the index of the material in the mesh's table, `before` the material's index in
     * `objects`, `after` the `mark` (hash) of the material that was there before the edit, 0 if
     * there was none */
    HE_COL_MATERIAL,
    /* `row` is the number of vertices, which are those with the first ids; `before` is the index in
     * `objects` of a column with their other positions, which undo and redo exchange with those in
     * the mesh */
    HE_COL_POSITIONS,
    /* `before` is the index in `objects` of the replaced content (all data of the mesh); `row` is 1
     * if ids name other elements after the replacement than before it, else 0 */
    HE_COL_REPLACED,
    HE_COL_ATTRIBUTE
} he_col;

typedef struct he_record {
    uint32_t column : 24, word : 8;
    uint32_t row;
    uint32_t before, after;
} he_record;

/* The records of an edit. All code may read the members; only write.h, delta.c and core/stored
 * write to them. */
struct he_delta {
    he_record *records;
    size_t count, capacity;
    /* Columns, materials, positions and contents; the record that names an object says what it is.
     */
    void **objects;
    size_t object_count, object_capacity;
};

/* Returns true if the record names an object (column, material, positions or content) of its
 * delta. */
static inline bool he_has_object(const he_record *r)
{
    return r->column >= HE_COL_COLUMN_ADDED && r->column < HE_COL_ATTRIBUTE;
}

/* A point in the recording of a delta to which he_delta_rollback can return: the numbers of
 * records, of objects and of issued ids at that point. */
typedef struct he_savepoint {
    size_t records, objects;
    uint32_t issued[HE_KIND_COUNT];
} he_savepoint;

he_delta *he_delta_new(void); /* makes an empty delta; returns NULL if memory is out */
/* Allocates memory in a delta for `records` more records and `objects` more objects. */
HE_NODISCARD he_status he_delta_reserve(he_delta *delta, size_t records, size_t objects,
                                        he_error *err);
void he_delta_free(he_delta *delta);
/* Removes all records of a delta, but keeps the memory for later records. */
void he_delta_empty(he_delta *delta);
/* Returns the size of a delta in bytes. The spare capacity of its array of records counts, but the
 * spare capacity of its columns and contents does not, so that a delta that is read back from
 * storage counts as much as before it was stored. */
size_t he_delta_bytes(const he_delta *delta);
/* Frees the spare memory of a delta's array of records. */
void he_delta_trim(he_delta *delta);

/* Combines the records of a delta from record `from` on: all records of one word become one record,
 * with the `before` of the first and the `after` of the last. Lineage records stay. Edits that
 * write a word many times call this function, so that the delta has no more records than words that
 * changed. The caller must not roll back to a savepoint after `from`, and no column or content may
 * have been replaced, and not all positions written at once, since `from`.
 * Returns HE_NO_MEMORY if memory is out; the records are as they were.
 * Returns HE_CANCELLED if the work was cancelled; some records are then combined, and undo and redo
 * still lead to equal states. */
HE_NODISCARD he_status he_delta_fold(he_delta *delta, size_t from, he_progress *progress,
                                     he_error *err);

/* Starts recording: from this call on, all writes to `mesh` are recorded in `delta`. If `delta` is
 * NULL, ends the recording. Returns the delta that was recording before, or NULL. */
he_delta *he_mesh_record(he_mesh *mesh, he_delta *delta);

/* These functions undo and redo the edit of a delta, without recording. For he_delta_undo the mesh
 * must be in the state after the edit, for he_delta_redo in the state before the edit. */
void he_delta_undo(he_delta *delta, he_mesh *mesh);
void he_delta_redo(he_delta *delta, he_mesh *mesh);

/* Applies a delta forwards to a mesh in which the ids of the edit's new elements are not issued,
 * such as a mesh just loaded. The delta must own the objects (columns, materials, a content) that
 * its edit put into the mesh, as after an undo. Afterwards the delta owns the objects that the edit
 * took out of the mesh, the mesh has issued as many ids of each kind as `issued` says, and undo and
 * redo work as usual. On failure the mesh is as it was.
 * Returns HE_CORRUPT if the mesh is not in the state from which the edit began; *refused, if
 * `refused` is not NULL, is then the index of the first record that does not fit.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_forward(he_delta *delta, he_mesh *mesh,
                                        const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                        he_error *err);

/* Prepares an undo or redo of a delta that replaced the content (all data of the mesh). The caller
 * must call this function before he_delta_undo and he_delta_redo. It adds deleted elements to the
 * content that the delta owns, one for each id that `mesh` has issued since the replacement.
 * Otherwise these ids would be issued a second time.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_ready(he_delta *delta, const he_mesh *mesh, he_error *err);

/* Frees an object (column, material or content) that is named by a record with this `column`.
 * `object` may be NULL. Only core/mesh calls this function. */
void he_object_free(uint32_t column, void *object);
/* Returns the bytes of memory of an object (column, material or content) that is named by a record
 * with this `column`. */
size_t he_object_bytes(uint32_t column, const void *object);

/* Issues ids of deleted elements until `mesh` has issued as many ids of each kind as `issued` says;
 * if it has issued more, nothing changes. A replay needs this for ids that were issued and deleted
 * before the revision at which the replay starts.
 * Returns HE_NO_MEMORY if memory is out; some of the ids may then be issued. */
HE_NODISCARD he_status he_mesh_issue(he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT],
                                     he_error *err);

/* Returns a savepoint: the present end of the delta that is recording, to which he_delta_rollback
 * can return. The mesh must be recording. */
he_savepoint he_delta_mark(const he_mesh *mesh);
void he_delta_rollback(he_mesh *mesh, he_savepoint to);

/* The net effect of edits on elements. Each list of ids is sorted and has no repeats. An element is
 * modified if it exists before and after the edits and one of its published links or values
 * differs: a vertex's position, attributes or stored half-edge; an edge's ends, faces or
 * attributes; a face's corners, stored half-edge, attributes or attributes of corners. `parents`
 * has pairs (new element, element it came from), and `merged` has pairs (deleted element, element
 * it was merged into), in the order in which the edits recorded them. A pair is left out if its
 * first element is not in the list `created` (for `parents`) or `deleted` (for `merged`). */
typedef struct he_changes {
    he_ids created[HE_KIND_COUNT], deleted[HE_KIND_COUNT], modified[HE_KIND_COUNT];
    he_ids parents[HE_KIND_COUNT], merged[HE_KIND_COUNT];
    bool replaced; /* true if all data of the mesh were replaced; the lists are then empty */
    /* true if all data of the mesh were replaced, and ids name other elements than before */
    bool renumbered;
    /* True if there are changes that no list shows: a column or material was added or removed, or a
     * value of the mesh, or a link or value of a boundary half-edge, differs. If a column with
     * labels was added, removed, or replaced by another column with its name, `modified` has the
     * elements whose labels differ. Where the column does not exist, an element counts as having
     * the default label. */
    bool others;
} he_changes;

/* Finds the net changes that the records `from` to `to` - 1 of `delta` made, with `mesh` in the
 * state after record `to` - 1. If `undone` is true, the records were undone: `mesh` is in the state
 * before record `from`, and the changes are those that the undo made. The lists for HE_HALFEDGE
 * stay empty, because half-edges change with their edges. */
HE_NODISCARD he_status he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from,
                                       size_t to, bool undone, he_changes *out, he_error *err);
/* Records of a delta, from index `from` to `to` - 1, that were applied forwards or, if `undone` is
 * true, backwards. he_changes_sum finds the net changes of several such parts, in the order in
 * which they were applied, with `mesh` in the state after the last part. Changes that cancel each
 * other out are not listed. No two parts may have the same delta: he_changes_sum reads the objects
 * that a delta owns (columns, all positions), and these are now the objects that its last
 * application took out of the mesh, not those that an earlier one took out. */
typedef struct he_change_part {
    const he_delta *delta;
    size_t from, to;
    bool undone;
} he_change_part;
HE_NODISCARD he_status he_changes_sum(const he_mesh *mesh, const he_change_part *parts,
                                      size_t count, he_changes *out, he_error *err);
void he_changes_clear(he_changes *changes);
/* Returns true if there are no changes at all. The store then makes no new revision of the mesh. */
bool he_changes_none(const he_changes *changes);

#endif
