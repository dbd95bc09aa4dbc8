/* write.h - the functions through which all writes to a mesh go. Only core/ may use them.
 *
 * An edit runs in three parts:
 *     CHECK    tests every precondition; a refusal leaves through he_fail.
 *     RESERVE  calls he_reserve to allocate all memory that COMMIT will use, also for records.
 *     COMMIT   calls the functions below, which cannot fail.
 * At the end of COMMIT, every link of every element that he_new_* made must have been set.
 *
 * If an edit consists of several edits and a later one may be refused, they must stand between
 * he_edit_begin and he_edit_end; if one fails, he_edit_end rolls back all of them. */
#ifndef HE_MESH_WRITE_H
#define HE_MESH_WRITE_H

#include "mesh/delta.h"
#include "mesh/walk.h"

#include <assert.h>
#include <string.h>

/* The upper limits of what the COMMIT part of an edit will need: `vertices`, `edges` and `faces`
 * are the numbers of new elements. he_reserve itself adds the records for the links, positions and
 * attributes of new elements. */
typedef struct he_reservation {
    uint32_t vertices, edges, faces;
    /* Upper limits of the numbers of elements that the edit deletes. */
    size_t deleted_vertices, deleted_edges, deleted_faces;
    /* upper limit of the number of links written in elements that are neither new nor deleted */
    size_t links;
    /* upper limit of the number of positions written in vertices that are neither new
     * nor deleted */
    size_t positions;
    /* Upper limit of the number of elements, neither new nor deleted, whose attributes are written.
     * Each element counts once, however many attributes it has. */
    size_t attributes;
    size_t lineage; /* upper limit of the number of calls of he_note_parent and he_note_merged */
} he_reservation;

/* The most records that COMMIT makes for each new or deleted element, without records of its
 * attributes. These numbers are larger than the number of an element's links, because an edit may
 * write a link twice. */
enum {
    HE_POSITION_RECORDS = sizeof(he_vec3) / 4,
    HE_VERTEX_RECORDS = 2 + HE_POSITION_RECORDS,
    HE_EDGE_RECORDS = 16,
    HE_FACE_RECORDS = 2
};

/* The slow part of he_reserve, which allocates memory. Most edits find enough memory without it. On
 * failure the mesh is as it was.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_reserve_more(he_mesh *m, const he_reservation *need, he_error *err);
/* Returns true if the mesh has no attributes, and its arrays and its delta have enough memory for
 * the edit already. */
static inline bool he_has_room(const he_mesh *m, const he_reservation *need)
{
    const he_content *c = &m->c;
    const he_delta *d = m->delta;
    size_t vertices = need->vertices + need->deleted_vertices;
    size_t edges = need->edges + need->deleted_edges, faces = need->faces + need->deleted_faces;
    return c->column_count == 0 && need->vertices <= c->vertices.capacity - c->vertices.issued &&
           need->edges <= c->edges.capacity - c->edges.issued &&
           need->faces <= c->faces.capacity - c->faces.issued &&
           (d == NULL || HE_VERTEX_RECORDS * vertices + HE_EDGE_RECORDS * edges +
                                 HE_FACE_RECORDS * faces + need->links +
                                 HE_POSITION_RECORDS * need->positions + need->lineage <=
                             d->capacity - d->count);
}
static inline he_status he_reserve(he_mesh *m, he_reservation need, he_error *err)
{
    return he_has_room(m, &need) ? HE_OK : he_reserve_more(m, &need, err);
}

/* Adds `count` records to the delta that is recording, and returns a pointer to them, so that the
 * caller can fill them in; returns NULL if no delta is recording. Several records should be added
 * by one call, because each further call would wait until the processor has written the count of
 * the call before. */
static inline he_record *he_record_take(he_mesh *m, size_t count)
{
    he_delta *d = m->delta;
    if (d == NULL) {
        return NULL;
    }
    assert(count <= d->capacity - d->count);
    he_record *taken = d->records + d->count;
    d->count += count;
    return taken;
}
static inline he_record he_record_of(uint32_t column, uint32_t word, uint32_t row, uint32_t before,
                                     uint32_t after)
{
    return (he_record){column & 0xFFFFFFu, word & 0xFFu, row, before, after};
}
/* Writes two words that lie side by side as one word of 64 bits, because the processor can hold
 * only some sixty writes that wait for memory. All machines that hedge supports are
 * little-endian. */
