/* delta.h - a delta records what an edit wrote to a mesh, in the order in which it was written.
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
    /* Records from here to HE_COL_REPLACED are not about words of a column. */
    HE_COL_PARENT,       /* row = child, before = parent, word = kind */
    HE_COL_MERGED,       /* row = the deleted one, before = the one it merged into, word = kind */
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

/* The records of an edit. All code may read the fields; only write.h, delta.c and core/stored write
 * them. */
struct he_delta {
    he_record *records;
    size_t count, capacity;
    void *
        *objects; /* he_column, he_material or he_content, depending on the record that names it */
    size_t object_count, object_capacity;
};

/* Returns true if the record names an object of its delta: a column, a material or a content. */
static inline bool he_has_object(const he_record *r)
{
    return r->column >= HE_COL_COLUMN_ADDED && r->column < HE_COL_ATTRIBUTE;
}

/* A point of a recording to which he_delta_rollback can return. */
typedef struct he_savepoint {
    size_t records, objects;
    uint32_t issued[HE_KIND_COUNT];
} he_savepoint;

he_delta *he_delta_new(void); /* empty; NULL if memory is out */
/* Makes room in a delta for this many more records and objects. */
HE_NODISCARD he_status he_delta_reserve(he_delta *delta, size_t records, size_t objects,
                                        he_error *err);
void he_delta_free(he_delta *delta);
/* Removes the records of a delta but keeps the memory. */
void he_delta_empty(he_delta *delta);
/* Returns the memory of a delta: the capacity of its records, but only the rows (not the capacity)
 * of its columns and contents, so that a delta read back from storage counts as much as before. */
size_t he_delta_bytes(const he_delta *delta);
/* Frees the capacity of a delta beyond its records; if memory is out, the capacity stays. */
void he_delta_trim(he_delta *delta);

/* Folds the records from `from` on into one for each word, from its value before the first to its
 * value after the last; lineage records stay. Edits that write a word many times use it, so that
 * their delta is no longer than what they touched. Requires that no savepoint after `from` is
 * rolled back to, and that no column or content was replaced since.
 * Returns HE_NO_MEMORY if memory is out; the records are as they were.
 * Returns HE_CANCELLED if the work was cancelled; some records are folded, and undo and redo
 * still lead to equal states. */
HE_NODISCARD he_status he_delta_fold(he_delta *delta, size_t from, he_progress *progress,
                                     he_error *err);

/* Records all writes to `mesh` in `delta` from here on; NULL ends the recording. Returns the delta
 * that recorded before, or NULL. */
he_delta *he_mesh_record(he_mesh *mesh, he_delta *delta);

/* Undo and redo change `mesh` without recording. The mesh must be in the state after (undo) or
 * before (redo) the delta. */
void he_delta_undo(he_delta *delta, he_mesh *mesh);
void he_delta_redo(he_delta *delta, he_mesh *mesh);

/* Applies a delta forwards to a mesh that has not issued the delta's rows, such as one just loaded.
 * The delta must hold the objects its edit brought in (columns, a content), as after an undo;
 * afterwards it holds those the edit took out, the mesh has the high-water marks `issued`, indexed
 * by kind, and undo and redo work as usual. On failure the mesh is as it was.
 * Returns HE_CORRUPT if the mesh is not in the state the edit was made on; *refused, which may be
 * NULL, is then the index of the first record that differs.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_forward(he_delta *delta, he_mesh *mesh,
                                        const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                        he_error *err);

/* The caller must call this before it undoes or redoes a delta that replaced the content. It
 * issues, as dead ids in the stored content, the ids that `mesh` has issued meanwhile, so that they
 * are never issued again. Without it the high-water marks would fall back.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delta_ready(he_delta *delta, const he_mesh *mesh, he_error *err);

/* Frees an object of a record of this column; NULL is allowed. Only core/mesh calls this. */
void he_object_free(uint32_t column, void *object);
/* Returns the memory of an object that a record of this column names. */
size_t he_object_bytes(uint32_t column, const void *object);

/* Issues dead rows up to the high-water marks, indexed by kind; marks below the present ones change
 * nothing. A replay uses it for ids that were issued and deleted before its starting point.
 * Returns HE_NO_MEMORY if memory is out; some of the rows may then be issued. */
HE_NODISCARD he_status he_mesh_issue(he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT],
                                     he_error *err);

/* Returns the present point of the recording. The mesh must be recording. */
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
    bool replaced;   /* the whole content was replaced; the sets are empty */
    bool renumbered; /* replaced, and ids mean other elements than before */
    /* There are changes that no set shows: a column or material came or went, or a value of the
     * mesh, or a link or value of a boundary half-edge, differs. When a column with labels comes,
     * goes or replaces another of its name, `modified` has the elements whose label differs from
     * before; an element without a column counts as having the default. */
    bool others;
} he_changes;

/* Finds the net changes of the records `from`..`to` of `delta`, with `mesh` in the state after
 * `to`. With `undone`, `mesh` is in the state before `from`, and created and deleted are what the
 * undo did. The lists of HE_HALFEDGE stay empty: half-edges change with their edges. */
HE_NODISCARD he_status he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from,
                                       size_t to, bool undone, he_changes *out, he_error *err);
/* Finds the net changes of several deltas, or of parts of them, in the order in which they were
 * applied, with `mesh` in the state after the last: changes that cancel out are not listed. */
typedef struct he_change_part {
    const he_delta *delta;
    size_t from, to;
    bool undone;
} he_change_part;
HE_NODISCARD he_status he_changes_sum(const he_mesh *mesh, const he_change_part *parts,
                                      size_t count, he_changes *out, he_error *err);
void he_changes_clear(he_changes *changes);
/* Returns true if nothing is changed. The store then makes no revision. */
bool he_changes_none(const he_changes *changes);

#endif
