#include "model/corpus.h"

#include "format/io/format.h"
#include "mesh/walk.h"

#include <assert.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A larger mesh would leave no space in the oracle's tables to grow. */
enum { MOST_VERTICES = OR_VERTICES / 2, MOST_FACES = OR_FACES / 3, MOST_BYTES = 1 << 20 };

static char *read_bytes(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    char *bytes = file != NULL ? malloc(MOST_BYTES) : NULL;
    *length = bytes != NULL ? fread(bytes, 1, MOST_BYTES, file) : 0;
    if (file != NULL) {
        (void)fclose(file);
    }
    return bytes;
}

/* Scales the positions into the box from -2 to 2. */
static void fit(he_soup *soup)
{
    he_vec3 low = {INFINITY, INFINITY, INFINITY};
    he_vec3 high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < soup->vertex_count; i++) {
        he_vec3 p = soup->positions[i];
        low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
    double side = fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
    double scale = side > 0 ? 4 / side : 1;
    for (size_t i = 0; i < soup->vertex_count; i++) {
        he_vec3 *p = &soup->positions[i];
        *p = (he_vec3){(p->x - (low.x + high.x) / 2) * scale, (p->y - (low.y + high.y) / 2) * scale,
                       (p->z - (low.z + high.z) / 2) * scale};
    }
}

static he_mesh *mesh_of(const char *bytes, size_t length)
{
    he_reader *reader = NULL;
    he_import import = {0};
    he_mesh *mesh = NULL;
    const he_format *format = he_format_sniff(bytes, length);
    if (format == NULL || he_reader_new(format, NULL, &reader, NULL) != HE_OK) {
        return NULL;
    }
    if (he_reader_feed(reader, bytes, length, NULL) == HE_OK &&
        he_reader_finish(reader, &import, NULL) == HE_OK) {
        fit(&import.soup);
        bool small = import.soup.face_count > 0 && import.soup.face_count <= MOST_FACES &&
                     import.soup.vertex_count <= MOST_VERTICES;
        if (!small || he_build(&import.soup, 0, &mesh, NULL, NULL) != HE_OK) {
            mesh = NULL;
        }
        he_import_clear(&import);
    }
    he_reader_free(reader);
    return mesh;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const md_file *)a)->name, ((const md_file *)b)->name);
}

size_t md_corpus_read(md_file **out)
{
    const char *corpus = getenv("CORPUS");
    char folder[512];
    size_t n = 0;
    (void)snprintf(folder, sizeof folder, "%s/files", corpus != NULL ? corpus : "../shared/corpus");
    DIR *dir = opendir(folder);
    *out = NULL;
    for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;) {
        char path[1024];
        size_t length = 0;
        (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        char *bytes = read_bytes(path, &length);
        he_mesh *mesh = length > 0 ? mesh_of(bytes, length) : NULL;
        free(bytes);
        if (mesh != NULL) {
            *out = realloc(*out, (n + 1) * sizeof **out);
            assert(*out != NULL);
            (void)snprintf((*out)[n].name, MD_START_NAME, "%.*s", MD_START_NAME - 1, entry->d_name);
            (*out)[n++].mesh = mesh;
        }
    }
    if (dir != NULL) {
        (void)closedir(dir);
    }
    if (n > 0) {
        qsort(*out, n, sizeof **out, by_name);
    }
    return n;
}

void md_take(or_mesh *o, const he_mesh *m)
{
    or_empty(o);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        (void)or_add_vertex(o, he_position(m, (he_vertex){v}));
    }
    for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
        uint32_t corners[OR_CORNERS];
        uint32_t n = 0;
        he_halfedge first = he_face_halfedge(m, (he_face){f});
        he_halfedge h = first;
        do {
            assert(n < OR_CORNERS);
            corners[n++] = he_origin(m, h).i;
            h = he_next(m, h);
        } while (h.i != first.i);
        (void)or_add_face(o, corners, n);
    }
    o->faces = o->fresh;
    o->fresh = 0;
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        o->edge[o->edges++] = (or_edge){.alive = true,
                                        .a = he_origin(m, (he_halfedge){2 * e}).i,
                                        .b = he_origin(m, (he_halfedge){2 * e + 1}).i};
    }
    uint64_t wrong = or_derive(o);
    assert(wrong == 0);
    (void)wrong;
}
