#include "system/memory_limit.h"

#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The most bytes that are read of a line of /proc/self/mountinfo. A longer line can only be that of
 * an overlay file system with many layers. */
enum { LINE = 8192, DIGITS = 19 };

/* A version of Linux control groups: the name of its file system, and the files that state limits
 * of memory. memory.high counts as a limit, too, because the kernel slows down a group that exceeds
 * it until the group hardly runs. */
typedef struct version {
    const char *filesystem;
    const char *files[3];
} version;

static const version versions[] = {
    {"cgroup", {"memory.limit_in_bytes", NULL}},
    {"cgroup2", {"memory.max", "memory.high", NULL}},
};

enum { VERSION_1, VERSION_2, VERSIONS };

/* The path of the control group to which the process belongs, in the tree of groups of each
 * version; empty if the process belongs to no group of that version. */
typedef struct membership {
    char path[VERSIONS][PATH_MAX];
} membership;

/* Reads a limit from a file. "max", or any other text that is no number, means no limit. */
static uint64_t read_limit(const char *path)
{
    char text[32];
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return UINT64_MAX;
    }
    ssize_t length = read(fd, text, sizeof text), digits = 0;
    close(fd);
    uint64_t limit = 0;
    while (digits < length && digits < DIGITS && text[digits] >= '0' && text[digits] <= '9') {
        limit = limit * 10 + (uint64_t)(text[digits++] - '0');
    }
    return digits == 0 ? UINT64_MAX : limit;
}

static void keep_smallest(st_memory_limit *limit, uint64_t bytes, const char *source)
{
    size_t length = strlen(source);
    size_t skip = length < sizeof limit->source ? 0 : length - (sizeof limit->source - 1);
    if (bytes < limit->bytes) {
        limit->bytes = bytes;
        memcpy(limit->source, source + skip, length - skip + 1);
    }
}

/* Reads the next line, without the newline; a line that is too long is cut. Returns false after the
 * last line. */
static bool next_line(FILE *file, char line[LINE])
{
    if (fgets(line, LINE, file) == NULL) {
        return false;
    }
    size_t length = strlen(line);
    if (length > 0 && line[length - 1] == '\n') {
        line[length - 1] = '\0';
        return true;
    }
    int c = getc(file);
    while (c != '\n' && c != EOF) {
        c = getc(file);
    }
    return true;
}

