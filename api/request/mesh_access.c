#include "api/request/mesh_access.h"

#include "api/request/at_revision.h"

/* Checks x->info. Refuses with 503 if changes of the mesh were lost, or with 404 if it was deleted.
 * A route that may create the mesh treats a deleted mesh as absent. */
static bool is_there(api_exchange *x)
{
    if (x->info.lost) {
        return api_fail_store(x, ST_LOST);
    }
    if (x->info.removed && (x->route->flags & API_MAY_CREATE)) {
        st_release(x->mesh);
        x->mesh = NULL;
        return true;
    }
    if (x->info.removed) {
        return api_fail_store(x, ST_ABSENT);
    }
    x->has_info = true;
    return true;
}

/* Takes the shared lock on the mesh's content. Returns false, without the lock, if is_there
 * refuses. */
static bool lock(api_exchange *x)
{
    x->content = st_read_begin(x->mesh, &x->info);
    if (x->info.removed || x->info.lost) {
        st_read_end(x->mesh);
        x->content = NULL;
    }
    return is_there(x);
}

/* Ends the handler's access to the mesh: releases the snapshot, unless it must be kept, or the
 * shared lock. */
static void give_back(api_exchange *x)
{
    if (x->content != NULL && x->snapshot == NULL) {
        st_read_end(x->mesh);
    }
    if (x->snapshot != NULL && !x->keeps) {
        st_snapshot_release(x->snapshot);
        x->snapshot = NULL;
    }
    x->content = NULL;
}

/* Takes a snapshot of the mesh and releases the shared lock on it, also on failure. */
static bool take_snapshot(api_exchange *x)
{
    st_status status = st_snapshot_held(x->mesh, &x->snapshot);
    st_read_end(x->mesh);
    x->content = NULL;
    if (status != ST_OK) {
        x->snapshot = NULL;
        return api_fail_store(x, status);
    }
    x->content = st_snapshot_content(x->snapshot, &x->info);
    return true;
}

static bool take_earlier(api_exchange *x, uint64_t revision)
{
    give_back(x);
    if (!api_at_revision_may(x, revision)) {
        return false;
    }
    if (x->phase == API_PHASE_BODY) {
        /* Taking an earlier revision may copy the mesh and replay changes, so it is deferred to a
         * thread that may block. The check above comes first, because a request that will be
         * refused must not become a job. */
        x->deferred = api_read;
        return false;
    }
    if (!api_at_revision_take(x, revision, &x->snapshot)) {
        return false;
    }
    x->content = st_snapshot_content(x->snapshot, &x->info);
    return true;
}

/* Decides, after the mesh was obtained, whether the handler runs on this thread. Returns false if
 * the work was deferred to another thread, if the request is refused, or if the client has the
 * answer already (304). */
static bool is_read_here(api_exchange *x)
{
    api_cost cost = {0};
    if (x->reading.cost != NULL && !x->reading.cost(x, x->content, &cost)) {
        return false;
    }
    if (x->reading.tag != NULL && api_not_modified(x, x->reading.tag)) {
        return false;
    }
    x->seconds = cost.seconds;
    x->is_job = api_wants_job(x, cost.seconds);
    if (x->is_job || api_is_costly(x, cost.elements, API_COSTLY_ELEMENTS)) {
        x->deferred = api_read;
        return false;
    }
    return true;
}

static bool obtain(api_exchange *x)
{
    uint64_t revision;
    x->keeps = false; /* if an earlier attempt kept a snapshot, it is released now */
    give_back(x);
    if (!lock(x)) {
        return false;
    }
    if (api_at_revision_wanted(x, &revision)) {
        return take_earlier(x, revision) && is_read_here(x);
    }
    if (!is_read_here(x)) {
        return false;
    }
    bool copies = x->reading.reads == API_READS_SNAPSHOT ||
                  (x->reading.reads == API_READS_VIEW && x->phase != API_PHASE_BODY);
    return !copies || take_snapshot(x);
}

/* Decides whether a handler that writes runs on this thread: lets the function `cost` of the route
 * read the mesh, unless the mesh does not exist yet. */
static bool look(api_exchange *x)
{
    api_cost cost = {0};
    if (x->mesh != NULL && !lock(x)) {
        return false;
    }
    bool good = x->content == NULL || x->reading.cost(x, x->content, &cost);
    give_back(x);
    if (good && api_is_costly(x, cost.elements, API_COSTLY_ELEMENTS)) {
        x->deferred = api_read;
        return false;
    }
    return good;
}

static bool get_ready(api_exchange *x)
{
    switch (x->reading.reads) {
    case API_READS_NONE:
    case API_READS_CARD:
        return true;
    case API_READS_BEFORE:
        return look(x);
    case API_READS_LOCKED:
    case API_READS_VIEW:
    case API_READS_SNAPSHOT:
        break;
    }
    return obtain(x);
}

void api_read(api_exchange *x)
{
    if (get_ready(x)) {
        x->reading.run(x);
    }
    give_back(x);
}

void api_read_at_head(api_exchange *x)
{
    bool good = true;
    if (x->mesh != NULL && x->route->begin_reads == API_READS_CARD) {
        (void)st_read_card(x->mesh, &x->info);
        good = is_there(x);
    } else if (x->mesh != NULL && x->route->begin_reads == API_READS_LOCKED) {
        good = lock(x);
    }
    if (good) {
        x->route->begin(x);
    }
    give_back(x);
}

void api_read_as(api_exchange *x, const api_reading *reading)
{
    x->reading = *reading;
    api_read(x);
}

bool api_keep_mesh(api_exchange *x)
{
    x->keeps = x->snapshot != NULL || take_snapshot(x);
    return x->keeps;
}

void api_begin_elsewhere(api_exchange *x)
{
    api_text_empty(&x->text);
    api_out_init(&x->out, &x->text);
    x->out.progress = &x->progress;
    x->deferred = api_read;
}

bool api_cost_of_mesh(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)x;
    out->elements = api_elements_of(mesh);
    return true;
}
