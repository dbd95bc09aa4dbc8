#include "server/boot/parts.h"

#include "api/event/event_follow.h"
#include "journal/sqlite/sqlite_journal.h"
#include "server/boot/resources.h"
#include "server/sample_meshes.h"
#include "server/version.h"

enum {
    /* How many threads the pool has in addition to those for jobs, so that a short task always
     * finds a thread. */
    SHORT_THREADS = 2,
    /* The largest number of pieces of answers that may wait for a thread; further pieces are made
     * by the worker threads themselves. */
    MAKER_QUEUE = 1024
};

bool srv_open_failed(const srv_parts *parts, const char *why)
{
    srv_log_tell(parts->log, SRV_LEVEL_ERROR, "%s", why);
    return false;
}

static bool open_threads(srv_parts *parts)
{
    size_t jobs = parts->config->jobs != 0 ? (size_t)parts->config->jobs
                  : srv_cores() > 2        ? srv_cores()
                                           : 2;
    parts->pool =
        st_pool_new("hedged-pool", jobs + SHORT_THREADS, (size_t)parts->config->job_queue);
    parts->makers = st_pool_new("hedged-answers", srv_cores(), MAKER_QUEUE);
    parts->parallel = st_parallel_new(srv_cores() - 1);
    return (parts->pool != NULL && parts->makers != NULL && parts->parallel != NULL) ||
           srv_open_failed(parts,
                           "there is not enough memory, or there are not enough threads, to start");
}

/* Opens the journal, which keeps the meshes on the disk. Sets *made to true if the store is new, so
 * that sample meshes may be added. */
static bool open_journal(const srv_parts *parts, st_journal *out, bool *made)
{
    const char *folder = srv_config_folder(parts->config);
    st_sqlite_opened opened;
    if (folder == NULL) {
        *out = st_journal_memory();
        *made = true;
        return true;
    }
    if (!st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = SRV_VERSION}, &opened)) {
        return srv_open_failed(parts, opened.message);
    }
    const bool doubtful = opened.message[0] != '\0';
    srv_log_tell(parts->log, doubtful ? SRV_LEVEL_WARNING : SRV_LEVEL_INFO,
                 "meshes are kept in %s%s%s", folder, doubtful ? "; " : "", opened.message);
    *out = opened.journal;
    *made = opened.made;
    return true;
}

static bool open_store(srv_parts *parts)
{
    st_journal journal;
    bool made = false;
    if (!open_journal(parts, &journal, &made)) {
        return false;
    }
    parts->store = st_store_new(&(st_store_options){
        .undo_budget = parts->config->undo_budget,
        .max_meshes = parts->config->max_meshes,
        .journal = journal,
        .pool = parts->pool,
        .listeners = parts->config->max_listeners,
        .mesh_listeners = parts->config->max_mesh_listeners,
        .render = api_event_render,
    });
    if (parts->store == NULL) {
        journal.close(journal.self);
        return srv_open_failed(parts, "no memory to start");
    }
    he_error err;
    if (parts->config->samples && made && srv_sample_meshes_add(parts->store, &err) != HE_OK) {
        return srv_open_failed(parts, err.text);
    }
    if (made && journal.keeps) {
        journal.begun(journal.self);
    }
    return true;
}

bool srv_open_store(srv_parts *parts)
{
    return open_threads(parts) && open_store(parts);
}
