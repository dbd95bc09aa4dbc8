/* token_file.h - the file that says which tokens there are: lines of text, read strictly.
 *
 *     # NAME ROLE SHA256:HASH [prefix=PREFIX,...] [expires=TIME] [LIMIT=N ...]
 *     alice  write   sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08
 *     lab-3  read    sha256:60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752 \
 *            prefix=lab-3.,shared- expires=2027-01-01T00:00:00Z \
 *            requests=20 bytes=1M meshes=50                               (on one line)
 *
 * Fields are parted by blanks or tabs. A line that is empty or begins with '#' says nothing. NAME
 * is 1 to 64 of A-Z a-z 0-9 . _ - and stays with what the token makes: its jobs and
 * Idempotency-Keys are those of the name, so that a token can be replaced by another one of its
 * name. ROLE is read, write, admin or metrics. TIME is a day, which it ends with the beginning of,
 * or a day and a time of UTC. Names and hashes occur once. LIMIT is requests, bytes, jobs, meshes
 * or mesh-bytes (limit.h) and takes the place of the option's for this token; 0 is no limit. Those
 * of bytes take K, M, G or T after the number.
 *
 * What a refusal says never repeats a field: it may be a token that was put in the wrong place. */
#ifndef HE_API_TOKEN_TOKEN_FILE_H
#define HE_API_TOKEN_TOKEN_FILE_H

#include "api/token/token.h"

enum {
    API_TOKENS = 4096,         /* lines with a token */
    API_TOKENS_FILE = 1 << 20, /* bytes */
    API_TOKEN_LINE = 1024,     /* bytes of a line */
    API_TOKENS_MESSAGE = 160
};

typedef struct api_token_list {
    api_token **items; /* in the order of lines, each with one use */
    size_t count;
} api_token_list;

/* False with nothing in `out` and a sentence in `message`, which begins with "line N: " where a
 * line is wrong. A file without any token is refused: it would lock everybody out. */
bool api_token_file_read(const char *bytes, size_t length, api_token_list *out,
                         char message[API_TOKENS_MESSAGE]);
void api_token_list_clear(api_token_list *list);

/* The line of a token without prefixes or end, ended by a null. */
enum { API_TOKEN_SHORT_LINE = 160 };
void api_token_file_line(const char *name, api_role role, const char *token,
                         char out[API_TOKEN_SHORT_LINE]);
/* 1 to 64 of A-Z a-z 0-9 . _ - that are not the beginning of a token. */
bool api_token_is_name(const char *text, size_t length);
/* False where there is no such role. */
bool api_role_find(const char *text, size_t length, api_role *out);

#endif
