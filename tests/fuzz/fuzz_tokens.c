/* The reader of files of tokens: a file that it accepts must obey its limits, and the reason of a
 * refusal must not contain a word of the file, which may be secret. */
#include "fuzz/fuzz.h"

#include "api/token/token_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void check_token(const api_token *token)
{
    FUZZ_REQUIRE(api_token_is_name(token->name, strlen(token->name)), "a name is none");
    FUZZ_REQUIRE(token->role < API_ROLE_OPEN, "a token has no role");
    FUZZ_REQUIRE(token->prefix_count <= API_TOKEN_PREFIXES, "too many prefixes");
    FUZZ_REQUIRE(!isnan(token->expires), "an end is no number");
    for (size_t i = 0; i < token->prefix_count; i++) {
        FUZZ_REQUIRE(token->prefixes[i][0] != '\0', "a prefix is empty");
        FUZZ_REQUIRE(api_token_sees(token, token->prefixes[i]), "a prefix is not seen");
    }
    for (api_limit limit = 0; limit < API_LIMIT_COUNT; limit++) {
        const bool own = (token->own_limits >> limit & 1) != 0;
        const uint64_t most = api_limit_is_bytes(limit) ? API_LIMIT_MOST_BYTES : API_LIMIT_MOST;
        FUZZ_REQUIRE(api_token_limit(token, limit) <= (own ? most : 0), "a limit is too large");
        FUZZ_REQUIRE(!own || api_limit_is_of_token(limit), "a limit is none of tokens");
    }
    FUZZ_REQUIRE(token->prefix_count == 0 || !api_token_sees(token, "/"), "all is seen");
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    api_token_list list;
    char message[API_TOKENS_MESSAGE] = "";
    /* The input is copied to a block of its size, so that the sanitizer notices reads beyond its
     * end. */
    char *copy = malloc(size == 0 ? 1 : size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    if (api_token_file_read(copy, size, &list, message)) {
        FUZZ_REQUIRE(list.count > 0 && list.count <= API_TOKENS, "%zu tokens", list.count);
        for (size_t i = 0; i < list.count; i++) {
            check_token(list.items[i]);
        }
        api_token_list_clear(&list);
    } else {
        FUZZ_REQUIRE(message[0] != '\0', "a refusal says nothing");
    }
    free(copy);
}
