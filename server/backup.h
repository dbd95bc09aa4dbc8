/* backup.h - POST /v1/admin/backup: makes a backup in the store's folder, sends it and deletes
 * it. */
#ifndef HE_SERVER_BACKUP_H
#define HE_SERVER_BACKUP_H

#include "api/blob.h"
#include "journal/journal.h"

#include <stdatomic.h>

/* The state that all backups of a daemon share. Only one backup exists at a time, and `taken` is
 * true while it does. */
typedef struct srv_backups {
    const char *folder; /* folder of the store */
    _Atomic bool taken;
} srv_backups;

/* Makes a backup; the function is the `backup` of api_options. `context` is an srv_backups, which
 * must outlive the blob. The file is made in the store's folder, where free space is most likely.
 * It is unlinked when it is complete, so that its space is freed with the blob, or when the process
 * ends. Returns ST_BUSY while another backup exists, and ST_FAILED, with a sentence in `message`,
 * if the backup could not be made. */
st_status srv_backup_make(void *context, api_blob *out, char *message, size_t size);

#endif
