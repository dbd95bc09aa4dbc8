/* write.h - the one place through which a mesh is written. For core/ only.
 *
 * An edit runs in three parts:
 *     CHECK    every precondition; a refusal leaves through he_fail.
 *     RESERVE  he_reserve with everything the third part will use, records included.
 *     COMMIT   the functions below. They cannot fail.
 * Between he_new_* and the end of COMMIT every link of a new row must be set.
 *
 * An edit composed of others that may be refused half-way brackets them with he_edit_begin and
 * he_edit_end, which roll back. */
#ifndef HE_MESH_WRITE_H
#define HE_MESH_WRITE_H

#include "mesh/delta.h"
#include "mesh/walk.h"

#include <assert.h>
#include <string.h>

/* What COMMIT will use at most. `records` is beyond those for new rows, which are added here:
 * links, position and attributes of each. */
typedef struct he_need {
    uint32_t vertices, edges, faces;
    size_t deleted_vertices, deleted_edges, deleted_faces; /* rows that will die */
    size_t links;      /* link words written on rows that stay */
    size_t positions;  /* positions written on rows that stay */
    size_t attributes; /* attribute rows written on rows that stay (of every column) */
    size_t lineage;    /* parents and merges noted */
} he_need;

/* HE_NO_MEMORY or HE_IDS_EXHAUSTED leave the mesh as it was. */
HE_NODISCARD he_status he_reserve(he_mesh *m, he_need need, he_error *err);

/* Recording needs no branch prediction to be wrong: one test, one store of 16 bytes. */
static inline void he_record_word(he_mesh *m, uint32_t column, uint32_t word, uint32_t row,
                                  uint32_t before, uint32_t after)
{
    he_delta *d = m->delta;
    if (d == NULL) {
        return;
    }
    assert(d->count < d->capacity);
    d->records[d->count++] = (he_record){column & 0xFFFFFFu, word & 0xFFu, row, before, after};
}

static inline void he_set_next(he_mesh *m, he_halfedge h, he_halfedge next)
{
    he_record_word(m, HE_COL_NEXT, 0, h.i, m->c.next[h.i], next.i);
    m->c.next[h.i] = next.i;
}
static inline void he_set_prev(he_mesh *m, he_halfedge h, he_halfedge prev)
{
    he_record_word(m, HE_COL_PREV, 0, h.i, m->c.prev[h.i], prev.i);
    m->c.prev[h.i] = prev.i;
}
/* next(a) = b and prev(b) = a. */
static inline void he_link(he_mesh *m, he_halfedge a, he_halfedge b)
{
    he_set_next(m, a, b);
    he_set_prev(m, b, a);
}
static inline void he_set_origin(he_mesh *m, he_halfedge h, he_vertex v)
{
    he_record_word(m, HE_COL_ORIGIN, 0, h.i, m->c.origin[h.i], v.i);
    m->c.origin[h.i] = v.i;
}
static inline void he_set_face(he_mesh *m, he_halfedge h, he_face f)
{
    uint32_t before = m->c.face[h.i];
    he_record_word(m, HE_COL_FACE, 0, h.i, before, f.i);
    m->c.boundary_halfedges += (uint32_t)(f.i == HE_NONE) - (uint32_t)(before == HE_NONE);
    m->c.face[h.i] = f.i;
}
static inline void he_set_vertex_halfedge(he_mesh *m, he_vertex v, he_halfedge h)
{
    he_record_word(m, HE_COL_VERTEX_HALFEDGE, 0, v.i, m->c.vertex_halfedge[v.i], h.i);
    m->c.vertex_halfedge[v.i] = h.i;
}
static inline void he_set_face_halfedge(he_mesh *m, he_face f, he_halfedge h)
{
    he_record_word(m, HE_COL_FACE_HALFEDGE, 0, f.i, m->c.face_halfedge[f.i], h.i);
    m->c.face_halfedge[f.i] = h.i;
}
void he_set_position(he_mesh *m, he_vertex v, he_vec3 position);
/* Copy row_bytes from `value` into a row of attribute slot i. */
void he_set_attribute(he_mesh *m, size_t slot, uint32_t row, const void *value);

