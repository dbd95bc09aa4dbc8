/* faults.c - simulates a disk that fails, is slow or loses power. It is preloaded into a daemon
 * (LD_PRELOAD) and replaces the C library's functions for files.
 *
 * It counts only calls on files below one folder. N is the number of a call in this count; the
 * first call has the number 1.
 *     FAULT_FOLDER=DIR   the folder, absolute and without symbolic links
 *     FAULT_WHEN=FILE    calls are only counted, and only fail, while this file exists
 *     FAULT_SYNC=N       the N-th fsync or fdatasync fails with EIO
 *     FAULT_WRITE=N      the N-th write fails with ENOSPC
 *     FAULT_STUCK=1      all later calls of the failed kind fail, too
 *     FAULT_SHORT=N      the N-th write is cut to half, the next one fails with ENOSPC
 *     FAULT_RENAME=N     the N-th rename fails with EIO
 *     FAULT_KILL=N       the process is killed before the N-th sync
 *     FAULT_CALL=N       the process is killed before the N-th call that changes the folder
 *     FAULT_SLOW=MS      each sync takes that many milliseconds longer
 *     FAULT_PLATTER=DIR  what is synced is copied there: what is left after a loss of power
 *     FAULT_REPORT=FILE  a line `fired ...` for each fault, and at the exit one with the counts
 * A run whose report has no line `fired` has proved nothing. */
#define _GNU_SOURCE /* declares RTLD_NEXT */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

/* Declares `real`, a pointer to the C library's function of this name, which this file replaces. */
#define REAL(result, name, ...)                         \
    static result (*real)(__VA_ARGS__);                 \
    do {                                                \
        if (real == NULL) {                             \
            *(void **)&real = dlsym(RTLD_NEXT, (name)); \
        }                                               \
    } while (0)

static struct {
    long sync, write, sticky, cut, rename, kill, call, slow;
    const char *folder, *when, *platter, *report;
} want;

static struct {
    atomic_long syncs, writes, renames, calls, fired;
} seen;

static long number(const char *name)
{
    const char *text = getenv(name);
    return text == NULL ? 0 : strtol(text, NULL, 10);
}

__attribute__((constructor)) static void begin(void)
{
    want.sync = number("FAULT_SYNC");
    want.write = number("FAULT_WRITE");
    want.sticky = number("FAULT_STUCK");
    want.cut = number("FAULT_SHORT");
    want.rename = number("FAULT_RENAME");
    want.kill = number("FAULT_KILL");
    want.call = number("FAULT_CALL");
    want.slow = number("FAULT_SLOW");
    want.platter = getenv("FAULT_PLATTER");
    want.report = getenv("FAULT_REPORT");
    want.when = getenv("FAULT_WHEN");
    want.folder = getenv("FAULT_FOLDER");
}

/* Writes a line to the report. It uses the C library's own functions, so that this write is not
 * counted and does not fail. */
static void tell(const char *line)
{
    REAL(ssize_t, "write", int, const void *, size_t);
    int fd = want.report == NULL
                 ? -1
                 : openat(AT_FDCWD, want.report, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd >= 0) {
        (void)!real(fd, line, strlen(line));
        close(fd);
    }
}

static void tell_fired(const char *what, long n)
{
    char line[64];
    seen.fired++;
    snprintf(line, sizeof line, "fired %s %ld\n", what, n);
    tell(line);
}

__attribute__((destructor)) static void end(void)
{
    char line[160];
    snprintf(line, sizeof line, "syncs %ld writes %ld renames %ld calls %ld fired %ld\n",
             (long)seen.syncs, (long)seen.writes, (long)seen.renames, (long)seen.calls,
             (long)seen.fired);
    tell(line);
}

static bool is_below(const char *path)
{
    size_t length = want.folder == NULL ? 0 : strlen(want.folder);
    return length > 0 && strncmp(path, want.folder, length) == 0 &&
           (path[length] == '/' || path[length] == '\0') &&
           (want.when == NULL || access(want.when, F_OK) == 0);
}

