#include "format/ply/ply_join.h"

#include "build/keep.h"
#include "format/ply/ply_groups.h"

#include <string.h>

bool he_ply_is_of_corners(const he_ply_header *header, const char *attribute)
{
    size_t length = strlen(attribute);
    for (const char *p = header->corners; *p != '\0';) {
        size_t word = strcspn(p, " ");
        if (word == length && memcmp(p, attribute, length) == 0) {
            return true;
        }
        p += word + strspn(p + word, " ");
    }
    return false;
}

static uint32_t vertex_of(const he_column *column, size_t row)
{
    uint32_t vertex;
    memcpy(&vertex, he_column_value(column, row), sizeof vertex);
    return vertex;
}

static bool same_place(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Counts the vertices that are no copies of other vertices; returns 0 if the marks of the copies
 * are not valid. */
static size_t count_vertices(const he_soup *soup, const he_column *column)
{
    size_t vertices = 0;
    while (vertices < soup->vertex_count && vertex_of(column, vertices) == vertices) {
        vertices++;
    }
    for (size_t i = vertices; i < soup->vertex_count; i++) {
        uint32_t vertex = vertex_of(column, i);
        if (vertex >= vertices || !same_place(soup->positions[i], soup->positions[vertex])) {
            return 0;
        }
    }
    return vertices;
}

static void join(he_soup *soup, const he_column *column, size_t vertices)
{
    for (size_t c = 0; c < soup->corner_count; c++) {
        soup->corners[c] = vertex_of(column, soup->corners[c]);
    }
    soup->vertex_count = vertices;
    for (size_t i = 0; i < soup->column_count; i++) {
        he_column *other = soup->columns[i];
        if (other->domain == HE_VERTEX && other->rows > vertices) {
            other->rows = vertices;
        }
    }
}

static void join_copies(he_import *into, size_t mark)
{
    he_soup *soup = &into->soup;
    he_column *column = soup->columns[mark];
    size_t vertices = column->type == HE_UINT32 ? count_vertices(soup, column) : 0;
    if (vertices > 0) {
        join(soup, column, vertices);
    } else if (soup->vertex_count > 0) {
        he_warnings_add(
            &into->warnings,
            &(he_occurrence){.code = "stale_copies",
                             .text = "vertices that are marked as copies of others stay separate, "
                                     "because the marks do not match the positions"});
    }
    soup->column_count--;
    memmove(soup->columns + mark, soup->columns + mark + 1,
            (soup->column_count - mark) * sizeof(he_column *));
    he_column_free(column);
}

he_status he_ply_join(he_import *into, const he_ply_header *header, he_error *err)
{
    he_soup *soup = &into->soup;
    he_status status = HE_OK;
    if (header->corners[0] == '\0') {
        return HE_OK;
    }
    for (size_t i = 0; i < HE_PLY_GROUPS && status == HE_OK; i++) {
        const he_ply_group *group = &he_ply_groups[i];
        if (group->written && he_ply_is_of_corners(header, group->attribute)) {
            status = he_soup_to_corners(soup, group->attribute, err);
        }
    }
    for (size_t i = 0; i < soup->column_count && status == HE_OK; i++) {
        if (soup->columns[i]->domain == HE_VERTEX &&
            strcmp(soup->columns[i]->name, HE_PLY_VERTEX_MARK) == 0) {
            join_copies(into, i);
            break;
        }
    }
    return status;
}
