/* backup.h - POST /v1/admin/backup: a backup beside the store, sent and forgotten. */
#ifndef HE_SERVER_BACKUP_H
#define HE_SERVER_BACKUP_H

#include "api/blob.h"
#include "journal/journal.h"

#include <stdatomic.h>

/* One at a time is made or kept. */
typedef struct srv_backups {
    const char *folder; /* of the store */
    _Atomic bool taken;
} srv_backups;

/* api_options' `backup`; `context` is an srv_backups, which outlives the blob. The file lies beside
 * the store, where there is room for it if anywhere, and has no name once it is made: it goes with
 * the blob, or with the process. */
st_status srv_backup_make(void *context, api_blob *out, char *message, size_t size);

#endif
