#include "api/request/new_mesh.h"

#include "system/random.h"

#include <string.h>

enum { RANDOM = 10 }; /* number of random characters that follow the token's prefix in an id */

st_status api_mesh_new(api_exchange *x, const char *id, const char *name, he_mesh *content,
                       const st_shown *from, st_mesh **out)
{
    const st_cause cause = api_cause(x);
    const char *prefix =
        x->token == NULL || x->token->prefix_count == 0 ? "" : x->token->prefixes[0];
    st_new_mesh made = {.id = id, .name = name, .cause = &cause, .from = from};
    if (id != NULL || prefix[0] == '\0') {
        return st_create_from(x->store, &made, content, out);
    }
    char chosen[API_TOKEN_PREFIX + RANDOM + 1];
    size_t length = strlen(prefix);
    st_status status;
    memcpy(chosen, prefix, length);
    made.id = chosen;
    do {
        st_random_id(chosen + length, RANDOM);
        status = st_create_from(x->store, &made, content, out);
    } while (status == ST_TAKEN);
    return status;
}
