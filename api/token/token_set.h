/* token_set.h - the tokens in force: looked up by every request, replaced when the file of tokens
 * is read again.
 *
 *     file --api_tokens_load--> tokens <--api_tokens_find-- requests
 *                                 |
 *                                 +-- a token is revoked --> its watches: open streams
 *
 * A request looks up its token and holds a reference until its end, so it never sees a partly
 * loaded file. Threads share one lock, for the length of a table lookup; hashing happens before. A
 * successful lookup takes less than a microsecond: `make bench-http` measures it. */
#ifndef HE_API_TOKEN_TOKEN_SET_H
#define HE_API_TOKEN_TOKEN_SET_H

#include "api/token/token_file.h"

typedef struct api_tokens api_tokens;

/* Makes an empty set: no client has access until a file is loaded. Returns NULL when memory is
 * out. */
api_tokens *api_tokens_new(void);
/* No watch may be left. */
void api_tokens_free(api_tokens *tokens);

/* Sets the limits of tokens whose lines set none; they apply from the next load on. Without this
 * call there are no limits. */
void api_tokens_limit(api_tokens *tokens, const api_limits *defaults);

/* Replaces the tokens by those of a file (token_file.h), all or nothing. Tokens whose lines differ
 * in nothing but limits stay, with the new limits; the others are revoked and their watches called.
 * Returns false with a sentence in `message` if the file is wrong. */
bool api_tokens_load(api_tokens *tokens, const char *bytes, size_t length,
                     char message[API_TOKENS_MESSAGE]);
/* Returns the number of tokens in force. */
size_t api_tokens_count(api_tokens *tokens);

/* Lists all tokens in force, with a reference held to each; the caller clears the list. Returns
 * false when memory is out. */
bool api_tokens_all(api_tokens *tokens, api_token_list *out);

/* Returns the token with this text, which the caller releases. Returns NULL if it is unknown or
 * expired; the two cases are not distinguished, so that answers do not reveal which. */
api_token *api_tokens_find(api_tokens *tokens, const char *text, size_t length, double now);

/* A callback for the end of a token. `gone` is called at most once, under the lock; it may wake
 * other threads but do nothing else. The watching code provides the storage. */
typedef struct api_token_watch {
    const api_token *token;
    void (*gone)(struct api_token_watch *watch);
    struct api_token_watch *next, **place; /* `place` is NULL: not watching */
} api_token_watch;

/* Adds a watch for the end of its token. If the token is revoked already, it calls `gone` before it
 * returns. */
void api_tokens_watch(api_tokens *tokens, api_token_watch *watch);
/* Removes a watch. After this function has returned, `gone` is not called. */
void api_tokens_unwatch(api_tokens *tokens, api_token_watch *watch);

#endif
