/* tokens.h - the file of tokens (api/token/token_file.h): read at start and when it has changed,
 * and a line for it made by `hedged --new-token`. */
#ifndef HE_SERVER_TOKENS_H
#define HE_SERVER_TOKENS_H

#include "api/token/token_set.h"

/* Puts what is in the file in force. False with a sentence in `message`, which names the file and
 * the line that is wrong: then what was in force before still is. */
bool srv_tokens_read(api_tokens *tokens, const char *path, char *message, size_t size);

/* Prints a new token, and below it the line for the file. The process's exit status: 0, or 2 with
 * a line on stderr where the name or the role is none. */
int srv_tokens_new(const char *name, const char *role);

#endif
