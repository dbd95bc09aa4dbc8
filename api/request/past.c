#include "api/request/past.h"

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

bool api_past_wanted(api_exchange *x, uint64_t *revision)
{
    if (!route_takes(x->route, "revision")) {
        return false;
    }
    const char *cursor = api_param_text(x, "cursor");
    uint64_t present = x->info.revision, asked = api_param_u64(x, "revision", 0), pinned = 0;
    /* What is wrong with a cursor is said by its reader. */
    if (cursor != NULL && !api_cursor_pins(cursor, &x->info, &pinned)) {
        return false;
    }
    *revision = asked != 0 ? asked : pinned;
    if (asked != 0 && pinned != 0 && asked != pinned) {
        *revision = 0;
        api_fail(x, API_BAD_CURSOR, "the cursor is of revision %llu, not %llu",
                 (unsigned long long)pinned, (unsigned long long)asked);
    }
    return (asked != 0 || pinned != 0) && *revision != present;
}

static bool refuse(api_exchange *x, st_status status, uint64_t revision, uint64_t present)
{
    if (status == ST_AHEAD) {
        return api_fail(x, API_NO_SUCH_REVISION, "the mesh is at revision %llu, before %llu",
                        (unsigned long long)present, (unsigned long long)revision);
    }
    if (status == ST_GONE) {
        return api_fail(x, API_REVISION_GONE, "the history does not reach back to revision %llu",
                        (unsigned long long)revision);
    }
    return api_fail_store(x, status);
}

bool api_past_begin(api_exchange *x, uint64_t revision)
{
    x->has_info = true;
    if (revision == 0) {
        return false;
    }
    uint64_t present = x->info.revision;
    if (revision > present) {
        return refuse(x, ST_AHEAD, revision, present);
    }
    if (x->phase == API_PHASE_BODY) {
        api_defer(x, x->route->run);
        return false;
    }
    st_status status = st_snapshot_at(x->mesh, revision, &x->past);
    if (status != ST_OK) {
        return refuse(x, status, revision, present);
    }
    st_snapshot_content(x->past, &x->info);
    return true;
}
