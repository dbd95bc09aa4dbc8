/* ply_rows.h - adds the rows of a PLY file to an import, value by value.
 *
 *     he_ply_rows_open
 *     he_ply_rows_next            to the first element that has rows, then to the one after it
 *         he_ply_rows_begin       for each row:
 *             he_ply_rows_value       for each of its properties, in order, or
 *             he_ply_rows_list        for a list,
 *                 he_ply_rows_item    with its values one by one
 *         he_ply_rows_end
 *
 * The values may come from text or binary. Errors name the place `at`, which the caller advances.
 * Rows of an element that is not `wanted` may be skipped. */
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

/* Where the values of a property are stored. */
typedef struct he_ply_target {
    he_ply_role role;
    uint32_t component;
    double full; /* the number in the file that becomes 1 in the attribute */
    he_column *column;
} he_ply_target;

typedef struct he_ply_rows {
    he_import *into;
    const he_ply_header *header;
    he_ply_target *targets; /* where the values of each property of the header go */
    he_place unit;
    uint64_t at;       /* line or byte of the row or value being read, for errors */
    uint64_t vertices; /* number of vertices that the header declares */

    /* element being read; NULL before the first and after the last */
    const he_ply_element *element;
    bool vertex;   /* true if the rows of the element are vertices */
    bool wanted;   /* true if some property of the element is stored */
    uint64_t left; /* number of rows of the element that have not been read completely */
    size_t row;    /* index of the vertex or face whose attribute values are being read */
    double position[3];
    uint32_t strip[2]; /* the last two corners of the strip of triangles */
    bool turned;       /* true if the next triangle of the strip is reversed */
    unsigned strip_length;
    he_column *uv; /* attribute uv of corners, read from lists of faces; NULL if there is none */
    double *uvs;   /* texture coordinates of the face being read, two numbers a corner */
    size_t uv_count, uv_capacity;
} he_ply_rows;

/* Makes the attributes for the properties of the file.
 * Returns HE_SYNTAX if the header lacks a property that is needed.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_rows_open(he_ply_rows *rows, he_import *into,
                                        const he_ply_header *header, he_error *err);
void he_ply_rows_clear(he_ply_rows *rows);
void he_ply_rows_next(he_ply_rows *rows);

static inline he_ply_role he_ply_rows_role(const he_ply_rows *rows, size_t property)
{
    return rows->targets[rows->element->first + property].role;
}

/* Begins a row of the present element.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_rows_begin(he_ply_rows *rows, he_error *err);
/* Adds a value of a row. Whether it must be finite is decided at the end of the row.
 * Returns HE_BAD_VALUE if the property cannot have this value. */
HE_NODISCARD he_status he_ply_rows_value(he_ply_rows *rows, size_t property, double value,
                                         he_error *err);
/* Begins a list of `count` values in a row.
 * Returns HE_BAD_VALUE if no list can have that length.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_rows_list(he_ply_rows *rows, size_t property, int64_t count,
                                        he_error *err);
/* Adds a whole number to a list of corners or of strips.
 * Returns HE_BAD_INDEX if the number is no vertex.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_rows_item(he_ply_rows *rows, size_t property, int64_t value,
                                        he_error *err);
/* Adds a number to a list of floats or doubles. In a list of corners, a number that is not
 * whole, or so large that its type cannot represent every whole number, is refused as no vertex.
 * In a list of texture coordinates any number is allowed. Returns the errors of
 * he_ply_rows_item. */
HE_NODISCARD he_status he_ply_rows_fraction(he_ply_rows *rows, size_t property, double value,
                                            he_error *err);
/* Adds a row that consists only of a list of corners: `vertices` holds the `count` numbers of their
 * vertices. Returns false, and does nothing, if a limit is reached: the caller then adds the row
 * value by value, and the refusal names the limit. Otherwise *status is HE_OK or HE_NO_MEMORY. */
bool he_ply_rows_face(he_ply_rows *rows, const uint32_t *vertices, size_t count, he_status *status,
                      he_error *err);
/* Ends a row.
 * Returns HE_NOT_FINITE if a position is not finite.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_rows_end(he_ply_rows *rows, he_error *err);

#endif
