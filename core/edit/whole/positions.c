#include "edit/whole/positions.h"

#include "edit/piece/list.h"
#include "edit/piece/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

#include <string.h>

/* The vertices of one call, and their points. */
typedef struct plan {
    const uint32_t *ids; /* NULL: all ids */
    size_t count;
    const he_vec3 *points;
    size_t step; /* 0 if there is one point for all vertices, else 1 */
} plan;

static he_vertex vertex_at(const plan *p, size_t i)
{
    return (he_vertex){p->ids != NULL ? p->ids[i] : (uint32_t)i};
}

/* The number of vertices that move, and of the words of their positions that change. */
typedef struct tally {
    uint64_t vertices, words;
} tally;

/* Returns how many of the two words of a coordinate differ. */
static unsigned words_between(double a, double b)
{
    uint64_t x, y;
    memcpy(&x, &a, sizeof x);
    memcpy(&y, &b, sizeof y);
    return (unsigned)((uint32_t)x != (uint32_t)y) + (unsigned)(x >> 32 != y >> 32);
}

/* Returns in how many words the position of the vertex of entry i of the plan differs from its
 * point; 0 if the vertex is deleted. */
static unsigned moves(const he_mesh *m, const plan *p, size_t i)
{
    const he_vertex v = vertex_at(p, i);
    const he_vec3 from = he_position(m, v), to = p->points[i * p->step];
    const unsigned words =
        words_between(from.x, to.x) + words_between(from.y, to.y) + words_between(from.z, to.z);
    return words > 0 && he_vertex_is_live(m, v) ? words : 0;
}

static he_status check(const he_mesh *m, const plan *p, tally *moved, he_error *err)
{
    he_marks marks;
    const bool marked = he_marks_find(m, &marks);
    he_status status = he_progress_phase(m->progress, "checking", 0.5, err);
    for (size_t i = 0; i < p->count && status == HE_OK; i++) {
        status = he_progress_at(m->progress, i, p->count, err);
        const unsigned words = moves(m, p, i);
        if (words == 0) {
            continue;
        }
        const he_vertex v = vertex_at(p, i);
        if (status == HE_OK && marked) {
            status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
        }
        if (status == HE_OK && !he_point_is_finite(p->points[i * p->step])) {
            status = he_fail(err, HE_NOT_FINITE, HE_VERTEX, v.i,
                             "vertex %u would have a position that is not finite", v.i);
        }
        moved->vertices++;
        moved->words += words;
    }
    return status;
}

/* Words of positions that are changed one by one are listed to those who follow the mesh, so only
 * a move of more vertices than any list shows is kept as all positions at once. */
enum { MANY = 1 << 14 };

/* Returns true if a record of all positions takes less memory than records of the words of those
 * that change. */
static bool is_most(const he_mesh *m, const tally *moved)
{
    return moved->vertices >= MANY && sizeof(he_vec3) * (uint64_t)he_mesh_issued(m, HE_VERTEX) <
                                          sizeof(he_record) * moved->words;
}

/* Moves the vertices that move, one by one. */
static he_status move_each(he_mesh *m, const plan *p, const tally *moved, he_error *err)
{
    /* Each record of a word takes as much memory as the record of a link. */
    he_status status = he_reserve(m, (he_reservation){.links = moved->words}, err);
    /* Nothing below can fail. */
    for (size_t i = 0; i < p->count && status == HE_OK; i++) {
        he_progress_note(m->progress, i, p->count);
        if (moves(m, p, i)) {
            he_set_position(m, vertex_at(p, i), p->points[i * p->step]);
        }
    }
    return status;
}

/* Writes all positions at once, those of vertices that stay too. */
static he_status move_all(he_mesh *m, const plan *p, he_error *err)
{
    he_column *column = NULL;
    he_column present;
    he_mesh_position_column(m, &present);
    he_status status = he_column_copy(&present, &column, err);
    for (size_t i = 0; i < p->count && status == HE_OK; i++) {
        he_progress_note(m->progress, i, p->count);
        if (moves(m, p, i)) {
            memcpy(he_column_row(column, vertex_at(p, i).i), &p->points[i * p->step],
                   sizeof *p->points);
        }
    }
    if (status == HE_OK) {
        status = he_exchange_positions(m, column, err);
    }
    if (status != HE_OK) {
        he_column_free(column);
    }
    return status;
}

static he_status check_count(const he_mesh *m, size_t count, he_error *err)
{
    return count == he_mesh_issued(m, HE_VERTEX)
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE, "%zu points are given for the %u ids of vertices",
                               count, he_mesh_issued(m, HE_VERTEX));
}

he_status he_positions_write(he_mesh *m, const uint32_t *ids, size_t count, const he_vec3 *points,
                             bool same, he_error *err)
{
    const plan p = {ids, count, points, same ? 0 : 1};
    tally moved = {0};
    he_status status = ids != NULL
                           ? he_list_require(m, HE_VERTEX, ids, count, HE_REPEATED_ELEMENT, err)
                           : check_count(m, count, err);
    if (status == HE_OK) {
        status = check(m, &p, &moved, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "moving", 1, err);
    }
    if (status != HE_OK) {
        return status;
    }
    return is_most(m, &moved) ? move_all(m, &p, err) : move_each(m, &p, &moved, err);
}

he_status he_positions_put(he_mesh *m, he_column *takes, he_error *err)
{
    const plan p = {NULL, takes->rows, (const he_vec3 *)(const void *)takes->data, 1};
    tally moved = {0};
    he_status status = check_count(m, p.count, err);
    if (status == HE_OK) {
        status = check(m, &p, &moved, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "moving", 1, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (!is_most(m, &moved)) {
        status = move_each(m, &p, &moved, err);
        if (status == HE_OK) {
            he_column_free(takes);
        }
        return status;
    }
    for (size_t i = 0; i < p.count; i++) {
        if (!moves(m, &p, i)) {
            const he_vec3 stays = he_position(m, vertex_at(&p, i));
            memcpy(he_column_row(takes, i), &stays, sizeof stays);
        }
    }
    return he_exchange_positions(m, takes, err);
}
