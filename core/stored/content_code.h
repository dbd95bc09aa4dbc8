/* content_code.h - the constants of a coded content (stored.h) and of its arrays. Only core/stored
 * uses it. */
#ifndef HE_STORED_CONTENT_CODE_H
#define HE_STORED_CONTENT_CODE_H

#include "mesh/layout.h"

#define HE_CONTENT_MAGIC UINT32_C(0x67646568) /* "hedg" */

enum {
    HE_CONTENT_START = 4 + 4 + 8,                  /* magic, version, bytes of the header */
    HE_CONTENT_HEADER = HE_CONTENT_START + 10 * 4, /* the last word is zero */
    HE_CONTENT_SLOT = 1 + 8,                       /* kind and length of a slot */
    HE_CONTENT_ARRAYS = 7,                         /* arrays before the rows of attributes */
    HE_PART_HEAD = 1 + 4                           /* coding and length of a part */
};

enum { HE_SLOT_EMPTY = 0, HE_SLOT_ATTRIBUTE = 1, HE_SLOT_MATERIAL = 2 };

/* The base of the differences in HE_CODING_LINKS. HE_LINKS_BY_ROW: the row of the link, for links
 * from half-edge to half-edge, which are near each other along a face. HE_LINKS_BY_LAST: the link
 * before it in the array; the row if there is none in the part. */
typedef enum he_links { HE_NO_LINKS, HE_LINKS_BY_ROW, HE_LINKS_BY_LAST } he_links;

/* One of the arrays of a content, in their stored order; it has a row for each issued element. */
typedef struct he_content_array {
    unsigned char *bytes;
    size_t size;
    he_links links;
} he_content_array;

static inline he_content_array he_content_array_at(he_content *c, size_t i)
{
    size_t v = c->vertices.issued, h = 2 * (size_t)c->edges.issued, f = c->faces.issued;
    size_t word = sizeof(uint32_t);
    const he_content_array arrays[HE_CONTENT_ARRAYS] = {
        {(unsigned char *)c->position, v * sizeof(he_vec3), HE_NO_LINKS},
        {(unsigned char *)c->vertex_halfedge, v * word, HE_LINKS_BY_LAST},
        {(unsigned char *)c->next, h * word, HE_LINKS_BY_ROW},
        {(unsigned char *)c->prev, h * word, HE_LINKS_BY_ROW},
        {(unsigned char *)c->origin, h * word, HE_LINKS_BY_LAST},
        {(unsigned char *)c->face, h * word, HE_LINKS_BY_LAST},
        {(unsigned char *)c->face_halfedge, f * word, HE_LINKS_BY_LAST},
    };
    return arrays[i];
}

/* Returns the number of bytes of all arrays of a content together. */
static inline uint64_t he_content_array_bytes(const he_content *c)
{
    return (uint64_t)c->vertices.issued * (sizeof(he_vec3) + sizeof(uint32_t)) +
           (uint64_t)c->edges.issued * 8 * sizeof(uint32_t) +
           (uint64_t)c->faces.issued * sizeof(uint32_t);
}

#endif
