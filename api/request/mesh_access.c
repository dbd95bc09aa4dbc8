#include "api/request/mesh_access.h"

#include "api/request/at_revision.h"

const he_mesh *api_read_begin(api_exchange *x)
{
    const he_mesh *mesh = st_read_begin(x->mesh, &x->info);
    if (x->info.removed || x->info.lost) {
        st_read_end(x->mesh);
        api_fail_store(x, x->info.lost ? ST_LOST : ST_ABSENT);
        return NULL;
    }
    x->has_info = true;
    return mesh;
}

void api_read_end(api_exchange *x)
{
    st_read_end(x->mesh);
}

/* What is at hand is a snapshot, or under the shared lock. */
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

/* The lock becomes a snapshot of what is under it. */
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
        x->deferred = api_read; /* it may copy and replay; what is refused is no job */
        return false;
    }
    if (!api_at_revision_take(x, revision, &x->snapshot)) {
        return false;
    }
    x->content = st_snapshot_content(x->snapshot, &x->info);
    return true;
}

/* With the mesh at hand: is it to be read here, and is the answer not one that the client has? */
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
    x->keeps = false; /* what an attempt before this one had to keep */
    give_back(x);
    x->content = api_read_begin(x);
    if (x->content == NULL) {
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

void api_read(api_exchange *x)
{
    bool given = x->reading.reads == API_READS_NONE || x->reading.reads == API_READS_CARD;
    if (given || obtain(x)) {
        x->reading.run(x);
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
    x->out.watch = &x->watch;
    x->deferred = api_read;
}

bool api_cost_of_mesh(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)x;
    out->elements = api_elements_of(mesh);
    return true;
}
