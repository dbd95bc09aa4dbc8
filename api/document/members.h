/* members.h - members of an object that comes in pieces, gathered into a control document.
 *
 * What is not a list of numbers ("name", the head of an attribute, materials) is small and read
 * through json_in.h. Its tokens pass the scan (json_scan.h) on their way, and its bytes are kept as
 * they came: "{" and each member, up to `most` bytes. */
#ifndef HE_API_DOCUMENT_MEMBERS_H
#define HE_API_DOCUMENT_MEMBERS_H

#include "api/json/json_scan.h"
#include "api/json/text.h"

/* The members gathered so far. It begins with .what, .most and .values_most set. */
typedef struct api_members {
    const char *what; /* "materials": for the refusal of too many bytes */
    size_t most, values_most;

    api_text text;
    size_t values;
    /* --- of the open member --- */
    const char *from; /* in the lexer's piece; NULL: its beginning */
    size_t depth, name_most;
} api_members;

void api_members_clear(api_members *m);
/* Nothing is gathered. */
void api_members_empty(api_members *m);

/* Begins to gather a member: its name. The lexer must be behind the colon after the name. */
bool api_members_begin(api_members *m, he_lexer *x, api_problem *problem);
/* Gathers the value of the member; `*done` is false if the piece ended before the value did. */
bool api_members_feed(api_members *m, he_lexer *x, bool *done, api_problem *problem);
/* Parses all members that were gathered, as one object. */
bool api_members_parse(api_members *m, api_document *out, api_in *root, api_problem *problem);

#endif
