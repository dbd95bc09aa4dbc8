#include "format/stl/stl.h"

#include "format/io/export.h"
#include "format/io/export_triangles.h"
#include "format/io/weld.h"
#include "format/text/number.h"

#include <math.h>
#include <string.h>

/* The parts of an STL document, in the order in which they are written. */
typedef enum part { HEADER, FACETS, END } part;

enum { HEADER_BYTES = 80 };

typedef struct stl_writer {
    const he_mesh *mesh;
    bool text;
    he_export_triangles cuts;
    he_export_triangle_walk walk;
    part part;
    uint32_t stop; /* the face before which a piece of the document ends; HE_NONE: no piece */
} stl_writer;

static void stl_close(void *state)
{
    stl_writer *w = state;
    he_export_triangles_clear(&w->cuts);
    he_mem_free(w);
}

/* --- warnings, which are found before the first byte is written --- */

static void note_cuts(const he_export_triangles *cuts, he_warnings *warnings)
{
    he_warnings_add_count(warnings, "triangulated",
                          "a face is cut into triangles, because STL files hold only triangles",
                          cuts->polygons);
    he_warnings_add_count(warnings, "turned_triangles",
                          "a face is cut into triangles of which some have no area or are "
                          "reversed, because no better cut was found",
                          cuts->turned);
}

/* The mesh that a reader will make of the file, in which vertices at equal positions are merged.
 * The writer makes it in order to warn about differences from the mesh that is written. */
typedef struct again {
    he_soup soup;
    he_weld weld;
    /* The vertex of the soup to which each vertex of the mesh is merged. */
    uint32_t *vertex;
    uint64_t isolated, used;
} again;

static he_status weld_vertices(const stl_writer *w, again *a, he_warnings *warnings, he_error *err)
{
    const he_content *c = &w->mesh->c;
    he_narrowed narrowed = {0};
    he_status status = HE_OK;
    for (uint32_t v = 0; v < c->vertices.issued && status == HE_OK; v++) {
        status = he_progress_at(a->soup.limits.progress, v, c->vertices.issued, err);
        if (status != HE_OK || !he_vertex_is_live(w->mesh, (he_vertex){v})) {
            continue;
        }
        if (he_is_isolated(w->mesh, (he_vertex){v})) {
            a->isolated++;
            continue;
        }
        he_vec3 p = c->position[v];
        if (!w->text) {
            he_narrowed_add(&narrowed, v, p);
            p = (he_vec3){he_narrow(p.x), he_narrow(p.y), he_narrow(p.z)};
        }
        a->used++;
        status = he_weld_vertex(&a->weld, &a->soup, p, &a->vertex[v], err);
    }
    return status == HE_OK ? he_narrowed_finish(&narrowed, warnings, err) : status;
}

/* Counts the defects for which a reader will refuse the facets. The defects arise because
 * vertices at equal positions are merged, or because two faces were cut along the same diagonal. */
static he_status try_facets(const stl_writer *w, again *a, uint64_t *defects, he_error *err)
{
    he_export_triangle_walk walk = {0};
    uint32_t v[3];
    he_status status = HE_OK;
    while (status == HE_OK && he_export_triangles_next(&w->cuts, &walk, v)) {
        for (size_t i = 0; i < 3; i++) {
            v[i] = a->vertex[v[i]];
        }
        status = he_soup_add_face(&a->soup, v, 3, err);
    }
    return status == HE_OK ? he_build_try(&a->soup, defects, err) : status;
}

/* Adds warnings about how the mesh will differ when the file is read again. */
static he_status note_differences(const stl_writer *w, again *a, he_warnings *warnings,
                                  he_error *err)
{
    uint64_t defects = 0;
    a->vertex = he_mem_array(NULL, w->mesh->c.vertices.issued, sizeof *a->vertex);
    if (a->vertex == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to number %u vertices",
                             w->mesh->c.vertices.issued);
    }
    he_status status = weld_vertices(w, a, warnings, err);
    uint64_t merged = a->used - a->soup.vertex_count;
    if (status == HE_OK && (merged > 0 || w->cuts.polygons > 0)) {
        status = try_facets(w, a, &defects, err);
    }
    if (status == HE_OK) {
        he_warnings_add_count(warnings, "isolated_vertices",
                              "a vertex is not written, because it belongs to no face",
                              a->isolated);
        he_warnings_add_count(warnings, "merged",
                              "a vertex will be merged with another when the file is read, because "
                              "both have the same position",
                              merged);
        he_warnings_add_count(
            warnings, "no_mesh_again",
            "a facet or vertex will be refused when the file is read without repairs, because "
            "merged vertices and cut faces leave no valid mesh there",
            defects);
    }
    return status;
}

static he_status note_again(const stl_writer *w, he_progress *progress, he_warnings *warnings,
                            he_error *err)
{
    again a = {.vertex = NULL};
    he_soup_init(&a.soup, &(he_limits){.progress = progress});
    he_status status = note_differences(w, &a, warnings, err);
    he_weld_clear(&a.weld);
    he_soup_clear(&a.soup);
    he_mem_free(a.vertex);
    return status;
}

static he_status stl_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    stl_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the STL file");
    }
    w->mesh = mesh;
    w->text = encoding != 0;
    w->stop = HE_NONE;
    he_status status = he_export_triangles_make(mesh, progress, &w->cuts, err);
    if (status == HE_OK) {
        note_cuts(&w->cuts, warnings);
        status = note_again(w, progress, warnings, err);
    }
    if (status != HE_OK) {
        stl_close(w);
        return status;
    }
    he_export_note_lost(mesh, NULL, 0, warnings);
    he_export_note_materials(mesh, warnings);
    *state = w;
    return HE_OK;
}