static bool path_of(int fd, char path[PATH_MAX])
{
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, PATH_MAX - 1);
    path[length < 0 ? 0 : length] = '\0';
    return length > 0;
}

static bool is_watched(int fd)
{
    char path[PATH_MAX];
    return want.folder != NULL && path_of(fd, path) && is_below(path);
}

static void die(const char *what, long n)
{
    tell_fired(what, n);
    kill(getpid(), SIGKILL);
}

/* Counts a call that is about to change the folder, and kills the process if the call is the one
 * that FAULT_CALL names. */
static void count_call(void)
{
    long n = ++seen.calls;
    if (n == want.call) {
        die("call", n);
    }
}

/* --- sync --- */

static void copy_to_platter(int fd, const char *name)
{
    REAL(ssize_t, "write", int, const void *, size_t);
    static char bytes[1 << 16];
    char copy[PATH_MAX + NAME_MAX], made[PATH_MAX + NAME_MAX + 4];
    snprintf(copy, sizeof copy, "%s/%s", want.platter, name);
    snprintf(made, sizeof made, "%s.new", copy);
    /* The file is read through the caller's descriptor. Opening and closing another descriptor
     * would release all POSIX locks that the process holds on the file. */
    int out = openat(AT_FDCWD, made, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    off_t at = 0;
    ssize_t got = 0;
    while (out >= 0 && (got = pread(fd, bytes, sizeof bytes, at)) > 0) {
        (void)!real(out, bytes, (size_t)got);
        at += got;
    }
    if (out >= 0) {
        close(out);
        (void)!renameat(AT_FDCWD, made, AT_FDCWD, copy);
    }
}

/* Removes from the copy of the disk (FAULT_PLATTER) each file that is no longer in the folder. This
 * happens when the folder itself is synced, because a removal is durable only then. */
static void clean_platter(const char *folder)
{
    DIR *platter = opendir(want.platter);
    const struct dirent *entry;
    while (platter != NULL && (entry = readdir(platter)) != NULL) {
        char path[PATH_MAX + NAME_MAX + 2];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.' && access(path, F_OK) != 0) {
            (void)unlinkat(dirfd(platter), entry->d_name, 0);
        }
    }
    if (platter != NULL) {
        closedir(platter);
    }
}

static void keep_on_platter(int fd)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    char path[PATH_MAX];
    struct stat status;
    if (want.platter == NULL || fstat(fd, &status) != 0 || !path_of(fd, path)) {
        return;
    }
    pthread_mutex_lock(&lock);
    if (S_ISDIR(status.st_mode)) {
        clean_platter(path);
    } else {
        copy_to_platter(fd, strrchr(path, '/') + 1);
    }
    pthread_mutex_unlock(&lock);
}

static int sync_file(int fd, int (*real)(int))
{
    if (!is_watched(fd)) {
        return real(fd);
    }
    count_call();
    long n = ++seen.syncs;
    if (n == want.kill) {
        die("kill", n);
    }
    if (want.sync > 0 && (n == want.sync || (want.sticky && n > want.sync))) {
        tell_fired("sync", n);
        errno = EIO;
        return -1;
    }
    if (want.slow > 0) {
        seen.fired == 0 ? tell_fired("slow", n) : (void)0;
        poll(NULL, 0, (int)want.slow);
    }
    int result = real(fd);
    if (result == 0) {
        keep_on_platter(fd);
    }
    return result;
}

int fsync(int fd)
{
    REAL(int, "fsync", int);
    return sync_file(fd, real);
}

int fdatasync(int fd)
{
    REAL(int, "fdatasync", int);
    return sync_file(fd, real);
}

/* --- writes --- */

/* Returns how many of the `size` bytes the write may write; -1, with errno set, if it must fail. */
static ssize_t admit(int fd, size_t size)
{
    if (!is_watched(fd)) {
        return (ssize_t)size;
    }
    count_call();
    long n = ++seen.writes;
    bool is_full = want.write > 0 && (n == want.write || (want.sticky && n > want.write));
    if (is_full || (want.cut > 0 && n == want.cut + 1)) {
        tell_fired("write", n);
        errno = ENOSPC;
        return -1;
    }
    if (n == want.cut && size > 1) {
        tell_fired("short", n);
        return (ssize_t)(size / 2);
    }
    return (ssize_t)size;
}

