/* pen.h - writes the links of an edit without a test for each write.
 *
 * An edit at a random place of a large mesh mostly waits for memory. If the code of an edit is
 * short and has few branches that are hard to predict, the processor begins the next edit while it
 * waits for the memory of the present one. Edits that are made very often therefore have a second,
 * short commit function for their common case, which reads all links first and then writes them
 * with a pen.
 *
 * Such an edit is compiled twice, for a mesh whose writes a delta records and for one whose writes
 * no delta records, so that the second has no code that makes records: every function that takes a
 * pen is inlined, and he_pen_begin is called with a constant.
 *
 * A pen is for meshes without attributes, and may not change the number of boundary half-edges.
 * he_reserve must have found memory for all records and all new elements. */
#ifndef HE_MESH_PEN_H
#define HE_MESH_PEN_H

#include "mesh/write.h"

typedef struct he_pen {
    he_content *content;
    he_record *record; /* where the next record goes; NULL if no delta is recording */
} he_pen;

#define HE_PEN_INLINE static inline __attribute__((always_inline))

/* Returns a pen. `recording` says whether a delta records the writes to the mesh, and must be a
 * constant. After the last write, he_pen_end must be called. */
HE_PEN_INLINE he_pen he_pen_begin(he_mesh *m, bool recording)
{
    return (he_pen){&m->c, recording ? m->delta->records + m->delta->count : NULL};
}
HE_PEN_INLINE void he_pen_end(const he_pen *pen, he_mesh *m)
{
    if (pen->record != NULL) {
        m->delta->count = (size_t)(pen->record - m->delta->records);
        assert(m->delta->count <= m->delta->capacity);
    }
}

/* Adds a record, if a delta is recording. */
HE_PEN_INLINE void he_pen_note(he_pen *pen, he_record record)
{
    if (pen->record != NULL) {
        he_record_put(pen->record++, record);
    }
}
/* These functions change a link of a half-edge from `was` to another value. The caller names the
 * present value, although the mesh has it, because a read for the record would have to wait for
 * memory. */
HE_PEN_INLINE void he_pen_next(he_pen *pen, uint32_t h, uint32_t was, uint32_t next)
{
    he_pen_note(pen, he_record_of(HE_COL_NEXT, 0, h, was, next));
    pen->content->next[h] = next;
}
HE_PEN_INLINE void he_pen_prev(he_pen *pen, uint32_t h, uint32_t was, uint32_t prev)
{
    he_pen_note(pen, he_record_of(HE_COL_PREV, 0, h, was, prev));
    pen->content->prev[h] = prev;
}
HE_PEN_INLINE void he_pen_origin(he_pen *pen, uint32_t h, uint32_t was, uint32_t v)
{
    he_pen_note(pen, he_record_of(HE_COL_ORIGIN, 0, h, was, v));
    pen->content->origin[h] = v;
}
HE_PEN_INLINE void he_pen_face(he_pen *pen, uint32_t h, uint32_t was, uint32_t f)
{
    he_pen_note(pen, he_record_of(HE_COL_FACE, 0, h, was, f));
    pen->content->face[h] = f;
}

/* If `links[row]` is `from` or `or_from`, sets it to `to`. The function has no branch, because the
 * processor could not predict it: which of its half-edges an element stores is arbitrary. */
HE_PEN_INLINE void he_pen_exchange(he_pen *pen, uint32_t *links, he_record change, uint32_t or_from)
{
    const uint32_t now = links[change.row];
    const uint32_t changes = (uint32_t)(now == change.before) | (uint32_t)(now == or_from);
    const uint32_t after = (now & (changes - 1u)) | (change.after & (0u - changes));
    if (pen->record != NULL) {
        he_record_put(pen->record, he_record_of(change.column, 0, change.row, now, after));
        pen->record += changes;
    }
    links[change.row] = after;
}
/* If vertex v stores half-edge `from`, makes it store `to`. */
HE_PEN_INLINE void he_pen_vertex_exchange(he_pen *pen, uint32_t v, uint32_t from, uint32_t to)
{
    he_pen_exchange(pen, pen->content->vertex_halfedge,
                    he_record_of(HE_COL_VERTEX_HALFEDGE, 0, v, from, to), from);
}
/* If face f stores half-edge `from` or `or_from`, makes it store `to`. */
HE_PEN_INLINE void he_pen_face_exchange(he_pen *pen, uint32_t f, uint32_t from, uint32_t or_from,
                                        uint32_t to)
{
    he_pen_exchange(pen, pen->content->face_halfedge,
                    he_record_of(HE_COL_FACE_HALFEDGE, 0, f, from, to), or_from);
}

/* All links of a half-edge. */
typedef struct he_halfedge_links {
    uint32_t next, prev, origin, face;
} he_halfedge_links;

/* Writes the links of both half-edges of a new edge: `links[0]` of half-edge 2e, `links[1]` of
 * half-edge 2e + 1. Two links that lie side by side are written together, because the processor can
 * hold only some sixty writes that wait for memory. */
