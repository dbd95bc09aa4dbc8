/* members.h - gathers members of an object that arrives in pieces, as the text of a control
 * document.
 *
 * Members of a mesh document that are not lists of numbers ("name", the definition of an attribute,
 * materials) are small and are read with json_in.h. While they arrive, their tokens are checked
 * (json_scan.h), and their bytes are kept unchanged: "{" and each member, up to `most` bytes. */
#ifndef HE_API_DOCUMENT_MEMBERS_H
#define HE_API_DOCUMENT_MEMBERS_H

#include "api/json/json_scan.h"
#include "api/json/text.h"

/* The members gathered so far. The caller initializes `what`, `most` and `values_most`. */
typedef struct api_members {
    /* What the members are called in the message of a refusal, such as "materials". */
    const char *what;
    size_t most, values_most;

    api_text text;
    size_t values;
    /* --- about the member that is being gathered --- */
    /* First byte that is still to be appended of the piece that the lexer reads now; NULL: the
     * first byte of that piece. */
    const char *from;
    size_t depth, name_most;
} api_members;

void api_members_clear(api_members *m);
/* Drops the gathered members. */
void api_members_empty(api_members *m);

/* Begins to gather a member, and appends its name. The lexer must have passed the colon after the
 * name. */
bool api_members_begin(api_members *m, he_lexer *x, api_problem *problem);
/* Appends the value of the member; sets `*done` to false if the piece ended before the value
 * did. */
bool api_members_feed(api_members *m, he_lexer *x, bool *done, api_problem *problem);
/* Parses all members that were gathered, as one object. */
bool api_members_parse(api_members *m, api_document *out, api_in *root, api_problem *problem);

#endif
