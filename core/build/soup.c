/* soup.c - fills a polygon soup (a list of faces that are not linked yet) within its limits:
 * he_soup of build.h. */
#include "build/build.h"

#include <math.h>
#include <string.h>

void he_soup_init(he_soup *soup, const he_limits *limits)
{
    *soup = (he_soup){0};
    if (limits != NULL) {
        soup->limits = *limits;
    }
}

void he_soup_clear(he_soup *soup)
{
    he_mem_free(soup->positions);
    he_mem_free(soup->corners);
    he_mem_free(soup->starts);
    for (size_t i = 0; i < soup->column_count; i++) {
        he_column_free(soup->columns[i]);
    }
    he_mem_free(soup->columns);
    he_materials_clear(&soup->materials);
    he_limits limits = soup->limits;
    he_soup_init(soup, &limits);
}

static size_t bytes_of(const he_soup *soup)
{
    return soup->vertex_capacity * sizeof *soup->positions +
           (soup->corner_capacity + soup->face_capacity) * sizeof(uint32_t);
}

/* One of the growing arrays of a soup: vertices, faces or corners. */
typedef struct rows {
    void *array;
    size_t size; /* bytes of an entry */
    size_t count, capacity;
    uint64_t limit;   /* most entries that the soup may have; 0: only `most` limits them */
    uint64_t most;    /* most entries that a mesh can have */
    const char *name; /* name of the entries in messages */
} rows;

/* Makes sure that the array has memory for one more entry. */
static he_status grow(const he_soup *soup, rows *r, he_error *err)
{
    uint64_t allowed = r->limit != 0 && r->limit < r->most ? r->limit : r->most;
    if (r->count >= allowed) {
        return he_fail_plain(err, HE_LIMIT, "there are more than %llu %s",
                             (unsigned long long)allowed, r->name);
    }
    if (r->count < r->capacity) {
        return HE_OK;
    }
    size_t wanted = he_mem_grown(r->capacity, r->count + 1);
    if (soup->limits.bytes != 0 &&
        bytes_of(soup) + (wanted - r->capacity) * r->size > soup->limits.bytes) {
        return he_fail_plain(err, HE_LIMIT, "the mesh needs more than %llu bytes of memory",
                             (unsigned long long)soup->limits.bytes);
    }
    void *array = he_mem_array(r->array, wanted, r->size);
    if (array == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu %s", wanted, r->name);
    }
    r->array = array;
    r->capacity = wanted;
    return HE_OK;
}

static he_status grow_vertices(he_soup *soup, he_error *err)
{
    rows r = {.array = soup->positions,
              .size = sizeof *soup->positions,
              .count = soup->vertex_count,
              .capacity = soup->vertex_capacity,
              .limit = soup->limits.vertices,
              .most = HE_MAX_ROWS,
              .name = "vertices"};
    he_status status = grow(soup, &r, err);
    soup->positions = r.array;
    soup->vertex_capacity = r.capacity;
    return status;
}

static he_status grow_faces(he_soup *soup, he_error *err)
{
    rows r = {.array = soup->starts,
              .size = sizeof *soup->starts,
              .count = soup->face_count,
              .capacity = soup->face_capacity,
              .limit = soup->limits.faces,
              .most = HE_MAX_ROWS,
              .name = "faces"};
    he_status status = grow(soup, &r, err);
    soup->starts = r.array;
    soup->face_capacity = r.capacity;
    return status;
}

static he_status grow_corners(he_soup *soup, he_error *err)
{
    rows r = {.array = soup->corners,
              .size = sizeof *soup->corners,
              .count = soup->corner_count,
              .capacity = soup->corner_capacity,
              .limit = soup->limits.corners,
              .most = UINT32_MAX - 1,
              .name = "corners"};
    he_status status = grow(soup, &r, err);
    soup->corners = r.array;
    soup->corner_capacity = r.capacity;
    return status;
}

he_status he_soup_add_vertex(he_soup *soup, he_vec3 position, he_error *err)
{
    if (!isfinite(position.x) || !isfinite(position.y) || !isfinite(position.z)) {
        return he_fail_plain(err, HE_NOT_FINITE, "vertex %zu has a coordinate that is not finite",
                             soup->vertex_count);
    }
    if (soup->vertex_count == soup->vertex_capacity ||
        (soup->limits.vertices != 0 && soup->vertex_count >= soup->limits.vertices)) {
        he_status status = grow_vertices(soup, err);
        if (status != HE_OK) {
            return status;
        }
    }
    soup->positions[soup->vertex_count++] = position;
    return HE_OK;
}

he_status he_soup_begin_face(he_soup *soup, he_error *err)
{
    if (soup->face_count == soup->face_capacity ||
        (soup->limits.faces != 0 && soup->face_count >= soup->limits.faces)) {
        he_status status = grow_faces(soup, err);
        if (status != HE_OK) {
            return status;
        }
    }
    soup->starts[soup->face_count++] = (uint32_t)soup->corner_count;
    return HE_OK;
}

he_status he_soup_add_corner(he_soup *soup, uint32_t vertex, he_error *err)
{
    if (soup->corner_count == soup->corner_capacity ||
        (soup->limits.corners != 0 && soup->corner_count >= soup->limits.corners)) {
        he_status status = grow_corners(soup, err);
        if (status != HE_OK) {
            return status;
        }
    }
    soup->corners[soup->corner_count++] = vertex;
    return HE_OK;
}

he_status he_soup_add_face(he_soup *soup, const uint32_t *vertices, size_t count, he_error *err)
{
    size_t corners = soup->corner_count;
    he_status status = he_soup_begin_face(soup, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        status = he_soup_add_corner(soup, vertices[i], err);
    }
    if (status != HE_OK) {
        soup->face_count--;
        soup->corner_count = corners;
    }
    return status;
}

uint32_t he_soup_face_of(const he_soup *soup, size_t corner)
{
    size_t low = 0, high = soup->face_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (soup->starts[middle] <= corner) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return (uint32_t)low;
}

he_status he_soup_take_column(he_soup *soup, he_column *takes, he_error *err)
{
    if (soup->column_count == soup->column_capacity) {
        size_t capacity = he_mem_grown(soup->column_capacity, soup->column_count + 1);
        he_column **columns = he_mem_array(soup->columns, capacity, sizeof(he_column *));
        if (columns == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for another attribute");
        }
        soup->columns = columns;
        soup->column_capacity = capacity;
    }
    soup->columns[soup->column_count++] = takes;
    return HE_OK;
}

he_status he_soup_column(he_soup *soup, const he_column_schema *schema, he_column **out,
                         he_error *err)
{
    for (size_t i = 0; i < soup->column_count; i++) {
        he_column *column = soup->columns[i];
        if (column->domain == schema->domain && strcmp(column->name, schema->name) == 0) {
            if (column->type != schema->type || column->components != schema->components) {
                return he_fail_plain(
                    err, HE_BAD_VALUE, "attribute %s is given with two types: %s and %s",
                    schema->name, he_type_name(column->type), he_type_name(schema->type));
            }
            *out = column;
            return HE_OK;
        }
    }
    he_column *column;
    he_status status = he_column_new(schema, &column, err);
    if (status == HE_OK) {
        status = he_soup_take_column(soup, column, err);
        if (status != HE_OK) {
            he_column_free(column);
            return status;
        }
        *out = column;
    }
    return status;
}
