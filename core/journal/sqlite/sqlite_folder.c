#include "journal/sqlite/sqlite_folder.h"

#include "journal/crc32c.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

enum { BALLAST_BYTES = 8 << 20, SPACE_BYTES = 4 << 20, START_BYTES = 1 << 20, WHO = 256 };

bool st_folder_fail(st_folder *folder, const char *what, const char *name)
{
    return st_refuse(folder->message, "%s %.200s%s%s: %s", what, folder->path,
                     name[0] == '\0' ? "" : "/", name, strerror(errno));
}

/* --- the lock --- */

/* Reads the first line of the lock file, which names the process and host that have locked the
 * store. */
static void read_owner(int lock, char out[WHO])
{
    ssize_t got = pread(lock, out, WHO - 1, 0);
    out[got > 0 ? got : 0] = '\0';
    out[strcspn(out, "\n")] = '\0';
}

static bool write_owner(st_folder *folder)
{
    char host[HOST_NAME_MAX + 1] = "", who[WHO];
    (void)gethostname(host, sizeof host - 1);
    int length = snprintf(who, sizeof who, "process %ld on %s\n", (long)getpid(), host);
    return (ftruncate(folder->lock, 0) == 0 &&
            pwrite(folder->lock, who, (size_t)length, 0) == length) ||
           /* This process has the lock even if it cannot write its name into the lock file. Then
            * other processes cannot name the owner of the lock in their messages. */
           errno == ENOSPC || errno == EDQUOT || st_folder_fail(folder, "cannot write", "lock");
}