static inline void he_write_two(void *to, uint32_t first, uint32_t second)
{
    const uint64_t both = (uint64_t)second << 32 | first;
    memcpy(to, &both, sizeof both);
}
static inline void he_record_put(he_record *to, he_record r)
{
    const uint32_t words[4] = {r.column | (uint32_t)r.word << 24, r.row, r.before, r.after};
    memcpy(to, words, sizeof words);
}
static inline void he_record_word(he_mesh *m, uint32_t column, uint32_t word, uint32_t row,
                                  uint32_t before, uint32_t after)
{
    he_record *r = he_record_take(m, 1);
    if (r != NULL) {
        he_record_put(r, he_record_of(column, word, row, before, after));
    }
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
/* Links two half-edges: next(a) becomes b, and prev(b) becomes a. */
static inline void he_link(he_mesh *m, he_halfedge a, he_halfedge b)
{
    he_record *r = he_record_take(m, 2);
    if (r != NULL) {
        he_record_put(&r[0], he_record_of(HE_COL_NEXT, 0, a.i, m->c.next[a.i], b.i));
        he_record_put(&r[1], he_record_of(HE_COL_PREV, 0, b.i, m->c.prev[b.i], a.i));
    }
    m->c.next[a.i] = b.i;
    m->c.prev[b.i] = a.i;
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
/* Writes all links of a half-edge, which may be new or be about to be deleted. */
static inline void he_set_halfedge(he_mesh *m, he_halfedge h, he_halfedge next, he_halfedge prev,
                                   he_vertex origin, he_face f)
{
    he_content *c = &m->c;
    uint32_t before = c->face[h.i];
    he_record *r = he_record_take(m, 4);
    if (r != NULL) {
        he_record_put(&r[0], he_record_of(HE_COL_NEXT, 0, h.i, c->next[h.i], next.i));
        he_record_put(&r[1], he_record_of(HE_COL_PREV, 0, h.i, c->prev[h.i], prev.i));
        he_record_put(&r[2], he_record_of(HE_COL_ORIGIN, 0, h.i, c->origin[h.i], origin.i));
        he_record_put(&r[3], he_record_of(HE_COL_FACE, 0, h.i, before, f.i));
    }
    c->boundary_halfedges += (uint32_t)(f.i == HE_NONE) - (uint32_t)(before == HE_NONE);
    c->next[h.i] = next.i;
    c->prev[h.i] = prev.i;
    c->origin[h.i] = origin.i;
    c->face[h.i] = f.i;
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
void he_record_position(he_mesh *m, he_vertex v, he_vec3 position);
static inline void he_set_position(he_mesh *m, he_vertex v, he_vec3 position)
{
    if (m->delta != NULL) {
        he_record_position(m, v, position);
    }
    m->c.position[v.i] = position;
}
/* Writes the positions of all vertices at once: exchanges them with the values of `takes`, a column
 * of he_position_schema with a row for each issued id, in which deleted vertices are at the origin.
 * The delta gets one record and keeps the column, with the old positions; a record of each word
 * would take four times as much memory. On success the delta owns `takes`, or it is freed if no
 * delta is recording.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_exchange_positions(he_mesh *m, he_column *takes, he_error *err);
/* Writes the attribute value of element `row` to the column in slot (array entry) `slot` of the
 * mesh. `value` has row_bytes bytes. */
void he_set_attribute(he_mesh *m, size_t slot, uint32_t row, const void *value);

/* These functions set all links of an element to HE_DEAD, which marks a deleted element. A new
 * element has such links until the caller writes its links. */
static inline void he_clear_vertex(he_content *c, uint32_t v)
{
    c->position[v] = (he_vec3){0, 0, 0};
    c->vertex_halfedge[v] = HE_DEAD;
}
static inline void he_clear_edge(he_content *c, uint32_t e)
{
    for (uint32_t h = 2 * e; h <= 2 * e + 1; h++) {
        c->next[h] = c->prev[h] = c->origin[h] = c->face[h] = HE_DEAD;
    }
}
static inline void he_clear_face(he_content *c, uint32_t f)
{
    c->face_halfedge[f] = HE_DEAD;
}

/* Appends default values to every attribute column until it has a value for each element of its
 * domain; he_reserve must have allocated memory for these values. */
void he_issue_values(he_mesh *m);
static inline uint32_t he_issue(he_mesh *m, he_rows *rows)
{
    assert(rows->issued < rows->capacity);
    rows->live++;
    uint32_t row = rows->issued++;
    if (m->c.column_count > 0) {
        he_issue_values(m);
    }
    return row;
}

/* Makes a vertex with a new id. Its links are HE_DEAD until the caller writes them, and its
 * attributes have their default values. he_reserve must have allocated memory for the vertex. */
static inline he_vertex he_new_vertex(he_mesh *m)
{
    uint32_t v = he_issue(m, &m->c.vertices);
    he_clear_vertex(&m->c, v);
    return (he_vertex){v};
}
static inline he_edge he_new_edge(he_mesh *m)
{
    uint32_t e = he_issue(m, &m->c.edges);
    he_clear_edge(&m->c, e);
    return (he_edge){e};
}
static inline he_face he_new_face(he_mesh *m)
{
    uint32_t f = he_issue(m, &m->c.faces);
    he_clear_face(&m->c, f);
    return (he_face){f};
}
/* Deletes a vertex: sets its links to HE_DEAD, and its position and attributes to their default
 * values. No live element may still have a link to the vertex. */
void he_delete_vertex(he_mesh *m, he_vertex v);
void he_delete_edge(he_mesh *m, he_edge e);
void he_delete_face(he_mesh *m, he_face f);

/* These functions record in the delta from which element (the parent) a new element came, and into
 * which element a deleted element was merged. They do nothing if no delta is recording. */
static inline void he_note_parent(he_mesh *m, he_kind kind, uint32_t child, uint32_t parent)
{
    he_record_word(m, HE_COL_PARENT, (uint32_t)kind, child, parent, 0);
}
static inline void he_note_merged(he_mesh *m, he_kind kind, uint32_t gone, uint32_t into)
{
    he_record_word(m, HE_COL_MERGED, (uint32_t)kind, gone, into, 0);
}

/* These functions set the attributes of element `to`, in every column of its kind, by the column's
 * rule. The functions named `between` interpolate from element a (t = 0) to element b (t = 1) if
 * the rule is interpolate; they copy the value of a (t < 1) or of b if the rule is copy, and write
 * the default value if the rule is default. The functions named `copy` copy the value unless the
 * rule is default. The kind may be HE_VERTEX, HE_HALFEDGE, HE_EDGE or HE_FACE. In a mesh without
 * attributes each call costs one test. */
void he_values_between(he_mesh *m, he_kind kind, uint32_t to, uint32_t a, uint32_t b, double t);
static inline void he_attributes_between(he_mesh *m, he_kind kind, uint32_t to, uint32_t a,
                                         uint32_t b, double t)
{
    if (m->c.column_count > 0) {
        he_values_between(m, kind, to, a, b, t);
    }
}
void he_values_copy(he_mesh *m, he_kind kind, uint32_t to, uint32_t from);
static inline void he_attributes_copy(he_mesh *m, he_kind kind, uint32_t to, uint32_t from)
{
    if (m->c.column_count > 0) {
        he_values_copy(m, kind, to, from);
    }
}
/* Sets the attributes of element `to` by each column's rule: to the mean of the n elements in
 * `from` if the rule is interpolate, to the values of the first of them if it is copy. */
void he_attributes_mean(he_mesh *m, he_kind kind, uint32_t to, const uint32_t *from, size_t n);
/* Mixes the attributes of element `row` with those of element `other`. In columns with the rule
 * interpolate, `row` gets the value between `other` (t = 0) and `row` (t = 1); in all other columns
 * it keeps its value. */
void he_values_mix(he_mesh *m, he_kind kind, uint32_t row, uint32_t other, double t);
static inline void he_attributes_mix(he_mesh *m, he_kind kind, uint32_t row, uint32_t other,
                                     double t)
{
    if (m->c.column_count > 0) {
        he_values_mix(m, kind, row, other, t);
    }
}
/* Mixes the attributes of element `gone` into element `into` like he_values_mix, unless `into` is
 * locked (marks.h). */
void he_values_merge(he_mesh *m, he_kind kind, uint32_t into, uint32_t gone, double t);
static inline void he_attributes_merge(he_mesh *m, he_kind kind, uint32_t into, uint32_t gone,
                                       double t)
{
    if (m->c.column_count > 0) {
        he_values_merge(m, kind, into, gone, t);
    }
}
/* Copies all attributes of element `from` to element `to`, whatever the rules of the columns. A
 * corner that moves to another half-edge needs this. */
void he_values_move(he_mesh *m, he_kind kind, uint32_t to, uint32_t from);
static inline void he_attributes_move(he_mesh *m, he_kind kind, uint32_t to, uint32_t from)
{
    if (m->c.column_count > 0) {
        he_values_move(m, kind, to, from);
    }
}
/* Returns true if the mesh has attribute columns for this kind of element. If it has none, an edit
 * that is made often can skip the functions above that set attributes. */
bool he_has_columns(const he_mesh *m, he_kind kind);

/* Allocates memory for the records of calls of he_set_attribute that write `rows` values of one
 * column.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_reserve_values(he_mesh *m, size_t slot, size_t rows, he_error *err);

/* These functions add or drop an attribute column, and record this in the delta. On success the
 * mesh owns `takes`, which must have one value for each id issued in its domain. The column gets
 * the first free slot (entry of the mesh's array of columns). A slot may be used for another column
 * later. This does not confuse undo and redo, because they run through the history in order: a
 * record that names a slot is only applied while the column that the record means is in
 * that slot. */
HE_NODISCARD he_status he_mesh_add_column(he_mesh *m, he_column *takes, he_error *err);
HE_NODISCARD he_status he_mesh_drop_column(he_mesh *m, size_t slot, he_error *err);
/* Puts a material into a slot (entry) of the mesh's table of materials, in place of the material
 * that is there; if `takes` is NULL, the slot becomes unused. `slot` may be the index after the
 * last slot, which then is added to the table. No other material may have the name of the material.
 * On success the mesh owns `takes`.
 * Returns HE_LIMIT if there would be more than HE_MATERIALS slots.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_mesh_put_material(he_mesh *m, size_t slot, he_material *takes,
                                            he_error *err);
/* Says whether he_mesh_replace changes ids. he_mesh_replace replaces the content (all data) of a
 * mesh by the content of `takes`, which is freed on success. The delta keeps the old content; if no
 * delta is recording, the old content is freed. HE_KEEPS_IDS promises that every id issued in the
 * mesh is also issued in `takes` and there names the element that it named before or a deleted
 * element, and that columns keep their slots. Such a replacement can be undone and redone among
 * other edits, after he_delta_ready. */
typedef enum he_replacing { HE_KEEPS_IDS, HE_RENUMBERS } he_replacing;
HE_NODISCARD he_status he_mesh_replace(he_mesh *m, he_mesh *takes, he_replacing how, he_error *err);

/* The state between he_edit_begin and he_edit_end, which enclose several edits that succeed or fail
 * together. If no delta was recording at the beginning, `own` is a delta that records, so that the
 * edits can be rolled back. he_edit_end returns `status` unchanged. Cancelled edits of an
 * expendable mesh (he_mesh_expend) are not rolled back. */
typedef struct he_bracket {
    he_delta *own;
    he_savepoint mark;
} he_bracket;
HE_NODISCARD he_status he_edit_begin(he_mesh *m, he_bracket *out, he_error *err);
he_status he_edit_end(he_mesh *m, he_bracket *bracket, he_status status);

#endif
