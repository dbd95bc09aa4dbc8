#include "server/boot/parts.h"

#include "api/describe/routes.h"
#include "server/boot/reload.h"
#include "server/tokens.h"
#include "server/version.h"
#include "system/memory.h"

#include <limits.h>

static bool is_ready(void *context)
{
    const srv_parts *parts = context;
    return atomic_load(&parts->ready);
}

static bool is_full(void *context)
{
    const srv_parts *parts = context;
    return atomic_load(&parts->full);
}

static bool load_page(srv_parts *parts)
{
    char folder[PATH_MAX], message[320];
    bool found = srv_assets_folder(parts->config->web, folder, sizeof folder);
    parts->assets = srv_assets_load(found ? folder : NULL, message, sizeof message);
    if (parts->assets == NULL) {
        return srv_open_failed(parts, "no memory for the web page");
    }
    /* If the user configured a folder for the page, it must be usable; otherwise the daemon serves
     * requests without a page. */
    return message[0] == '\0' || parts->config->web[0] == '\0' || srv_open_failed(parts, message);
}

static void count_memory(uint64_t *used, uint64_t *budget)
{
    *used = st_memory_used();
    *budget = st_memory_budget();
}

bool srv_open_tokens(srv_parts *parts)
{
    char message[320];
    if (parts->config->tokens[0] == '\0') {
        return true;
    }
    parts->tokens = api_tokens_new();
    if (parts->tokens == NULL) {
        return srv_open_failed(parts, "no memory to start");
    }
    api_tokens_limit(parts->tokens, &parts->config->token_limits);
    return srv_tokens_read(parts->tokens, parts->config->tokens, message, sizeof message) ||
           srv_open_failed(parts, message);
}

static bool submit_job(void *pool, const st_task *task)
{
    return st_pool_submit(pool, task);
}

static bool open_service(srv_parts *parts)
{
    parts->job_table = api_job_table_new(&(api_job_table_options){
        .store = parts->store, .submit = submit_job, .pool = parts->pool, .keep = API_JOB_SECONDS});
    if (parts->job_table == NULL) {
        return srv_open_failed(parts, "no memory to start");
    }
    parts->backups.folder = srv_config_folder(parts->config);
    parts->service =
        api_service_new(parts->store, api_routes(),
                        &(api_options){
                            .max_upload = parts->config->max_upload,
                            .version = SRV_VERSION,
                            .asset = srv_assets_find,
                            .asset_context = parts->assets,
                            .frames = parts->config->frames.items,
                            .frame_count = parts->config->frames.count,
                            .ready = is_ready,
                            .is_full = is_full,
                            .ready_context = parts,
                            .memory = count_memory,
                            .tokens = parts->tokens,
                            .address_limits = parts->config->address_limits,
                            .limit_burst = parts->config->limit_burst,
                            .reload = srv_reload,
                            .reload_context = parts,
                            .backup = parts->backups.folder == NULL ? NULL : srv_backup_make,
                            .backup_context = &parts->backups,
                            .jobs = parts->job_table,
                            .pool = parts->pool,
                            .makers = parts->makers,
                            .log_dropped = srv_log_dropped,
                            .log = parts->log,
                            .commit = srv_commit,
                            .plain_answers = parts->config->no_compression,
                            .parallel = st_parallel_host(parts->parallel),
                        });
    return parts->service != NULL ||
           srv_open_failed(parts,
                           "there is not enough memory, or there are not enough threads, to start");
}

bool srv_open_service(srv_parts *parts)
{
    return load_page(parts) && open_service(parts);
}
