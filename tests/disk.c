#include "tests/disk.h"

#include "journal/sqlite/sqlite_db.h"

#include <pthread.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static bool is_full, is_held;
static long full_at, fail_at, writes, syncs, writers;

void disk_fill(bool full)
{
    pthread_mutex_lock(&lock);
    is_full = full;
    pthread_mutex_unlock(&lock);
}

static void count_from(long full, long fail)
{
    pthread_mutex_lock(&lock);
    full_at = full;
    fail_at = fail;
    writes = syncs = 0;
    pthread_mutex_unlock(&lock);
}

void disk_fill_at(long write)
{
    count_from(write, 0);
}

void disk_fail_at(long sync)
{
    count_from(0, sync);
}

void disk_hold(bool held)
{
    pthread_mutex_lock(&lock);
    is_held = held;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
}

static long read_count(const long *count)
{
    pthread_mutex_lock(&lock);
    long value = *count;
    pthread_mutex_unlock(&lock);
    return value;
}

long disk_syncs(void)
{
    return read_count(&syncs);
}

long disk_writers(void)
{
    return read_count(&writers);
}

static bool write_fails(void)
{
    pthread_mutex_lock(&lock);
    bool fails = (++writes >= full_at && full_at > 0) || is_full;
    pthread_mutex_unlock(&lock);
    return fails;
}

static bool sync_fails(void)
{
    pthread_mutex_lock(&lock);
    while (is_held) {
        pthread_cond_wait(&changed, &lock);
    }
    bool fails = ++syncs == fail_at;
    pthread_mutex_unlock(&lock);
    return fails;
}

/* --- a file of this disk, which calls the functions of the system's file --- */

typedef struct disk_file {
    sqlite3_file base;
    bool writes; /* set if the file is a database, not a journal or log, and is open for writing */
    sqlite3_file *real;
} disk_file;

static sqlite3_file *real_of(sqlite3_file *file)
{
    return ((disk_file *)file)->real;
}

static int file_close(sqlite3_file *file)
{
    if (((disk_file *)file)->writes) {
        pthread_mutex_lock(&lock);
        writers--;
        pthread_mutex_unlock(&lock);
    }
    return real_of(file)->pMethods->xClose(real_of(file));
}
static int file_read(sqlite3_file *file, void *to, int size, sqlite3_int64 at)
{
    return real_of(file)->pMethods->xRead(real_of(file), to, size, at);
}
static int file_write(sqlite3_file *file, const void *from, int size, sqlite3_int64 at)
{
    return write_fails() ? SQLITE_FULL
                         : real_of(file)->pMethods->xWrite(real_of(file), from, size, at);
}
static int file_truncate(sqlite3_file *file, sqlite3_int64 size)
{
    return real_of(file)->pMethods->xTruncate(real_of(file), size);
}
static int file_sync(sqlite3_file *file, int flags)
{
    return sync_fails() ? SQLITE_IOERR_FSYNC : real_of(file)->pMethods->xSync(real_of(file), flags);
}
static int file_size(sqlite3_file *file, sqlite3_int64 *size)
{
    return real_of(file)->pMethods->xFileSize(real_of(file), size);
}
static int file_lock(sqlite3_file *file, int level)
{
    return real_of(file)->pMethods->xLock(real_of(file), level);
}
static int file_unlock(sqlite3_file *file, int level)
{
    return real_of(file)->pMethods->xUnlock(real_of(file), level);
}
static int file_is_reserved(sqlite3_file *file, int *out)
{
    return real_of(file)->pMethods->xCheckReservedLock(real_of(file), out);
}
static int file_control(sqlite3_file *file, int what, void *value)
{
    return real_of(file)->pMethods->xFileControl(real_of(file), what, value);
}
static int file_sector(sqlite3_file *file)
{
    return real_of(file)->pMethods->xSectorSize(real_of(file));
}
static int file_traits(sqlite3_file *file)
{
    return real_of(file)->pMethods->xDeviceCharacteristics(real_of(file));
}
static int file_map(sqlite3_file *file, int page, int size, int extend, void volatile **out)
{
    return real_of(file)->pMethods->xShmMap(real_of(file), page, size, extend, out);
}
static int file_map_lock(sqlite3_file *file, int offset, int count, int flags)
{
    return real_of(file)->pMethods->xShmLock(real_of(file), offset, count, flags);
}
static void file_barrier(sqlite3_file *file)
{
    real_of(file)->pMethods->xShmBarrier(real_of(file));
}
static int file_unmap(sqlite3_file *file, int remove)
{
    return real_of(file)->pMethods->xShmUnmap(real_of(file), remove);
}

static const sqlite3_io_methods methods = {.iVersion = 2,
                                           .xClose = file_close,
                                           .xRead = file_read,
                                           .xWrite = file_write,
                                           .xTruncate = file_truncate,
                                           .xSync = file_sync,
                                           .xFileSize = file_size,
                                           .xLock = file_lock,
                                           .xUnlock = file_unlock,
                                           .xCheckReservedLock = file_is_reserved,
                                           .xFileControl = file_control,
                                           .xSectorSize = file_sector,
                                           .xDeviceCharacteristics = file_traits,
                                           .xShmMap = file_map,
                                           .xShmLock = file_map_lock,
                                           .xShmBarrier = file_barrier,
                                           .xShmUnmap = file_unmap};

static int file_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags, int *out)
{
    sqlite3_vfs *real = vfs->pAppData;
    disk_file *mine = (disk_file *)file;
    *mine = (disk_file){.real = (sqlite3_file *)(mine + 1)};
    int code = real->xOpen(real, name, mine->real, flags, out);
    if (mine->real->pMethods == NULL) {
        return code;
    }
    mine->base.pMethods = &methods;
    mine->writes = (flags & SQLITE_OPEN_MAIN_DB) && (flags & SQLITE_OPEN_READWRITE);
    if (mine->writes) {
        pthread_mutex_lock(&lock);
        writers++;
        pthread_mutex_unlock(&lock);
    }
    return code;
}

void disk_install(void)
{
    static sqlite3_vfs mine;
    (void)st_db_prepare(); /* configures SQLite, which is possible only before SQLite starts */
    sqlite3_vfs *real = sqlite3_vfs_find(NULL);
    mine = *real;
    mine.pNext = NULL;
    mine.zName = "disk of the tests";
    mine.szOsFile = (int)sizeof(disk_file) + real->szOsFile;
    mine.pAppData = real;
    mine.xOpen = file_open;
    (void)sqlite3_vfs_register(&mine, 1);
}
