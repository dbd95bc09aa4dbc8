#include "server/backup.h"

#include "base/mem.h"
#include "journal/sqlite/sqlite_backup.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct backup {
    srv_backups *backups;
    int file;
} backup;

static int64_t read_file(void *self, uint64_t at, char *buffer, size_t size)
{
    const backup *b = self;
    ssize_t got;
    do {
        got = pread(b->file, buffer, size, (off_t)at);
    } while (got < 0 && errno == EINTR);
    return got;
}

static void free_backup(void *self)
{
    backup *b = self;
    (void)close(b->file);
    atomic_store(&b->backups->taken, false);
    he_mem_free(b);
}

/* Makes a backup of the store in a file and returns the file's descriptor; the file's name is
 * removed, so that the file vanishes when it is closed. A file that a killed process may have left
 * under this name is replaced. Returns -1 with a sentence in `message` on failure. */
static int make_file(const char *folder, char *message, size_t size)
{
    char path[PATH_MAX], why[ST_SQLITE_MESSAGE];
    int length = snprintf(path, sizeof path, "%s/sent.db", folder);
    if (length < 0 || (size_t)length >= sizeof path) {
        (void)snprintf(message, size, "the path of the store is too long");
        return -1;
    }
    if (!st_sqlite_backup(folder, path, why)) {
        (void)snprintf(message, size, "%s", why);
        return -1;
    }
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        (void)snprintf(message, size, "%s", strerror(errno));
    }
    (void)unlink(path);
    return file;
}

st_status srv_backup_make(void *context, api_blob *out, char *message, size_t size)
{
    srv_backups *backups = context;
    struct stat facts;
    if (atomic_exchange(&backups->taken, true)) {
        return ST_BUSY;
    }
    backup *b = he_mem_zero(1, sizeof *b);
    int file = b == NULL ? -1 : make_file(backups->folder, message, size);
    if (b == NULL) {
        (void)snprintf(message, size, "no memory for the backup");
    }
    if (file < 0 || fstat(file, &facts) != 0) {
        if (file >= 0) {
            (void)close(file);
        }
        he_mem_free(b);
        atomic_store(&backups->taken, false);
        return ST_FAILED;
    }
    *b = (backup){backups, file};
    *out = (api_blob){
        .self = b, .length = (uint64_t)facts.st_size, .read = read_file, .free = free_backup};
    return ST_OK;
}