ssize_t write(int fd, const void *bytes, size_t size)
{
    REAL(ssize_t, "write", int, const void *, size_t);
    ssize_t may = admit(fd, size);
    return may < 0 ? -1 : real(fd, bytes, (size_t)may);
}

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t at)
{
    REAL(ssize_t, "pwrite", int, const void *, size_t, off_t);
    ssize_t may = admit(fd, size);
    return may < 0 ? -1 : real(fd, bytes, (size_t)may, at);
}

ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t at)
{
    REAL(ssize_t, "pwrite64", int, const void *, size_t, off64_t);
    ssize_t may = admit(fd, size);
    return may < 0 ? -1 : real(fd, bytes, (size_t)may, at);
}

ssize_t writev(int fd, const struct iovec *parts, int count)
{
    REAL(ssize_t, "writev", int, const struct iovec *, int);
    ssize_t may = admit(fd, 1);
    return may < 0 ? -1 : real(fd, parts, count);
}

/* --- other calls that change the folder --- */

int rename(const char *from, const char *to)
{
    REAL(int, "rename", const char *, const char *);
    if (is_below(from) || is_below(to)) {
        count_call();
        long n = ++seen.renames;
        if (n == want.rename) {
            tell_fired("rename", n);
            errno = EIO;
            return -1;
        }
    }
    return real(from, to);
}

int unlink(const char *path)
{
    REAL(int, "unlink", const char *);
    if (is_below(path)) {
        count_call();
    }
    return real(path);
}

static bool is_below_at(int folder, const char *path)
{
    return path[0] == '/' || folder == AT_FDCWD ? is_below(path) : is_watched(folder);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
    REAL(int, "renameat", int, const char *, int, const char *);
    if (is_below_at(from_folder, from) || is_below_at(to_folder, to)) {
        count_call();
    }
    return real(from_folder, from, to_folder, to);
}

int unlinkat(int folder, const char *path, int flags)
{
    REAL(int, "unlinkat", int, const char *, int);
    if (is_below_at(folder, path)) {
        count_call();
    }
    return real(folder, path, flags);
}

int openat(int folder, const char *path, int flags, ...)
{
    REAL(int, "openat", int, const char *, int, ...);
    va_list rest;
    va_start(rest, flags);
    mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    if ((flags & (O_CREAT | O_TRUNC)) != 0 && is_below_at(folder, path)) {
        count_call();
    }
    return real(folder, path, flags, mode);
}

int mkdir(const char *path, mode_t mode)
{
    REAL(int, "mkdir", const char *, mode_t);
    if (is_below(path)) {
        count_call();
    }
    return real(path, mode);
}

int ftruncate(int fd, off_t size)
{
    REAL(int, "ftruncate", int, off_t);
    if (is_watched(fd)) {
        count_call();
    }
    return real(fd, size);
}

int ftruncate64(int fd, off64_t size)
{
    REAL(int, "ftruncate64", int, off64_t);
    if (is_watched(fd)) {
        count_call();
    }
    return real(fd, size);
}

static int opened(const char *path, int flags, mode_t mode, int (*real)(const char *, int, ...))
{
    if ((flags & (O_CREAT | O_TRUNC)) != 0 && is_below(path)) {
        count_call();
    }
    return real(path, flags, mode);
}

int open(const char *path, int flags, ...)
{
    REAL(int, "open", const char *, int, ...);
    va_list rest;
    va_start(rest, flags);
    mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return opened(path, flags, mode, real);
}

int open64(const char *path, int flags, ...)
{
    REAL(int, "open64", const char *, int, ...);
    va_list rest;
    va_start(rest, flags);
    mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return opened(path, flags, mode, real);
}
