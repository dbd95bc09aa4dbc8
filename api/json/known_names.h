/* known_names.h - makes the end of a message that refuses an unknown name: which names exist.
 *
 *     api_known_names known = {.wanted = "split_edge"};
 *     for each name that exists {
 *         api_known_names_add(&known, name);
 *     }
 *     "there is no operation \"split_edge\"%s", api_known_names_text(&known)
 *
 * api_known_names_text returns one of three endings:
 *
 *     ; did you mean "edge_split"?     one name is like the wanted one
 *     ; there are obj, off, ply        else, as many names as fit, with "..." for others
 *     (nothing)                        no name was added */
#ifndef HE_API_JSON_KNOWN_NAMES_H
#define HE_API_JSON_KNOWN_NAMES_H

#include <stddef.h>

enum { API_KNOWN_TEXT = 200 };

/* The unknown name that was wanted, and a summary of the names that exist. The caller sets `wanted`
 * only; all names are borrowed. */
typedef struct api_known_names {
    const char *wanted;
    /* The existing name that is most like `wanted`; NULL: no name is like it. */
    const char *nearest;
    size_t distance; /* api_name_distance between `wanted` and `nearest` */
    char list[API_KNOWN_TEXT];
    size_t length;
    size_t left_out;
    char text[API_KNOWN_TEXT + 64];
} api_known_names;

void api_known_names_add(api_known_names *known, const char *name);
/* Returns the end of the message, which lives as long as `known`. */
const char *api_known_names_text(api_known_names *known);

/* Returns how many letters must be inserted, removed, replaced or exchanged with their neighbour to
 * turn one name into the other (optimal string alignment: Boytsov, Indexing methods for approximate
 * dictionary searching, 2011, section 2.1). Returns 1 if both have the same words, separated by
 * '_', in another order. Returns SIZE_MAX for names of more than 64 bytes. */
size_t api_name_distance(const char *a, const char *b);

#endif
