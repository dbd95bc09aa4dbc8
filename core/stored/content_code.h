/* content_code.h - the constants of a stored content (a whole mesh, stored.h), and the list of its
 * arrays. Only core/stored uses it. */
#ifndef HE_STORED_CONTENT_CODE_H
#define HE_STORED_CONTENT_CODE_H

#include "mesh/layout.h"

#define HE_CONTENT_MAGIC UINT32_C(0x67646568) /* "hedg" */

enum {
    HE_CONTENT_START = 4 + 4 + 8, /* bytes of magic, version and header length */
    /* bytes of the start and of ten words of counts, of which the last is zero */
    HE_CONTENT_HEADER = HE_CONTENT_START + 10 * 4,
    /* bytes of the kind and the length that begin a slot */
    HE_CONTENT_SLOT = 1 + 8,
    /* number of arrays that come before those of attributes */
    HE_CONTENT_ARRAYS = 7,
    /* bytes of the coding and the length that stand before a part */
    HE_PART_HEAD = 1 + 4
};

enum { HE_SLOT_EMPTY = 0, HE_SLOT_ATTRIBUTE = 1, HE_SLOT_MATERIAL = 2 };

/* HE_CODING_LINKS stores a link as its difference to a number, which each array of links determines
 * in one of two ways. HE_LINKS_BY_ROW: the row in which the link is stored, because consecutive
 * half-edges of a face mostly have near ids. HE_LINKS_BY_LAST: the link before it in the array, or
 * its row if the part has no link before it.
 */
typedef enum he_links { HE_NO_LINKS, HE_LINKS_BY_ROW, HE_LINKS_BY_LAST } he_links;

/* One of the arrays of a content: it has a row for each issued element of one kind. */
typedef struct he_content_array {
    unsigned char *bytes;
    size_t size;
    he_links links;
} he_content_array;

/* Returns array i of a content, in the order in which the arrays are stored. */
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
