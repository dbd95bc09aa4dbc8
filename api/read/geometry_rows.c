#include "api/read/geometry_rows.h"

#include <string.h>

enum { HEADER = 96, VERSION = 2, ROW = API_ROW_BYTES, IDS_A_ROW = 4 };

/* The parts of an answer, in their order. */
enum { IN_HEADER, VERTEX_IDS, VERTICES, SLOT_IDS, TRIANGLES, AT_END };

void api_rows_clear(api_rows *r)
{
    he_ids_clear(&r->vertex_ids);
    he_ids_clear(&r->slot_ids);
    he_mem_free(r->owner);
    he_draw_arrays_clear(&r->drawing);
    *r = (api_rows){0};
}

/* --- choosing the rows to send --- */

static he_status take(api_rows *r, const he_draw_slots *slots, uint64_t since, size_t triangles,
                      he_error *err)
{
    r->owner = he_mem_array(NULL, triangles + 1, sizeof *r->owner);
    if (r->owner == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu triangles", triangles);
    }
    r->revision = slots->revision;
    r->base = since;
    r->layout = slots->layout;
    r->frame = slots->frame;
    r->vertices = slots->vertices;
    r->triangles = slots->count;
    return HE_OK;
}

he_status api_rows_take_all(api_rows *r, const he_draw_slots *slots, he_error *err)
{
    he_status status = take(r, slots, 0, slots->count, err);
    if (status == HE_OK && slots->count > 0) {
        memcpy(r->owner, slots->owner, slots->count * sizeof *r->owner);
    }
    return status;
}

he_status api_rows_take_changes(api_rows *r, const he_draw_slots *slots, uint64_t since,
                                uint64_t most, he_error *err)
{
    he_status status = he_draw_slots_changed(slots, since, most, &r->vertex_ids, &r->slot_ids, err);
    if (status == HE_OK) {
        status = take(r, slots, since, r->slot_ids.count, err);
    }
    if (status != HE_OK) {
        he_ids_clear(&r->vertex_ids);
        he_ids_clear(&r->slot_ids);
        return status;
    }
    for (size_t i = 0; i < r->slot_ids.count; i++) {
        r->owner[i] = slots->owner[r->slot_ids.ids[i]];
    }
    return HE_OK;
}

static uint32_t vertex_rows(const api_rows *r)
{
    return r->base == 0 ? r->vertices : (uint32_t)r->vertex_ids.count;
}

static uint32_t triangle_rows(const api_rows *r)
{
    return r->base == 0 ? r->triangles : (uint32_t)r->slot_ids.count;
}

uint64_t api_rows_count(const api_rows *r)
{
    return (uint64_t)vertex_rows(r) + triangle_rows(r);
}

/* --- preparing to write the rows --- */

he_status api_rows_draw(api_rows *r, const he_mesh *mesh, uint64_t most, he_error *err)
{
    if (r->base == 0) {
        return he_draw_arrays_init(&r->drawing, mesh, &r->frame, err);
    }
    he_ids faces = {0};
    he_status status = he_ids_reserve(&faces, r->slot_ids.count, err);
    for (size_t i = 0; i < r->slot_ids.count && status == HE_OK; i++) {
        if ((r->owner[i] & HE_DRAW_SLOT_DEAD) == 0) {
            faces.ids[faces.count++] = r->owner[i];
        }
    }
    if (status == HE_OK) {
        status = he_ids_sort(&faces, err);
    }
    if (status == HE_OK) {
        status = he_draw_arrays_init_faces(&r->drawing, mesh, &r->frame, faces.ids, faces.count,
                                           most, err);
    }
    he_ids_clear(&faces);
    return status;
}

/* --- writing the rows --- */

static uint64_t ids_bytes(const api_rows *r, uint32_t rows)
{
    return r->base == 0 ? 0 : (uint64_t)(rows + IDS_A_ROW - 1) / IDS_A_ROW * ROW;
}

static uint64_t part_bytes(const api_rows *r, uint32_t rows)
{
    return ids_bytes(r, rows) + (uint64_t)rows * ROW;
}