/* A new row: dead in every link column until the caller has written them, attributes at their
 * default. he_reserve has made room. */
he_vertex he_new_vertex(he_mesh *m);
he_edge he_new_edge(he_mesh *m);
he_face he_new_face(he_mesh *m);
/* Write the dead value everywhere in the row. Nobody may still link to it. */
void he_delete_vertex(he_mesh *m, he_vertex v);
void he_delete_edge(he_mesh *m, he_edge e);
void he_delete_face(he_mesh *m, he_face f);

/* Where an element came from, and what a deleted one became part of. Only noted while recording. */
static inline void he_note_parent(he_mesh *m, he_kind kind, uint32_t child, uint32_t parent)
{
    he_record_word(m, HE_COL_PARENT, (uint32_t)kind, child, parent, 0);
}
static inline void he_note_merged(he_mesh *m, he_kind kind, uint32_t gone, uint32_t into)
{
    he_record_word(m, HE_COL_MERGED, (uint32_t)kind, gone, into, 0);
}

/* Carry the attributes of every column in a domain by its rule. Kinds: HE_VERTEX, HE_HALFEDGE,
 * HE_EDGE, HE_FACE. `between` interpolates, copies a (t < 1) or b, or leaves the default;
 * `copy` copies unless the rule is default. Both are no-ops without such columns. */
void he_carry_between(he_mesh *m, he_kind kind, uint32_t to, uint32_t a, uint32_t b, double t);
void he_carry_copy(he_mesh *m, he_kind kind, uint32_t to, uint32_t from);
/* The mean of n rows; copies the first where the rule is copy. */
void he_carry_mean(he_mesh *m, he_kind kind, uint32_t to, const uint32_t *from, size_t n);
/* A row that stays takes in one that goes: interpolated columns become linear from `gone` (t = 0)
 * to `into` (t = 1), all others keep the value of `into`. */
void he_carry_merge(he_mesh *m, he_kind kind, uint32_t into, uint32_t gone, double t);
/* The value itself, whatever the rule: a corner that changes its half-edge. */
void he_carry_move(he_mesh *m, he_kind kind, uint32_t to, uint32_t from);
/* Are there columns in this domain? Lets a hot edit skip the calls. */
bool he_has_columns(const he_mesh *m, he_kind kind);

/* Make ready for he_set_attribute of so many rows of one column. HE_NO_MEMORY. */
HE_NODISCARD he_status he_reserve_values(he_mesh *m, size_t slot, size_t rows, he_error *err);

/* Structure of columns, recorded. `takes`: the column belongs to the mesh from success on. It must
 * have as many rows as the domain has issued. It gets the first free slot: history is linear, so a
 * record that names a slot is only applied while the same column is there. */
HE_NODISCARD he_status he_mesh_add_column(he_mesh *m, he_column *takes, he_error *err);
HE_NODISCARD he_status he_mesh_drop_column(he_mesh *m, size_t slot, he_error *err);
/* Swap the whole content with `takes` (emptied and freed on success), recorded as one replace that
 * keeps the old arrays; without recording they are freed. HE_KEEPS_IDS promises that every id
 * issued before is issued in `takes` and means the same element, or a dead one, and that columns
 * stay in their slots: such a replace can be undone and done again among other edits,
 * he_delta_ready permitting. */
typedef enum he_replacing { HE_KEEPS_IDS, HE_RENUMBERS } he_replacing;
HE_NODISCARD he_status he_mesh_replace(he_mesh *m, he_mesh *takes, he_replacing how, he_error *err);

/* A bracket around several edits that succeed or fail as one. While no delta is attached it brings
 * its own, so that it can roll back. he_edit_end returns `status` unchanged. */
typedef struct he_bracket {
    he_delta *own;
    he_savepoint mark;
} he_bracket;
HE_NODISCARD he_status he_edit_begin(he_mesh *m, he_bracket *out, he_error *err);
he_status he_edit_end(he_mesh *m, he_bracket *bracket, he_status status);

#endif
