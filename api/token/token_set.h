/* token_set.h - the tokens in force: each request looks up its token, and all tokens are replaced
 * when the token file is read again.
 *
 *     file --api_tokens_load--> tokens <--api_tokens_find-- requests
 *                                 |
 *                                 +-- a token is revoked --> its watches: open streams
 *
 * A request looks up its token and holds a reference until its end, so it never sees a partly
 * loaded file. All threads share one lock, which is held only for a table lookup; the token is
 * hashed before. A successful lookup takes less than a microsecond: `make bench-http` measures
 * it. */
#ifndef HE_API_TOKEN_TOKEN_SET_H
#define HE_API_TOKEN_TOKEN_SET_H

#include "api/token/token_file.h"

typedef struct api_tokens api_tokens;

/* Makes an empty set: no client has access until a file is loaded. Returns NULL when memory is
 * out. */
api_tokens *api_tokens_new(void);
/* Frees the set. All watches must have been removed. */
void api_tokens_free(api_tokens *tokens);

/* Sets the limits of tokens whose lines set none; they take effect with the next api_tokens_load.
 * Without this call these tokens have no limits. */
void api_tokens_limit(api_tokens *tokens, const api_limits *defaults);

/* Replaces all tokens by those of a token file (token_file.h); if the file is wrong, no token is
 * replaced. Tokens whose lines differ in nothing but limits stay, with the new limits; the others
 * are revoked and their watches called.
 * Returns false with a sentence in `message` if the file is wrong. */
bool api_tokens_load(api_tokens *tokens, const char *bytes, size_t length,
                     char message[API_TOKENS_MESSAGE]);
/* Returns the number of tokens in force. */
size_t api_tokens_count(api_tokens *tokens);

/* Lists all tokens in force and takes a reference to each; the caller clears the list. Returns
 * false when memory is out. */
bool api_tokens_all(api_tokens *tokens, api_token_list *out);

/* Returns the token with this text, which the caller releases. Returns NULL if it is unknown or
 * expired; the two cases are not distinguished, so that answers do not reveal which. */
api_token *api_tokens_find(api_tokens *tokens, const char *text, size_t length, double now);

/* A callback for the revocation of a token. `gone` is called at most once, while the lock of the
 * token set is held; it may wake other threads but must do nothing else. The caller of
 * api_tokens_watch owns the memory of the watch. */
typedef struct api_token_watch {
    const api_token *token;
    void (*gone)(struct api_token_watch *watch);
    /* Links of the list of watches; `place` is NULL if the watch is not in it. */
    struct api_token_watch *next, **place;
} api_token_watch;

/* Adds a watch, which is called when its token is revoked. If the token is revoked already, it
 * calls `gone` before it returns. */
void api_tokens_watch(api_tokens *tokens, api_token_watch *watch);
/* Removes a watch. After this function has returned, `gone` is not called. */
void api_tokens_unwatch(api_tokens *tokens, api_token_watch *watch);

#endif
