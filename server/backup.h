/* backup.h - POST /v1/admin/backup: makes a backup in the store's folder, sends it and deletes
 * it. */
#ifndef HE_SERVER_BACKUP_H
#define HE_SERVER_BACKUP_H

#include "api/blob.h"
#include "journal/journal.h"

#include <stdatomic.h>

/* The backups of a daemon, of which only one exists at a time. */
typedef struct srv_backups {
    const char *folder; /* of the store */
    _Atomic bool taken;
} srv_backups;

/* Makes a backup, as the `backup` of api_options; `context` is an srv_backups, which outlives the
 * blob. The file is made in the store's folder, where space is most likely, and unlinked when it is
 * complete, so that it disappears with the blob or with the process. */
st_status srv_backup_make(void *context, api_blob *out, char *message, size_t size);

#endif
