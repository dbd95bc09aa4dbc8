#include "server/tokens.h"

#include "base/mem.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* How many bytes of the file of tokens are read at most: one more than the file may have, which
 * shows that it is too large. */
enum { MOST = API_TOKENS_FILE + 1 };

bool srv_tokens_read(api_tokens *tokens, const char *path, char *message, size_t size)
{
    char why[API_TOKENS_MESSAGE];
    char *bytes = he_mem_alloc(MOST);
    FILE *file = bytes == NULL ? NULL : fopen(path, "re");
    size_t length = file == NULL ? 0 : fread(bytes, 1, MOST, file);
    bool good = file != NULL && ferror(file) == 0;
    if (!good) {
        snprintf(why, sizeof why, "%s",
                 bytes == NULL ? "no memory to read the file of tokens" : strerror(errno));
    } else {
        good = api_tokens_load(tokens, bytes, length, why);
    }
    if (file != NULL) {
        fclose(file);
    }
    he_mem_free(bytes);
    if (!good) {
        snprintf(message, size, "the tokens of %s: %s", path, why);
    }
    return good;
}

int srv_tokens_new(const char *name, const char *role)
{
    api_role has;
    if (!api_token_is_name(name, strlen(name))) {
        fprintf(stderr,
                "hedged: the name of a token must be 1 to %d of the characters A-Z a-z 0-9 . _ -\n",
                API_TOKEN_NAME);
        return 2;
    }
    if (!api_role_find(role, strlen(role), &has)) {
        fputs("hedged: the role of a token must be read, write, admin or metrics\n", stderr);
        return 2;
    }
    char token[API_TOKEN_TEXT + 1], line[API_TOKEN_SHORT_LINE];
    api_token_make(token);
    api_token_file_line(name, has, token, line);
    printf("%s\n%s\n", token, line);
    return 0;
}