int64_t api_rows_bytes(const api_rows *r)
{
    return (int64_t)(HEADER + part_bytes(r, vertex_rows(r)) + part_bytes(r, triangle_rows(r)));
}

static void put_u32(api_rows *r, uint32_t value)
{
    for (unsigned i = 0; i < 4; i++) {
        r->buffer[r->end++] = (unsigned char)(value >> 8 * i);
    }
}

static void put_u64(api_rows *r, uint64_t value)
{
    put_u32(r, (uint32_t)value);
    put_u32(r, (uint32_t)(value >> 32));
}

static void put_double(api_rows *r, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(r, bits);
}

static bool put_header(api_rows *r)
{
    if (r->next++ > 0) {
        return false;
    }
    memcpy(r->buffer + r->end, "HEDG", 4);
    r->end += 4;
    put_u32(r, VERSION);
    put_u64(r, r->revision);
    put_u64(r, r->base);
    put_u64(r, part_bytes(r, vertex_rows(r)));
    put_u64(r, part_bytes(r, triangle_rows(r)));
    put_u32(r, r->vertices);
    put_u32(r, r->triangles);
    put_double(r, r->frame.origin.x);
    put_double(r, r->frame.origin.y);
    put_double(r, r->frame.origin.z);
    put_double(r, r->frame.scale);
    put_u64(r, r->layout);
    put_u32(r, vertex_rows(r));
    put_u32(r, triangle_rows(r));
    return true;
}

static bool put_ids(api_rows *r, const he_ids *list)
{
    if (r->base == 0 || r->next >= list->count) {
        return false;
    }
    for (int i = 0; i < IDS_A_ROW; i++, r->next++) {
        put_u32(r, r->next < list->count ? list->ids[r->next] : 0);
    }
    return true;
}

static bool put_vertex(api_rows *r)
{
    if (r->next == vertex_rows(r)) {
        return false;
    }
    float row[HE_DRAWN_ROW];
    he_draw_arrays_vertex(&r->drawing, r->base == 0 ? r->next : r->vertex_ids.ids[r->next], row);
    r->next++;
    for (unsigned i = 0; i < HE_DRAWN_ROW; i++) {
        uint32_t bits;
        memcpy(&bits, &row[i], sizeof bits);
        put_u32(r, bits);
    }
    return true;
}

/* Writes the row of a triangle. The slots of a face are consecutive, so the triangulation of the
 * face is computed only once. */
static bool put_triangle(api_rows *r)
{
    if (r->next == triangle_rows(r)) {
        return false;
    }
    uint32_t row[HE_DRAWN_ROW] = {0}, face = r->owner[r->next++];
    if ((face & HE_DRAW_SLOT_DEAD) == 0) {
        if (r->walk.left == 0) {
            he_draw_arrays_begin(&r->drawing, face, &r->walk);
        }
        he_draw_arrays_next(&r->drawing, &r->walk, row);
    }
    for (unsigned i = 0; i < HE_DRAWN_ROW; i++) {
        put_u32(r, row[i]);
    }
    return true;
}

/* Writes the next piece of the present part of the answer: the header, four row numbers, or a row.
 * Returns false if the part has ended. */
static bool put(api_rows *r)
{
    switch (r->part) {
    case IN_HEADER:
        return put_header(r);
    case VERTEX_IDS:
        return put_ids(r, &r->vertex_ids);
    case VERTICES:
        return put_vertex(r);
    case SLOT_IDS:
        return put_ids(r, &r->slot_ids);
    default:
        return put_triangle(r);
    }
}

static void fill(api_rows *r)
{
    r->begin = r->end = 0;
    while (r->part != AT_END && r->end + HEADER <= sizeof r->buffer) {
        if (!put(r)) {
            r->part++;
            r->next = 0;
        }
    }
}

size_t api_rows_read(api_rows *r, char *buffer, size_t size)
{
    if (r->begin == r->end) {
        fill(r);
    }
    size_t length = r->end - r->begin < size ? r->end - r->begin : size;
    memcpy(buffer, r->buffer + r->begin, length);
    r->begin += length;
    return length;
}