static bool take_lock(st_folder *folder)
{
    folder->lock = openat(folder->folder, "lock", O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (folder->lock < 0) {
        return st_folder_fail(folder, "cannot open", "lock");
    }
    /* A lock of fcntl would be released when any descriptor of the file is closed; a lock of flock
     * is not. */
    if (flock(folder->lock, LOCK_EX | LOCK_NB) == 0) {
        return write_owner(folder);
    }
    if (errno != EWOULDBLOCK) {
        return st_folder_fail(folder, "cannot lock", "lock");
    }
    char who[WHO];
    read_owner(folder->lock, who);
    return st_refuse(folder->message, "%.200s is in use by %s", folder->path,
                     who[0] == '\0' ? "another process" : who);
}

/* --- the folder of the store --- */

static void close_file(int file)
{
    if (file >= 0) {
        (void)close(file);
    }
}

void st_folder_above(const char *path, char out[PATH_MAX])
{
    size_t length = strnlen(path, PATH_MAX - 1);
    while (length > 1 && path[length - 1] == '/') {
        length--;
    }
    while (length > 0 && path[length - 1] != '/') {
        length--;
    }
    memcpy(out, length == 0 ? "." : path, length == 0 ? 1 : length);
    out[length == 0 ? 1 : length] = '\0';
}

/* Syncs the folder above the store, which makes a new folder durable. */
static bool sync_above(const char *path)
{
    char above[PATH_MAX];
    st_folder_above(path, above);
    int file = open(above, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool good = file >= 0 && fsync(file) == 0;
    close_file(file);
    return good;
}

bool st_folder_open(st_folder *folder, const char *path)
{
    *folder = (st_folder){.folder = -1, .lock = -1, .mark = -1};
    (void)snprintf(folder->path, sizeof folder->path, "%s", path);
    const bool made = mkdir(path, 0700) == 0;
    if (!made && errno != EEXIST) {
        return st_folder_fail(folder, "cannot make", "");
    }
    if (made && !sync_above(path)) {
        (void)st_folder_fail(folder, "the parent folder cannot be synced", "");
        /* the new folder is removed, so that the next start makes it again and syncs it */
        (void)rmdir(path);
        return false;
    }
    folder->folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder->folder < 0) {
        return st_folder_fail(folder, "cannot open", "");
    }
    return take_lock(folder);
}

void st_folder_close(st_folder *folder)
{
    close_file(folder->mark);
    close_file(folder->lock);
    close_file(folder->folder);
    folder->mark = folder->lock = folder->folder = -1;
}

const char *st_folder_doubt(const st_folder *folder)
{
    /* These numbers identify types of file systems. They are from linux/magic.h, and from fs/nfs,
     * fs/fuse, fs/9p and fs/smb of the Linux kernel. */
    enum { NFS = 0x6969, FUSE = 0x65735546, P9 = 0x01021997 };
    const uint32_t cifs = UINT32_C(0xff534d42), smb2 = UINT32_C(0xfe534d42);
    struct statfs system;
    if (fstatfs(folder->folder, &system) != 0) {
        return "";
    }
    const uint32_t type = (uint32_t)system.f_type;
    return type == NFS || type == FUSE || type == P9 || type == cifs || type == smb2
               ? "the folder is on a network or user file system, on which locks and syncs may not "
                 "be reliable"
               : "";
}

bool st_folder_path(const st_folder *folder, const char *name, char out[PATH_MAX])
{
    int length = snprintf(out, PATH_MAX, "%s/%s", folder->path, name);
    return length > 0 && length < PATH_MAX;
}

bool st_folder_has(const st_folder *folder, const char *name)
{
    struct stat status;
    return fstatat(folder->folder, name, &status, 0) == 0 && status.st_size > 0;
}

bool st_folder_make(st_folder *folder, const char *name)
{
    int file = openat(folder->folder, name, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    close_file(file);
    return file >= 0 || st_folder_fail(folder, "cannot make", name);
}

bool st_folder_finds(const st_folder *folder, const char *name)
{
    return faccessat(folder->folder, name, F_OK, 0) == 0;
}

bool st_folder_drop(st_folder *folder, const char *name)
{
    return (unlinkat(folder->folder, name, 0) == 0 || errno == ENOENT ||
            st_folder_fail(folder, "cannot remove", name)) &&
           st_folder_sync(folder);
}

bool st_folder_sync(st_folder *folder)
{
    return fsync(folder->folder) == 0 || st_folder_fail(folder, "cannot sync", "");
}

/* --- the mark of the last commit --- */

/* A slot in the file of the mark: the number of the store, the number of commits, the position of
 * the last record, 4 bytes of zeros, and the CRC-32C of these. */
enum { SLOT = 32, SLOTS = 2, SUM_AT = 28 };

bool st_mark_open(st_folder *folder)
{
    folder->mark = openat(folder->folder, "hedge.mark", O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    return folder->mark >= 0 || st_folder_fail(folder, "cannot open", "hedge.mark");
}

static bool read_slot(const st_folder *folder, unsigned slot, st_mark *out)
{
    unsigned char bytes[SLOT];
    uint32_t sum;
    if (pread(folder->mark, bytes, SLOT, (off_t)(slot * SLOT)) != SLOT) {
        return false;
    }
    memcpy(&out->store, bytes, 8);
    memcpy(&out->commits, bytes + 8, 8);
    memcpy(&out->position, bytes + 16, 8);
    memcpy(&sum, bytes + SUM_AT, sizeof sum);
    return sum == st_crc32c(0, bytes, SUM_AT);
}

bool st_mark_read(st_folder *folder, st_mark *out)
{
    bool found = false;
    for (unsigned slot = 0; slot < SLOTS; slot++) {
        st_mark mark;
        if (read_slot(folder, slot, &mark) && (!found || mark.commits > out->commits)) {
            *out = mark;
            found = true;
        }
    }
    return found;
}

bool st_mark_write(st_folder *folder, const st_mark *mark)
{
    unsigned char bytes[SLOT] = {0};
    memcpy(bytes, &mark->store, 8);
    memcpy(bytes + 8, &mark->commits, 8);
    memcpy(bytes + 16, &mark->position, 8);
    uint32_t sum = st_crc32c(0, bytes, SUM_AT);
    memcpy(bytes + SUM_AT, &sum, sizeof sum);
    off_t at = (off_t)(mark->commits % SLOTS * SLOT);
    return pwrite(folder->mark, bytes, SLOT, at) == SLOT ||
           st_folder_fail(folder, "cannot write", "hedge.mark");
}

bool st_mark_sync(st_folder *folder)
{
    return fdatasync(folder->mark) == 0 || st_folder_fail(folder, "cannot sync", "hedge.mark");
}

/* --- the ballast, a file that reserves disk space --- */

bool st_ballast_make(st_folder *folder)
{
    struct stat status;
    if (fstatat(folder->folder, "ballast", &status, 0) == 0 && status.st_size == BALLAST_BYTES) {
        return true;
    }
    int file = openat(folder->folder, "ballast", O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) {
        return st_folder_fail(folder, "cannot make", "ballast");
    }
    errno = posix_fallocate(file, 0, BALLAST_BYTES);
    bool made = errno == 0 || st_folder_fail(folder, "cannot make", "ballast");
    close_file(file);
    if (!made) {
        (void)unlinkat(folder->folder, "ballast", 0);
    }
    return made;
}

/* Returns true if the file system reports enough free blocks and they can be allocated. Without
 * allocating blocks it would stay unknown whether the disk quota of the user is exhausted. */
bool st_folder_has_space(st_folder *folder)
{
    struct statvfs space;
    if (fstatvfs(folder->folder, &space) == 0 &&
        (uint64_t)space.f_bavail * space.f_frsize < SPACE_BYTES) {
        return false;
    }
    int file = openat(folder->folder, "space", O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    (void)unlinkat(folder->folder, "space", 0);
    const bool has = file >= 0 && posix_fallocate(file, 0, SPACE_BYTES) == 0;
    close_file(file);
    return has;
}

bool st_ballast_drop(st_folder *folder)
{
    return unlinkat(folder->folder, "ballast", 0) == 0;
}

bool st_ballast_drop_for_start(st_folder *folder)
{
    struct statvfs space;
    return fstatvfs(folder->folder, &space) == 0 &&
           (uint64_t)space.f_bavail * space.f_frsize < START_BYTES && st_ballast_drop(folder);
}
