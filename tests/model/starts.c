#include "model/starts.h"

#include "model/corpus.h"
#include "model/shapes.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct family {
    const char *name;
    uint32_t weight;
    void (*fill)(or_mesh *o, md_random *r);
    bool far;
} family;

static const family families[] = {
    {"mixed", 30, md_fill_mixed, false},
    {"closed_triangles", 10, md_fill_closed_triangles, false},
    {"open_triangles", 8, md_fill_open_triangles, false},
    {"quads", 8, md_fill_quads, false},
    {"polygons", 8, md_fill_polygons, false},
    {"genus_2", 8, md_fill_genus_2, false},
    {"components", 6, md_fill_components, false},
    {"bowties", 6, md_fill_bowties, false},
    {"fan_1000", 3, md_fill_fan_1000, false},
    {"triangle", 2, md_fill_triangle, false},
    {"doubled_square", 2, md_fill_doubled_square, false},
    {"tetrahedron", 3, md_fill_tetrahedron, false},
    {"far", 2, md_fill_far, true},
};

enum { FAMILIES = sizeof families / sizeof *families, CORPUS_WEIGHT = 10 };

md_starts md_starts_find(void)
{
    md_starts found = {.count = FAMILIES};
    md_file *files = NULL;
    found.files = md_corpus_read(&files);
    found.count += found.files;
    found.start = calloc(found.count, sizeof *found.start);
    assert(found.start != NULL);
    double sum = found.files > 0 ? CORPUS_WEIGHT : 0;
    for (size_t i = 0; i < FAMILIES; i++) {
        sum += families[i].weight;
    }
    for (size_t i = 0; i < FAMILIES; i++) {
        md_start *s = &found.start[i];
        (void)snprintf(s->name, sizeof s->name, "%s", families[i].name);
        s->share = families[i].weight / sum;
        s->fill = families[i].fill;
        s->far = families[i].far;
    }
    for (size_t i = 0; i < found.files; i++) {
        md_start *s = &found.start[FAMILIES + i];
        memcpy(s->name, files[i].name, sizeof s->name);
        s->share = CORPUS_WEIGHT / sum / (double)found.files;
        s->file = files[i].mesh;
    }
    free(files);
    return found;
}

void md_starts_clear(md_starts *starts)
{
    for (size_t i = 0; i < starts->count; i++) {
        he_mesh_free(starts->start[i].file);
    }
    free(starts->start);
    *starts = (md_starts){.count = 0};
}

he_mesh *md_begin(const md_start *start, or_mesh *o, md_random *r)
{
    he_mesh *copy = NULL;
    if (start->file == NULL) {
        md_shape(o, r, start->fill);
        return md_build(o);
    }
    md_take(o, start->file);
    return he_mesh_copy(start->file, &copy, NULL) == HE_OK ? copy : NULL;
}
