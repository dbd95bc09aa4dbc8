/* mirror.h - a client's copy of a mesh: plain tables, filled from a dump and updated by events.
 *
 * The copy derives nothing by itself: what an event does not contain is missing from the copy, so a
 * comparison with the mesh shows it. */
#ifndef TESTS_MIRROR_H
#define TESTS_MIRROR_H

#include "mesh/mesh.h"

#include <cjson/cJSON.h>

enum { MIRROR_TEXT = 200, MIRROR_LINKS = 4, MIRROR_COMPONENTS = 16 };

/* A row of the copy. A vertex has the link half-edge, a half-edge has next, prev, origin and face,
 * a face has half-edge; a vertex also has a position. */
typedef struct mirror_row {
    bool live;
    double position[3];
    uint32_t link[MIRROR_LINKS]; /* HE_NONE for null */
} mirror_row;

typedef struct mirror_table {
    mirror_row *rows;
    size_t count;
} mirror_table;

typedef struct mirror_column {
    he_kind domain;
    char name[64];
    size_t components, rows;
    bool single; /* the values are floats, else doubles */
    double fallback[MIRROR_COMPONENTS];
    char *labels;    /* one per line; NULL: none */
    double *values;  /* one per row; rows beyond the end have the default */
    size_t capacity; /* number of rows allocated */
} mirror_column;

typedef struct mirror {
    uint64_t revision;
    mirror_table tables[HE_KIND_COUNT]; /* for vertices, half-edges and faces */
    mirror_column *columns;
    size_t column_count;
    char *materials; /* the table as text, one line per row; NULL: empty */
} mirror;

void mirror_clear(mirror *m);
/* Copies `mesh` at `revision`. */
void mirror_take(mirror *m, const he_mesh *mesh, uint64_t revision);
/* Adds an element from one line of GET .../vertices, .../halfedges or .../faces. */
void mirror_add_line(mirror *m, he_kind kind, const cJSON *element);
/* Adds an attribute as GET .../attributes lists it; mirror_add_values adds its values, from pages
 * of GET .../attributes/{domain}/{name}. */
void mirror_add_attribute(mirror *m, const cJSON *attribute);
void mirror_add_values(mirror *m, he_kind domain, const char *name, const cJSON *page);
/* Sets the table of materials from the list of GET .../materials. */
void mirror_set_materials(mirror *m, const cJSON *list);

typedef enum mirror_step {
    MIRROR_APPLIED,
    MIRROR_KNOWN, /* the copy already had this revision */
    MIRROR_LOST   /* the copy lacks a revision before this one: fetch the mesh again */
} mirror_step;

/* Applies the data of an `edit` event to the copy. Fails the test if the sets in it contradict the
 * copy. */
mirror_step mirror_apply(mirror *m, const cJSON *data);

/* Returns whether all links and values of two copies are equal; if not, `text` names the
 * difference. */
bool mirror_equal(const mirror *a, const mirror *b, char text[MIRROR_TEXT]);

/* Returns the first live element from `from` on, wrapping around at the end; HE_NONE if there is
 * none. Edges are found by their half-edges. */
uint32_t mirror_live(const mirror *m, he_kind kind, uint32_t from);
size_t mirror_count(const mirror *m, he_kind kind);

#endif
