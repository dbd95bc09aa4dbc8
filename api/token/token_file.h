/* token_file.h - reads the token file: a text with one line for each token. No malformed line is
 * accepted.
 *
 *     # NAME ROLE SHA256:HASH [prefix=PREFIX,...] [expires=TIME] [LIMIT=N ...]
 *     alice  write   sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08
 *     lab-3  read    sha256:60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752 \
 *            prefix=lab-3.,shared- expires=2027-01-01T00:00:00Z \
 *            requests=20 bytes=1M meshes=50                               (on one line)
 *
 * Fields are separated by blanks or tabs. Empty lines and lines that begin with '#' are skipped.
 * NAME is 1 to 64 of A-Z a-z 0-9 . _ -. Jobs and Idempotency-Keys belong to the name of a token, so
 * that the token can be replaced by another one with this name. ROLE is read, write, admin or
 * metrics. TIME is a day (the token expires when that day begins) or a day with a time, in UTC.
 * Names and hashes are unique. LIMIT is requests, bytes, jobs, meshes or mesh-bytes (limit.h) and
 * replaces, for this token, the limit that the server's options set; 0 is no limit. Limits in bytes
 * may end in K, M, G or T.
 *
 * A message about a faulty line never quotes a field, because the field may be a secret token that
 * was written in the wrong place. */
#ifndef HE_API_TOKEN_TOKEN_FILE_H
#define HE_API_TOKEN_TOKEN_FILE_H

#include "api/token/token.h"

enum {
    API_TOKENS = 4096,         /* the most tokens in the file */
    API_TOKENS_FILE = 1 << 20, /* bytes of the file */
    API_TOKEN_LINE = 1024,     /* bytes per line */
    API_TOKENS_MESSAGE = 160
};

typedef struct api_token_list {
    /* The tokens in the order of their lines; the list holds a reference to each. */
    api_token **items;
    size_t count;
} api_token_list;

/* Reads the contents of the token file into `out`.
 * Returns false with `out` empty and a sentence in `message`, which begins with "line N: " if a
 * line is wrong. A file without tokens is refused: it would lock out every client. */
bool api_token_file_read(const char *bytes, size_t length, api_token_list *out,
                         char message[API_TOKENS_MESSAGE]);
void api_token_list_clear(api_token_list *list);

/* Writes the line of a token that has no optional fields, terminated by NUL. */
enum { API_TOKEN_SHORT_LINE = 160 };
void api_token_file_line(const char *name, api_role role, const char *token,
                         char out[API_TOKEN_SHORT_LINE]);
/* Returns true if the text is a valid name: 1 to 64 of A-Z a-z 0-9 . _ -, but not a text that
 * begins like a token. */
bool api_token_is_name(const char *text, size_t length);
/* Finds a role by its name. Returns false if there is no such role. */
bool api_role_find(const char *text, size_t length, api_role *out);

#endif
