/* mirror.h - a client's copy of a mesh: plain tables that are filled by reading the whole mesh and
 * then updated by events.
 *
 * The copy derives nothing by itself. What an event does not contain is missing from the copy, so
 * that a comparison with the mesh shows what is missing. */
#ifndef TESTS_MIRROR_H
#define TESTS_MIRROR_H

#include "mesh/mesh.h"

#include <cjson/cJSON.h>

enum { MIRROR_TEXT = 200, MIRROR_LINKS = 4, MIRROR_COMPONENTS = 16 };

/* A row of the copy, for one element. The links of a vertex are its half-edge; those of a half-edge
 * are next, prev, origin and face; those of a face are its half-edge. Only vertices have a
 * position. */
typedef struct mirror_row {
    bool live;
    double position[3];
    /* Ids of the elements that the row's element links to; HE_NONE if a link is null. */
    uint32_t link[MIRROR_LINKS];
} mirror_row;

typedef struct mirror_table {
    mirror_row *rows;
    size_t count;
} mirror_table;

typedef struct mirror_column {
    he_kind domain;
    char name[64];
    size_t components, rows;
    bool single; /* true if the values are floats, false if they are doubles */
    double fallback[MIRROR_COMPONENTS];
    char *labels;    /* the labels of the values, one per line; NULL: none */
    double *values;  /* values of the rows; elements with an id beyond the last row have the values
                        in `fallback` */
    size_t capacity; /* number of rows allocated */
} mirror_column;

typedef struct mirror {
    uint64_t revision;
    /* one table of rows for each kind of element; the table of edges is not used */
    mirror_table tables[HE_KIND_COUNT];
    mirror_column *columns;
    size_t column_count;
    char *materials; /* the table of materials as text, one line per row; NULL: empty */
} mirror;

void mirror_clear(mirror *m);
/* Makes a copy of `mesh`; `revision` is the revision of the mesh. */
void mirror_take(mirror *m, const he_mesh *mesh, uint64_t revision);
/* Adds an element from one line of GET .../vertices, .../halfedges or .../faces. */
void mirror_add_line(mirror *m, he_kind kind, const cJSON *element);
/* Adds an attribute as GET .../attributes lists it; mirror_add_values adds its values, from pages
 * of GET .../attributes/{domain}/{name}. */
void mirror_add_attribute(mirror *m, const cJSON *attribute);
void mirror_add_values(mirror *m, he_kind domain, const char *name, const cJSON *page);
/* Replaces the table of materials by the list that GET .../materials answers. */
void mirror_set_materials(mirror *m, const cJSON *list);

typedef enum mirror_step {
    MIRROR_APPLIED,
    MIRROR_KNOWN, /* the copy already had the revision of the event */
    MIRROR_LOST   /* the copy lacks an earlier revision, so the client must fetch the whole mesh */
} mirror_step;

/* Applies the data of an `edit` event to the copy. Fails the test if the sets of elements in the
 * event contradict the copy. */
mirror_step mirror_apply(mirror *m, const cJSON *data);

/* Returns whether two copies are equal in all links, positions and attribute values; if not, `text`
 * describes the first difference. */
bool mirror_equal(const mirror *a, const mirror *b, char text[MIRROR_TEXT]);

/* Returns the first live element in the copy with an id from `from` on, continuing at 0 after the
 * last id; HE_NONE if no element is live. An edge is live if its half-edges are in the copy. */
uint32_t mirror_live(const mirror *m, he_kind kind, uint32_t from);
size_t mirror_count(const mirror *m, he_kind kind);

#endif
