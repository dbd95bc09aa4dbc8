/* backup.c - POST /v1/admin/backup: answers with the whole store as one file. */
#include "api/request/handlers.h"

static void make(api_exchange *x)
{
    const api_options *options = &x->service->options;
    char message[API_PROBLEM_DETAIL];
    api_blob blob;
    st_status status = options->backup(options->backup_context, &blob, message, sizeof message);
    if (status == ST_OK) {
        api_answer_blob(x, 200, "application/vnd.sqlite3", &blob);
        api_answer_header(x, "Content-Disposition", "attachment; filename=\"hedge.db\"");
    } else if (status == ST_BUSY) {
        api_fail(x, API_BACKUP_KEPT, "another backup is being made, or is still kept with its job");
    } else {
        api_fail(x, API_BACKUP_FAILED, "%s", message);
    }
}

/* Makes a backup as a job unless the client prefers to wait, because the time depends on the size
 * of the store, which is not known in advance. */
void api_admin_backup(api_exchange *x)
{
    if (x->service->options.backup == NULL) {
        api_fail(x, API_NOTHING_KEPT,
                 "the server keeps its meshes in memory only, so there is no store to back up");
        return;
    }
    api_run_long(x, make, true, 2 * API_PATIENCE);
}