/* Returns true if `word` is in a list of words that are separated by commas. */
static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; at != NULL; at = strchr(at, ',')) {
        at += *at == ',' ? 1 : 0;
        if (strncmp(at, word, length) == 0 && (at[length] == ',' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

static FILE *open_beneath(const char *root, const char *name)
{
    char path[PATH_MAX];
    int length = snprintf(path, sizeof path, "%s%s", root, name);
    return length < 0 || (size_t)length >= sizeof path ? NULL : fopen(path, "re");
}

/* Reads from /proc/self/cgroup to which control group of each version the process belongs. A line
 * of this file is NUMBER:CONTROLLERS:PATH; the line of version 2 names no controllers. */
static void read_membership(const char *root, membership *m)
{
    char line[LINE];
    memset(m, 0, sizeof *m);
    FILE *file = open_beneath(root, "/proc/self/cgroup");
    while (file != NULL && next_line(file, line)) {
        char *controllers = strchr(line, ':');
        char *path = controllers == NULL ? NULL : strchr(controllers + 1, ':');
        if (path == NULL) {
            continue;
        }
        controllers++;
        *path++ = '\0';
        bool second = controllers[0] == '\0';
        if (second || has_word(controllers, "memory")) {
            snprintf(m->path[second ? VERSION_2 : VERSION_1], PATH_MAX, "%s", path);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
}

/* Replaces octal escapes in a path, such as \040, by which mountinfo writes blanks and similar
 * characters. */
static void unescape(char *text)
{
    char *to = text;
    for (const char *from = text; *from != '\0';) {
        bool escaped = from[0] == '\\' && from[1] >= '0' && from[1] <= '3' && from[2] >= '0' &&
                       from[2] <= '7' && from[3] >= '0' && from[3] <= '7';
        *to++ =
            escaped ? (char)((from[1] - '0') * 64 + (from[2] - '0') * 8 + from[3] - '0') : *from;
        from += escaped ? 4 : 1;
    }
    *to = '\0';
}

typedef struct mount {
    char *root;  /* path of the control group that is visible at the folder `point` */
    char *point; /* the folder where the tree of control groups is mounted */
    char *filesystem;
    /* Options of the mounted file system. For control groups of version 1 they include the names of
     * controllers, such as "memory". */
    char *options;
} mount;

/* Parses a line of mountinfo: NUMBER PARENT DEVICE ROOT POINT OPTIONS [FIELD...] - FILESYSTEM
 * SOURCE OPTIONS */
static bool parse_mount(char *line, mount *m)
{
    char *tail = strstr(line, " - "), *rest = NULL;
    if (tail == NULL) {
        return false;
    }
    *tail = '\0';
    strtok_r(line, " ", &rest);
    strtok_r(NULL, " ", &rest);
    strtok_r(NULL, " ", &rest);
    m->root = strtok_r(NULL, " ", &rest);
    m->point = strtok_r(NULL, " ", &rest);
    m->filesystem = strtok_r(tail + 3, " ", &rest);
    char *source = strtok_r(NULL, " ", &rest);
    m->options = strtok_r(NULL, " ", &rest);
    if (m->root == NULL || m->point == NULL || source == NULL || m->options == NULL) {
        return false;
    }
    unescape(m->root);
    unescape(m->point);
    return true;
}

/* Returns the rest of `path` after the folder `above`: "" if the paths are equal, NULL if `path` is
 * not inside `above`. */
static const char *below(const char *path, const char *above)
{
    size_t length = strlen(above);
    if (strcmp(above, "/") == 0) {
        return path;
    }
    if (strncmp(path, above, length) != 0 || (path[length] != '/' && path[length] != '\0')) {
        return NULL;
    }
    return path + length;
}

/* Reads the limits of the process's control group and of all groups above it that are visible in
 * the folder of this mount. If the process's group is not visible there, only the limit of the
 * group at the root of the mount is read: it is either a group above the process's group (whose
 * path then begins with "/.."), or the only group that is visible. */
static void look_through(const char *root, const mount *m, const version *v, const char *path,
                         st_memory_limit *limit)
{
    char folder[PATH_MAX], file[PATH_MAX + 64];
    const char *inside = below(path, m->root);
    bool outside = inside == NULL || strstr(inside, "/..") != NULL;
    int length = snprintf(folder, sizeof folder, "%s%s%s", root, m->point, outside ? "" : inside);
    size_t base = strlen(root) + strlen(m->point);
    if (length < 0 || (size_t)length >= sizeof folder) {
        return;
    }
    for (;;) {
        for (size_t i = 0; v->files[i] != NULL; i++) {
            size_t end = strlen(folder);
            bool slash = end > 0 && folder[end - 1] == '/';
            snprintf(file, sizeof file, "%s%s%s", folder, slash ? "" : "/", v->files[i]);
            keep_smallest(limit, read_limit(file), file + strlen(root));
        }
        char *last = strrchr(folder, '/');
        if (strlen(folder) <= base || last == NULL) {
            return;
        }
        *(last < folder + base ? folder + base : last) = '\0';
    }
}

uint64_t st_memory_limit_machine(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (uint64_t)pages * (uint64_t)size : 0;
}

st_memory_limit st_memory_limit_find(const char *root, uint64_t machine)
{
    char line[LINE];
    membership in;
    st_memory_limit limit = {.bytes = UINT64_MAX, .source = ""};
    keep_smallest(&limit, machine == 0 ? UINT64_MAX : machine, "the machine");
    read_membership(root, &in);
    FILE *file = open_beneath(root, "/proc/self/mountinfo");
    while (file != NULL && next_line(file, line)) {
        mount m;
        if (!parse_mount(line, &m)) {
            continue;
        }
        for (size_t i = 0; i < VERSIONS; i++) {
            bool here = strcmp(m.filesystem, versions[i].filesystem) == 0 &&
                        in.path[i][0] != '\0' && (i == VERSION_2 || has_word(m.options, "memory"));
            if (here) {
                look_through(root, &m, &versions[i], in.path[i], &limit);
            }
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return limit;
}
