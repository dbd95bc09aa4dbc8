/* token_set.h - the tokens that are in force, read by every request and now and then replaced.
 *
 *     file --api_tokens_load--> tokens <--api_tokens_find-- requests
 *                                 |
 *                                 +-- a token is gone --> those who watch it: open streams
 *
 * A request finds its token by what it carries, holds it to its end, and so never sees half of a
 * file. Threads share one lock, for as long as it takes to look into a table; hashing comes before
 * it. A found token costs less than a microsecond: `make bench-http` measures it. */
#ifndef HE_API_TOKEN_TOKEN_SET_H
#define HE_API_TOKEN_TOKEN_SET_H

#include "api/token/token_file.h"

typedef struct api_tokens api_tokens;

/* None is in force: nobody gets in before a file is loaded. NULL when memory is out. */
api_tokens *api_tokens_new(void);
/* Nobody may watch any more. */
void api_tokens_free(api_tokens *tokens);

/* What tokens may have whose lines do not say it; from the next load on. Without this call: all. */
void api_tokens_limit(api_tokens *tokens, const api_limits *defaults);

/* Puts a file (token_file.h) in the place of the one before, whole or not at all: false with a
 * sentence in `message` where it is wrong. Tokens whose lines say what they said, but for limits,
 * stay the same, with the limits of the new line; the others are revoked, and those who watch them
 * are told. */
bool api_tokens_load(api_tokens *tokens, const char *bytes, size_t length,
                     char message[API_TOKENS_MESSAGE]);
/* How many are in force. */
size_t api_tokens_count(api_tokens *tokens);

/* All that are in force, each held: for the caller to clear. False without memory. */
bool api_tokens_all(api_tokens *tokens, api_token_list *out);

/* The token of this text, for the caller to release. NULL where there is none, or it has
 * expired: no answer tells which. */
api_token *api_tokens_find(api_tokens *tokens, const char *text, size_t length, double now);

/* Told when a token is gone: `gone` is called once at most, under the lock, and may wake others but
 * do nothing else. In the storage of who watches. */
typedef struct api_token_watch {
    const api_token *token;
    void (*gone)(struct api_token_watch *watch);
    struct api_token_watch *next, **place; /* NULL place: not watching */
} api_token_watch;

/* Where the token is gone already, `gone` is called before this returns. */
void api_tokens_watch(api_tokens *tokens, api_token_watch *watch);
/* After this `gone` is not called any more. */
void api_tokens_unwatch(api_tokens *tokens, api_token_watch *watch);

#endif