/* --- facets --- */

static he_vec3 minus(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double largest(he_vec3 p)
{
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
}

static he_vec3 scaled(he_vec3 p, double factor)
{
    return (he_vec3){p.x * factor, p.y * factor, p.z * factor};
}

/* Returns the unit normal of a triangle; the zero vector if the triangle has no area. Lengths are
 * scaled, so that nothing overflows or underflows. */
static he_vec3 normal_of(const he_vec3 *p)
{
    he_vec3 quarter[3] = {scaled(p[0], 0.25), scaled(p[1], 0.25), scaled(p[2], 0.25)};
    he_vec3 a = minus(quarter[1], quarter[0]), b = minus(quarter[2], quarter[0]);
    double size_a = largest(a), size_b = largest(b);
    if (size_a == 0 || size_b == 0) {
        return (he_vec3){0, 0, 0};
    }
    a = (he_vec3){a.x / size_a, a.y / size_a, a.z / size_a};
    b = (he_vec3){b.x / size_b, b.y / size_b, b.z / size_b};
    he_vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    double length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    length = length == 0 ? 1 : length;
    return (he_vec3){n.x / length + 0.0, n.y / length + 0.0, n.z / length + 0.0}; /* -0 becomes 0 */
}

/* Writes three numbers in text: with all digits of doubles if `all` is set, else with the digits
 * of floats. */
static char *put_numbers(he_vec3 v, bool all, char *p)
{
    const double values[3] = {v.x, v.y, v.z};
    for (unsigned i = 0; i < 3; i++) {
        *p++ = ' ';
        p += all ? he_double_print(values[i], p) : he_float_print((float)values[i], p);
    }
    *p++ = '\n';
    return p;
}

static char *write_text(const he_vec3 *corners, char *p)
{
    p = put_numbers(normal_of(corners), false, he_export_text("facet normal", p));
    p = he_export_text("outer loop\n", p);
    for (unsigned i = 0; i < 3; i++) {
        p = put_numbers(corners[i], true, he_export_text("vertex", p));
    }
    return he_export_text("endloop\nendfacet\n", p);
}

static char *put_word(uint32_t value, char *p)
{
    for (unsigned shift = 0; shift < 32; shift += 8) {
        *p++ = (char)(unsigned char)(value >> shift);
    }
    return p;
}

static char *put_floats(he_vec3 v, char *p)
{
    const double values[3] = {v.x, v.y, v.z};
    for (unsigned i = 0; i < 3; i++) {
        float value = he_narrow(values[i]);
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        p = put_word(bits, p);
    }
    return p;
}

static char *write_binary(const he_vec3 *corners, char *p)
{
    p = put_floats(normal_of(corners), p);
    for (unsigned i = 0; i < 3; i++) {
        p = put_floats(corners[i], p);
    }
    *p++ = 0;
    *p++ = 0;
    return p;
}

static char *write_header(const stl_writer *w, char *p)
{
    if (w->text) {
        return he_export_text("solid\n", p);
    }
    const he_content *c = &w->mesh->c;
    uint32_t corners = 2 * c->edges.live - c->boundary_halfedges;
    char *end = p + HEADER_BYTES;
    p = he_export_text("binary STL", p); /* must not begin with "solid" */
    memset(p, 0, (size_t)(end - p));
    return put_word(corners - 2 * c->faces.live, end);
}

static char *write_facets(stl_writer *w, char *p, const char *end)
{
    while (end - p >= HE_WRITE_ROOM) {
        uint32_t v[3];
        if (w->walk.face >= w->stop || !he_export_triangles_next(&w->cuts, &w->walk, v)) {
            w->part = END;
            return w->text && w->stop == HE_NONE ? he_export_text("endsolid\n", p) : p;
        }
        const he_vec3 *position = w->mesh->c.position;
        he_vec3 corners[3] = {position[v[0]], position[v[1]], position[v[2]]};
        p = w->text ? write_text(corners, p) : write_binary(corners, p);
    }
    return p;
}

static bool stl_step(void *state, char **p, const char *end)
{
    stl_writer *w = state;
    switch (w->part) {
    case HEADER:
        *p = write_header(w, *p);
        w->part = FACETS;
        break;
    case FACETS:
        *p = write_facets(w, *p, end);
        break;
    case END:
        break;
    }
    return w->part != END;
}

/* Ends a piece before a live face or at the end, because the walk passes dead faces only when it
 * looks for the next triangle. */
static bool stl_cut(void *state, void *piece, uint32_t rows)
{
    stl_writer *w = state, *out = piece;
    uint32_t count = w->mesh->c.faces.issued, first = w->walk.face;
    if (w->part != FACETS || w->walk.left > 0 || first >= count) {
        return false;
    }
    uint32_t stop = count - first < rows ? count : first + rows;
    while (stop < count && !he_face_is_live(w->mesh, (he_face){stop})) {
        stop++;
    }
    *out = *w;
    out->stop = stop;
    he_export_triangles_skip(&w->cuts, &w->walk, stop);
    return true;
}

const he_writing he_stl_writing = {
    .open = stl_open,
    .step = stl_step,
    .close = stl_close,
    .cut = stl_cut,
    .state_bytes = sizeof(stl_writer),
    .cuts = true,
};
