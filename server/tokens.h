/* tokens.h - reads the file of tokens (api/token/token_file.h) at the start and on reload, and
 * makes a line for that file with `hedged --new-token`. */
#ifndef HE_SERVER_TOKENS_H
#define HE_SERVER_TOKENS_H

#include "api/token/token_set.h"

/* Reads the file of tokens and puts its tokens in force. Returns false with a sentence in
 * `message`, which names the file and the faulty line; the old tokens then stay in force. */
bool srv_tokens_read(api_tokens *tokens, const char *path, char *message, size_t size);

/* Prints a new token, and below it the line for the file of tokens. Returns the exit status of the
 * process: 0, or 2 with a line on stderr if the name or the role is invalid. */
int srv_tokens_new(const char *name, const char *role);

#endif
