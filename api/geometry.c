/* GET .../geometry: the arrays from which a renderer draws a mesh, made as they are pulled from a
 * snapshot. All values are little-endian.
 *
 *     0   4   "HEDG"
 *     4   u32 version of this layout, 1
 *     8   u64 revision
 *     16  u64 revision that these rows are a change of, 0: of none, they are all
 *     24  u64 bytes of vertices, then u64 bytes of triangles
 *     40  u32 rows of vertices, then u32 rows of triangles
 *     48  f64 x 3 origin, f64 scale: (position - origin) * scale is what a vertex holds
 *     80  u64 zero, twice
 *     96  vertices, f32 x 4, then triangles, u32 x 4: see query/drawing.h
 *
 * Each part begins at a multiple of 16. */
#include "api/handlers.h"

#include "query/drawing.h"

#include <string.h>

enum { HEADER = 96, VERSION = 1, ROW = 16, ROWS = 1024 };

/* A snapshot with what is drawn of it; freed with the exchange. */
typedef struct geometry {
    const api_store *store;
    api_snapshot *snapshot;
    he_drawing drawing;
    uint32_t vertices, next; /* rows, and the one to come */
    he_drawing_walk walk;
    size_t begin, end; /* of what is not sent yet in the buffer */
    unsigned char buffer[ROWS * ROW];
} geometry;

static void free_geometry(void *stream)
{
    geometry *g = stream;
    he_drawing_clear(&g->drawing);
    if (g->snapshot != NULL) {
        g->store->snapshot_release(g->store->self, g->snapshot);
    }
    he_mem_free(g);
}

static void put_u32(geometry *g, uint32_t value)
{
    for (unsigned i = 0; i < 4; i++) {
        g->buffer[g->end++] = (unsigned char)(value >> 8 * i);
    }
}

static void put_u64(geometry *g, uint64_t value)
{
    put_u32(g, (uint32_t)value);
    put_u32(g, (uint32_t)(value >> 32));
}

static void put_double(geometry *g, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(g, bits);
}

static void put_header(geometry *g, uint64_t revision)
{
    const he_frame *frame = &g->drawing.frame;
    memcpy(g->buffer, "HEDG", 4);
    g->end = 4;
    put_u32(g, VERSION);
    put_u64(g, revision);
    put_u64(g, 0);
    put_u64(g, (uint64_t)g->vertices * ROW);
    put_u64(g, (uint64_t)g->drawing.triangles * ROW);
    put_u32(g, g->vertices);
    put_u32(g, g->drawing.triangles);
    put_double(g, frame->origin.x);
    put_double(g, frame->origin.y);
    put_double(g, frame->origin.z);
    put_double(g, frame->scale);
    put_u64(g, 0);
    put_u64(g, 0);
}

static bool put_vertex(geometry *g)
{
    float row[HE_DRAWN_ROW];
    if (g->next == g->vertices) {
        return false;
    }
    he_drawing_vertex(&g->drawing, g->next++, row);
    for (unsigned i = 0; i < HE_DRAWN_ROW; i++) {
        uint32_t bits;
        memcpy(&bits, &row[i], sizeof bits);
        put_u32(g, bits);
    }
    return true;
}

static bool put_triangle(geometry *g)
{
    uint32_t row[HE_DRAWN_ROW];
    if (!he_drawing_next(&g->drawing, &g->walk, row)) {
        return false;
    }
    for (unsigned i = 0; i < HE_DRAWN_ROW; i++) {
        put_u32(g, row[i]);
    }
    return true;
}

static int64_t read_geometry(void *stream, char *buffer, size_t size)
{
    geometry *g = stream;
    if (g->begin == g->end) {
        g->begin = g->end = 0;
        while (g->end < sizeof g->buffer && (put_vertex(g) || put_triangle(g))) {
        }
    }
    size_t length = g->end - g->begin < size ? g->end - g->begin : size;
    memcpy(buffer, g->buffer + g->begin, length);
    g->begin += length;
    return (int64_t)length;
}

static void answer(api_exchange *x, geometry *g, const he_mesh *mesh)
{
    he_error err = {0};
    if (api_not_modified(x, "geometry")) {
        free_geometry(g);
        return;
    }
    if (he_drawing_init(&g->drawing, mesh, &err) != HE_OK) {
        free_geometry(g);
        api_fail_core(x, &err);
        return;
    }
    g->vertices = he_mesh_issued(mesh, HE_VERTEX);
    put_header(g, x->info.revision);
    int64_t length = HEADER + ((int64_t)g->vertices + g->drawing.triangles) * ROW;
    api_answer_stream(x, 200, "application/octet-stream", length, read_geometry, g, free_geometry);
}

void api_geometry_get(api_exchange *x)
{
    const he_mesh *mesh;
    if (api_not_modified_yet(x, "geometry")) {
        return;
    }
    geometry *g = he_mem_zero(1, sizeof *g);
    if (g == NULL) {
        api_fail_memory(x);
        return;
    }
    g->store = x->store;
    g->snapshot = api_snapshot_of(x, &mesh);
    if (g->snapshot == NULL) {
        free_geometry(g);
        return;
    }
    answer(x, g, mesh);
}
