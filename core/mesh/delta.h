/* delta.h - what an edit wrote, in the order it wrote it.
 *
 * A delta is a list of records of 16 bytes. Most say that one 32-bit word of one row of one column
 * changed from `before` to `after`: every column, links and doubles alike, is seen as rows of
 * words. Others say that a column was added or dropped, a material put in the place of another or
 * of none, or that the whole content was replaced; those point at an object the delta owns and hold
 * the other side of the change. Lineage records (this element came from that one, this one merged
 * into that one) change nothing.
 *
 * Applied backwards a delta undoes its edit, applied forwards it does it again, bit for bit. Rows
 * it issued stay issued when it is undone: they are dead then, and only redoing it revives them.
 * he_delta_rollback is the exception, for edits that were never published: it takes the issued
 * rows back too. None of the three can fail.
 *
 * A dead row holds dead values in every column, so a delta carries everything needed to revive a
 * row. Its size is proportional to the edit. */
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
    /* not words of a column */
    HE_COL_PARENT,       /* row = child, before = parent, word = kind */
    HE_COL_MERGED,       /* row = the one gone, before = the one it became part of, word = kind */
    HE_COL_COLUMN_ADDED, /* row = slot, before = object */
    HE_COL_COLUMN_DROPPED,
    HE_COL_MATERIAL, /* row = slot, before = object, after = mark of the row before the edit, or 0
                      */
    HE_COL_REPLACED, /* before = object: the content of the other side; row = 1 where ids changed
                        their meaning */
    HE_COL_ATTRIBUTE
} he_col;

typedef struct he_record {
    uint32_t column : 24, word : 8;
    uint32_t row;
    uint32_t before, after;
} he_record;

/* Open for reading; only write.h, delta.c and core/stored write it. */
struct he_delta {
    he_record *records;
    size_t count, capacity;
    void **objects; /* he_column, he_material or he_content, by the record that names it */
    size_t object_count, object_capacity;
};

/* Does the record name an object of its delta? */
static inline bool he_has_object(const he_record *r)
{
    return r->column >= HE_COL_COLUMN_ADDED && r->column < HE_COL_ATTRIBUTE;
}

/* A point inside a recording to which he_delta_rollback can return. */
typedef struct he_savepoint {
    size_t records, objects;
    uint32_t issued[HE_KIND_COUNT];
} he_savepoint;

he_delta *he_delta_new(void); /* empty; NULL when memory is out */
/* Make room for this many more. */
HE_NODISCARD he_status he_delta_reserve(he_delta *delta, size_t records, size_t objects,
                                        he_error *err);
void he_delta_free(he_delta *delta);
/* Forget the records but keep the memory. */
void he_delta_empty(he_delta *delta);
/* What it takes: the room for its records, and of columns and contents the rows, so that a delta
 * that was read from its bytes takes what it took before. */
size_t he_delta_bytes(const he_delta *delta);
/* Give back what capacity holds beyond the records; keeps it when memory is out. */
void he_delta_trim(he_delta *delta);

/* Keep of the records from `from` on one for each word, from what it was before the first to what
 * it became by the last; notes of lineage stay. For edits that write the same words many times:
 * the delta is then no longer than what they touched. No savepoint after `from` may be gone back
 * to, and no column or content was replaced since. HE_NO_MEMORY leaves the records as they are;
 * HE_CANCELLED leaves some of them folded, which lead to the same states. */
HE_NODISCARD he_status he_delta_fold(he_delta *delta, size_t from, he_watch *watch, he_error *err);

/* Record all writes to `mesh` in `delta` from here on; NULL stops. Returns what was there. */
he_delta *he_mesh_record(he_mesh *mesh, he_delta *delta);

/* These change `mesh` without recording. `delta` must be the one that leads to (undo) or from
 * (redo) the present state. */
void he_delta_undo(he_delta *delta, he_mesh *mesh);
void he_delta_redo(he_delta *delta, he_mesh *mesh);

/* Bring a mesh forward over a delta that was made on a mesh like it: one that was loaded, say, and
 * has not issued the rows of the delta. The delta holds what its edit brought in (columns, a
 * content), as one that was undone does; afterwards it holds what the edit took out, the mesh has
 * the high-water marks `issued`, indexed by kind, and undo and redo go on from there. HE_CORRUPT
 * when the mesh is not what the edit was made on; *refused, which may be NULL, is then the index of
 * the first record that shows it. HE_NO_MEMORY. After either the mesh is as it was. */
HE_NODISCARD he_status he_delta_forward(he_delta *delta, he_mesh *mesh,
                                        const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                        he_error *err);

/* Before undoing or redoing a delta that replaced the content: give the other side the ids that
 * `mesh` has issued meanwhile, as dead ones, so that they are not issued again. Without, the ids
 * are as far as they were. HE_NO_MEMORY. */
HE_NODISCARD he_status he_delta_ready(he_delta *delta, const he_mesh *mesh, he_error *err);

/* Release an object of a record of this column; NULL is allowed. For core/mesh. */
void he_object_free(uint32_t column, void *object);
/* What one costs. */
size_t he_object_bytes(uint32_t column, const void *object);

/* Issue dead rows up to the high-water marks, indexed by kind; lower ones change nothing. For what
 * is known to have been issued on the mesh's way. After HE_NO_MEMORY some may be. */
HE_NODISCARD he_status he_mesh_issue(he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT],
                                     he_error *err);

/* Only while recording. */
he_savepoint he_delta_mark(const he_mesh *mesh);
void he_delta_rollback(he_mesh *mesh, he_savepoint to);

/* The net effect of records on elements, each list sorted and without repeats. An element is
 * modified when it lives before and after and a published link or value of it differs: a vertex's
 * position, attributes or stored half-edge; an edge's ends, faces or attributes; a face's corners,
 * stored half-edge, corner or own attributes. `parents` holds pairs child, parent and `merged`
 * pairs gone, into, in the order the edit noted them, less those whose child (or gone one) is not
 * in created (deleted). */
typedef struct he_changes {
    he_ids created[HE_KIND_COUNT], deleted[HE_KIND_COUNT], modified[HE_KIND_COUNT];
    he_ids parents[HE_KIND_COUNT], merged[HE_KIND_COUNT];
    bool replaced;   /* the content as a whole: the sets are empty */
    bool renumbered; /* and ids mean other elements than before */
    bool others; /* what no set shows: a column or material came or went, or a value of the mesh,
                    or a link or value of a half-edge that runs along a hole, differs. Where a
                    column with labels came or went, or took the place of another of its name,
                    elements are modified whose label says something else than before; where there
                    was or is none, than the default */
} he_changes;

/* Records `from`..`to` of `delta`, with `mesh` in the state after `to`, or, when `undone`, before
 * `from`: then created and deleted are what undoing them did. HE_HALFEDGE lists stay empty:
 * half-edges follow their edges. */
HE_NODISCARD he_status he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from,
                                       size_t to, bool undone, he_changes *out, he_error *err);
/* The same of several deltas, or parts of them, in the order in which they were applied, with
 * `mesh` in the state after the last: what is done by one and undone by another does not show. */
typedef struct he_change_part {
    const he_delta *delta;
    size_t from, to;
    bool undone;
} he_change_part;
HE_NODISCARD he_status he_changes_sum(const he_mesh *mesh, const he_change_part *parts,
                                      size_t count, he_changes *out, he_error *err);
void he_changes_clear(he_changes *changes);
/* Nothing at all happened? Then no revision is made. */
bool he_changes_none(const he_changes *changes);

#endif