HE_PEN_INLINE void he_pen_new_edge(he_pen *pen, uint32_t e, const he_halfedge_links links[2])
{
    const uint32_t h = 2 * e;
    for (uint32_t side = 0; side < 2; side++) {
        const he_halfedge_links *to = &links[side];
        he_pen_note(pen, he_record_of(HE_COL_NEXT, 0, h + side, HE_DEAD, to->next));
        he_pen_note(pen, he_record_of(HE_COL_PREV, 0, h + side, HE_DEAD, to->prev));
        he_pen_note(pen, he_record_of(HE_COL_ORIGIN, 0, h + side, HE_DEAD, to->origin));
        he_pen_note(pen, he_record_of(HE_COL_FACE, 0, h + side, HE_DEAD, to->face));
    }
    he_write_two(&pen->content->next[h], links[0].next, links[1].next);
    he_write_two(&pen->content->prev[h], links[0].prev, links[1].prev);
    he_write_two(&pen->content->origin[h], links[0].origin, links[1].origin);
    he_write_two(&pen->content->face[h], links[0].face, links[1].face);
}
/* Issues `count` ids of elements, whose links the caller must write, and returns the first. */
HE_PEN_INLINE uint32_t he_pen_issue(he_rows *rows, uint32_t count)
{
    assert(count <= rows->capacity - rows->issued);
    const uint32_t first = rows->issued;
    rows->issued += count;
    rows->live += count;
    return first;
}
/* Writes the half-edge that a new vertex stores, and the vertex's position. */
HE_PEN_INLINE void he_pen_new_vertex(he_pen *pen, uint32_t v, uint32_t h, he_vec3 position)
{
    if (pen->record != NULL) {
        uint32_t words[HE_POSITION_RECORDS];
        memcpy(words, &position, sizeof words);
        for (uint32_t i = 0; i < HE_POSITION_RECORDS; i++) {
            he_record_put(pen->record, he_record_of(HE_COL_POSITION, i, v, 0, words[i]));
            pen->record += words[i] != 0;
        }
        he_pen_note(pen, he_record_of(HE_COL_VERTEX_HALFEDGE, 0, v, HE_DEAD, h));
    }
    pen->content->position[v] = position;
    pen->content->vertex_halfedge[v] = h;
}
/* Writes the half-edge that a new face stores. */
HE_PEN_INLINE void he_pen_new_face(he_pen *pen, uint32_t f, uint32_t h)
{
    he_pen_note(pen, he_record_of(HE_COL_FACE_HALFEDGE, 0, f, HE_DEAD, h));
    pen->content->face_halfedge[f] = h;
}
/* Records that new element `child` came from element `parent`. */
HE_PEN_INLINE void he_pen_parent(he_pen *pen, he_kind kind, uint32_t child, uint32_t parent)
{
    he_pen_note(pen, he_record_of(HE_COL_PARENT, (uint32_t)kind, child, parent, 0));
}

/* Makes the links of both half-edges of an edge HE_DEAD, which deletes the edge. `was` has their
 * present links. */
HE_PEN_INLINE void he_pen_delete_edge(he_pen *pen, uint32_t e, const he_halfedge_links was[2])
{
    const uint32_t h = 2 * e;
    for (uint32_t side = 0; side < 2; side++) {
        const he_halfedge_links *now = &was[side];
        he_pen_note(pen, he_record_of(HE_COL_NEXT, 0, h + side, now->next, HE_DEAD));
        he_pen_note(pen, he_record_of(HE_COL_PREV, 0, h + side, now->prev, HE_DEAD));
        he_pen_note(pen, he_record_of(HE_COL_ORIGIN, 0, h + side, now->origin, HE_DEAD));
        he_pen_note(pen, he_record_of(HE_COL_FACE, 0, h + side, now->face, HE_DEAD));
    }
    he_write_two(&pen->content->next[h], HE_DEAD, HE_DEAD);
    he_write_two(&pen->content->prev[h], HE_DEAD, HE_DEAD);
    he_write_two(&pen->content->origin[h], HE_DEAD, HE_DEAD);
    he_write_two(&pen->content->face[h], HE_DEAD, HE_DEAD);
    pen->content->edges.live--;
}
/* Deletes a face. */
HE_PEN_INLINE void he_pen_delete_face(he_pen *pen, uint32_t f)
{
    uint32_t *link = &pen->content->face_halfedge[f];
    if (pen->record != NULL) {
        he_pen_note(pen, he_record_of(HE_COL_FACE_HALFEDGE, 0, f, *link, HE_DEAD));
    }
    *link = HE_DEAD;
    pen->content->faces.live--;
}
/* Moves a vertex. */
HE_PEN_INLINE void he_pen_position(he_pen *pen, uint32_t v, he_vec3 position)
{
    he_vec3 *at = &pen->content->position[v];
    if (pen->record != NULL) {
        uint32_t before[HE_POSITION_RECORDS], after[HE_POSITION_RECORDS];
        memcpy(before, at, sizeof before);
        memcpy(after, &position, sizeof after);
        for (uint32_t i = 0; i < HE_POSITION_RECORDS; i++) {
            he_record_put(pen->record, he_record_of(HE_COL_POSITION, i, v, before[i], after[i]));
            pen->record += before[i] != after[i];
        }
    }
    *at = position;
}
/* Deletes a vertex. */
HE_PEN_INLINE void he_pen_delete_vertex(he_pen *pen, uint32_t v)
{
    uint32_t *link = &pen->content->vertex_halfedge[v];
    if (pen->record != NULL) {
        he_pen_note(pen, he_record_of(HE_COL_VERTEX_HALFEDGE, 0, v, *link, HE_DEAD));
    }
    *link = HE_DEAD;
    he_pen_position(pen, v, (he_vec3){0, 0, 0});
    pen->content->vertices.live--;
}
/* Records that element `gone` was merged into element `into`. */
HE_PEN_INLINE void he_pen_merged(he_pen *pen, he_kind kind, uint32_t gone, uint32_t into)
{
    he_pen_note(pen, he_record_of(HE_COL_MERGED, (uint32_t)kind, gone, into, 0));
}

#endif
