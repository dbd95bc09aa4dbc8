/* mirror.h - a client's own copy of a mesh: plain tables, filled from a dump and kept by events.
 *
 * It knows nothing of half-edges: what an event does not say, it does not have. */
#ifndef TESTS_MIRROR_H
#define TESTS_MIRROR_H

#include "mesh/mesh.h"

#include <cjson/cJSON.h>

enum { MIRROR_TEXT = 200, MIRROR_LINKS = 4, MIRROR_COMPONENTS = 16 };

/* A vertex: position and half-edge; a half-edge: next, prev, origin, face; a face: half-edge. */
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
    bool single; /* numbers are floats */
    double fallback[MIRROR_COMPONENTS];
    char *labels;    /* a line each; NULL where it has none */
    double *values;  /* of rows; beyond them the default */
    size_t capacity; /* rows that there is room for */
} mirror_column;

typedef struct mirror {
    uint64_t revision;
    mirror_table tables[HE_KIND_COUNT]; /* of vertices, half-edges and faces */
    mirror_column *columns;
    size_t column_count;
    char *materials; /* the table as text, a line a row; NULL where it is empty */
} mirror;

void mirror_clear(mirror *m);
/* What `mesh` holds, at `revision`. */
void mirror_take(mirror *m, const he_mesh *mesh, uint64_t revision);
/* A line of the collection of a kind. */
void mirror_add_line(mirror *m, he_kind kind, const cJSON *element);
/* One of GET .../attributes; its values come by pages of GET .../attributes/{domain}/{name}. */
void mirror_add_attribute(mirror *m, const cJSON *attribute);
void mirror_add_values(mirror *m, he_kind domain, const char *name, const cJSON *page);
/* The list of GET .../materials. */
void mirror_set_materials(mirror *m, const cJSON *list);

typedef enum mirror_step {
    MIRROR_APPLIED,
    MIRROR_KNOWN, /* a revision it has */
    MIRROR_LOST   /* stale, or not of its revision: it must be taken anew */
} mirror_step;

/* The data of an `edit`. Fails the test where the sets contradict the copy. */
mirror_step mirror_apply(mirror *m, const cJSON *data);

/* Link for link, value for value? `text` names what differs. */
bool mirror_equal(const mirror *a, const mirror *b, char text[MIRROR_TEXT]);

/* The first live element from `from` on, then from the start; HE_NONE when there is none. Edges
 * are looked up as half-edges. */
uint32_t mirror_live(const mirror *m, he_kind kind, uint32_t from);
size_t mirror_count(const mirror *m, he_kind kind);

#endif
