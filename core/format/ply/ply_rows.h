/* ply_rows.h - the rows of a PLY file, value by value, on their way into an import.
 *
 *     he_ply_rows_open
 *     he_ply_rows_next            to the first element that has rows, then to the one after it
 *         he_ply_rows_begin       for each row:
 *             he_ply_rows_value       for each of its properties, in order, or
 *             he_ply_rows_list        for a list,
 *                 he_ply_rows_item    with its values one by one
 *         he_ply_rows_end
 *
 * Whether the bytes are text or binary does not matter here. Errors are placed at `at`, which the
 * caller moves along. Rows of an element that is not `wanted` may be left out altogether. */
#ifndef HE_FORMAT_PLY_PLY_ROWS_H
#define HE_FORMAT_PLY_PLY_ROWS_H

#include "format/io/format.h"
#include "format/ply/ply_header.h"

typedef enum he_ply_role {
    HE_PLY_IGNORED,
    HE_PLY_POSITION,
    HE_PLY_ATTRIBUTE,
    HE_PLY_CORNERS,
    HE_PLY_STRIP,
    HE_PLY_UVS
} he_ply_role;

/* Where the values of a property go. */
typedef struct he_ply_target {
    he_ply_role role;
    uint32_t component;
    double full; /* what stands for 1 */
    he_column *column;
} he_ply_target;

typedef struct he_ply_rows {
    he_import *into;
    const he_ply_header *header;
    he_ply_target *targets; /* of all properties */
    he_place unit;
    uint64_t at;
    uint64_t vertices; /* announced */

    const he_ply_element *element; /* NULL before the first and after the last */
    bool vertex;                   /* its rows are vertices */
    bool wanted;                   /* any of its properties goes anywhere */
    uint64_t left;                 /* rows that have not ended */
    size_t row;                    /* of the attributes */
    double position[3];
    uint32_t strip[2]; /* the last two corners */
    bool turned;       /* the next triangle of the strip is */
    unsigned strip_length;
    he_column *uv; /* of corners, from lists of faces; NULL without any */
    double *uvs;   /* the row's, two a corner */
    size_t uv_count, uv_capacity;
} he_ply_rows;

/* Makes the attributes. HE_SYNTAX, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_rows_open(he_ply_rows *rows, he_import *into,
                                        const he_ply_header *header, he_error *err);
void he_ply_rows_clear(he_ply_rows *rows);
void he_ply_rows_next(he_ply_rows *rows);

static inline he_ply_role he_ply_rows_role(const he_ply_rows *rows, size_t property)
{
    return rows->targets[rows->element->first + property].role;
}

/* HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_rows_begin(he_ply_rows *rows, he_error *err);
/* HE_BAD_VALUE. What is not finite is known only at the end of the row. */
HE_NODISCARD he_status he_ply_rows_value(he_ply_rows *rows, size_t property, double value,
                                         he_error *err);
/* HE_BAD_VALUE, HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_rows_list(he_ply_rows *rows, size_t property, int64_t count,
                                        he_error *err);
/* Of a list of corners or strips. HE_BAD_INDEX, HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_rows_item(he_ply_rows *rows, size_t property, int64_t value,
                                        he_error *err);
/* The same of a list of floats or doubles: one that is not whole, or so large that its neighbours
 * are not in its type, names no vertex. Or a texture coordinate, which may be anything. */
HE_NODISCARD he_status he_ply_rows_fraction(he_ply_rows *rows, size_t property, double value,
                                            he_error *err);
/* All of a row that is nothing but a list of corners, `vertices` of this file. False, and nothing
 * done, where a limit is reached: the parts tell by which value. Else *status is HE_OK or
 * HE_NO_MEMORY. */
bool he_ply_rows_face(he_ply_rows *rows, const uint32_t *vertices, size_t count, he_status *status,
                      he_error *err);
/* HE_NOT_FINITE, HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_rows_end(he_ply_rows *rows, he_error *err);

#endif
