#include "system/process.h"

#include "format/text/number.h"
#include "system/clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Reads a file through a descriptor. A FILE of the C library would allocate memory that the memory
 * budget (memory.h) does not count. */
static void read_text(const char *path, char *out, size_t size)
{
    ssize_t got = -1;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
        got = read(fd, out, size - 1);
        close(fd);
    }
    out[got > 0 ? got : 0] = '\0';
}

/* Reads a number that may follow blanks. Returns the text after the number; NULL if there is no
 * number. */
static const char *read_number(const char *text, uint64_t *out)
{
    size_t used = 0;
    text += strspn(text, " ");
    const bool good = he_u64_parse(text, text + strlen(text), out, &used) == HE_OK;
    return good ? text + used : NULL;
}

static void read_memory(st_process *out)
{
    char text[128];
    uint64_t size, resident;
    const uint64_t page = (uint64_t)sysconf(_SC_PAGESIZE);
    read_text("/proc/self/statm", text, sizeof text);
    const char *at = read_number(text, &size);
    if (at != NULL && read_number(at, &resident) != NULL) {
        out->address_space = size * page;
        out->resident = resident * page;
    }
}

/* Reads from /proc/self/stat when the process was started, in clock ticks since the machine was
 * booted. It is word 22 of the file. The search begins after the second word, the name of the
 * process, which is in parentheses and may contain any character. */
static void read_start(st_process *out)
{
    char text[1024];
    struct timespec booted = {0};
    read_text("/proc/self/stat", text, sizeof text);
    const char *at = strrchr(text, ')');
    for (int word = 0; at != NULL && word < 20; word++) {
        at = strchr(at + 1, ' ');
    }
    uint64_t ticks;
    if (at != NULL && read_number(at, &ticks) != NULL &&
        clock_gettime(CLOCK_BOOTTIME, &booted) == 0) {
        const double now = (double)booted.tv_sec + (double)booted.tv_nsec / 1e9;
        const double age = now - (double)ticks / (double)sysconf(_SC_CLK_TCK);
        out->started = st_clock_utc() - age;
    }
}

/* Returns the number of open descriptors. Since Linux 6.2 it is the size of the folder
 * /proc/self/fd. On older systems the entries of the folder are counted, without the descriptor by
 * which the folder is read. */
static uint64_t count_descriptors(void)
{
    static const char folder[] = "/proc/self/fd";
    struct stat facts;
    if (stat(folder, &facts) == 0 && facts.st_size > 0) {
        return (uint64_t)facts.st_size;
    }
    uint64_t count = 0;
    DIR *open_ones = opendir(folder);
    if (open_ones == NULL) {
        return 0;
    }
    while (readdir(open_ones) != NULL) {
        count++;
    }
    closedir(open_ones);
    /* subtracts ".", ".." and the descriptor by which the folder is read */
    return count > 3 ? count - 3 : 0;
}

void st_process_read(st_process *out)
{
    struct timespec used = {0};
    struct rlimit files = {0};
    *out = (st_process){0};
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used) == 0) {
        out->processor = (double)used.tv_sec + (double)used.tv_nsec / 1e9;
    }
    if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
        out->most_descriptors = files.rlim_cur;
    }
    read_memory(out);
    read_start(out);
    out->descriptors = count_descriptors();
}
