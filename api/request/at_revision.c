#include "api/request/at_revision.h"

#include <string.h>

static bool route_takes(const api_route *route, const char *name)
{
    for (const api_parameter *const *p = route->parameters; *p != NULL; p++) {
        if (strcmp((*p)->name, name) == 0) {
            return true;
        }
    }
    return false;
}

bool api_at_revision_wanted(api_exchange *x, uint64_t *revision)
{
    if (!route_takes(x->route, "revision")) {
        return false;
    }
    const char *cursor = api_param_text(x, "cursor");
    uint64_t present = x->info.revision, asked = api_param_u64(x, "revision", 0), pinned = 0;
    /* A malformed cursor is refused by api_cursor_pins, which fills the problem. */
    if (cursor != NULL && !api_cursor_pins(cursor, &x->info, &pinned)) {
        return false;
    }
    *revision = asked != 0 ? asked : pinned;
    if (asked != 0 && pinned != 0 && asked != pinned) {
        *revision = 0;
        api_fail(x, API_BAD_CURSOR, "the cursor belongs to revision %llu, not %llu",
                 (unsigned long long)pinned, (unsigned long long)asked);
    }
    return (asked != 0 || pinned != 0) && *revision != present;
}

bool api_at_revision_may(api_exchange *x, uint64_t revision)
{
    uint64_t present = x->info.revision;
    return revision != 0 && (revision <= present ||
                             api_fail(x, API_NO_SUCH_REVISION,
                                      "the mesh is at revision %llu and has no revision %llu yet",
                                      (unsigned long long)present, (unsigned long long)revision));
}

bool api_at_revision_take(api_exchange *x, uint64_t revision, st_snapshot **out)
{
    st_status status = st_snapshot_at(x->mesh, revision, out);
    if (status == ST_GONE) {
        return api_fail(x, API_REVISION_GONE, "the history does not reach back to revision %llu",
                        (unsigned long long)revision);
    }
    return status == ST_OK || api_fail_store(x, status);
}
