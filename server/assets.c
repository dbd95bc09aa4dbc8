#include "server/assets.h"

#include "base/mem.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 160, HASH_LENGTH = 8 };

typedef struct asset {
    char path[PATH_SIZE];
    api_asset served;
} asset;

struct srv_assets {
    asset items[SRV_ASSET_COUNT];
    size_t count, bytes;
};

static const char notice[] =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>hedge</title></head>"
    "<body><h1>hedge</h1><p>The server is running, without its page: <code>make page</code> builds "
    "it. The API is at <a href=\"/v1/openapi.json\">/v1/openapi.json</a>.</p></body></html>\n";

static const char *media_type(const char *name)
{
    static const struct {
        const char *suffix, *type;
    } types[] = {
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".jpg", "image/jpeg"},
        {".webp", "image/webp"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".wasm", "application/wasm"},
        {".txt", "text/plain; charset=utf-8"},
    };
    size_t length = strlen(name);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        size_t suffix = strlen(types[i].suffix);
        if (length > suffix && strcmp(name + length - suffix, types[i].suffix) == 0) {
            return types[i].type;
        }
    }
    return "application/octet-stream";
}

/* Returns true if a file name ends in -HASH.SUFFIX, as bundlers write it: the hash has eight or
 * more letters and digits, and its letters are all capitals, or all between a and f. */
static bool carries_hash(const char *name)
{
    const char *dot = strchr(name, '.');
    const char *dash = strrchr(name, '-');
    if (dot == NULL || dash == NULL || dash > dot || dot - dash <= HASH_LENGTH) {
        return false;
    }
    size_t length = (size_t)(dot - dash) - 1;
    return strspn(dash + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") >= length ||
           strspn(dash + 1, "abcdef0123456789") >= length;
}

/* Removes the suffix .html from the path of a page, and the name "index" that may be left. Files in
 * /assets/ keep their names, because the files of a bundle refer to each other by them. */
static void shorten(char *path)
{
    static const char suffix[] = ".html", index[] = "/index";
    size_t length = strlen(path), tail = sizeof suffix - 1;
    if (strncmp(path, "/assets/", 8) != 0 && length > tail &&
        strcmp(path + length - tail, suffix) == 0) {
        path[length - tail] = '\0';
        if (strcmp(path, index) == 0) {
            path[1] = '\0';
        }
    }
}

/* Adds a file of the page: its bytes are served under `path`, but an HTML file outside /assets/
 * without the suffix .html. The media type follows from `name`. Returns false when memory is out.
 */
static bool add(srv_assets *assets, const char *path, const char *name, const char *bytes,
                size_t length)
{
    asset *item = &assets->items[assets->count];
    item->served = (api_asset){.type = media_type(name),
                               .immutable = carries_hash(name),
                               .body = api_kept_new(bytes, length)};
    if (item->served.body == NULL) {
        return false;
    }
    snprintf(item->path, sizeof item->path, "%s", path);
    shorten(item->path);
    assets->count++;
    assets->bytes += length;
    return true;
}

static char *read_all(int fd, size_t length)
{
    char *bytes = he_mem_alloc(length + 1);
    size_t done = 0;
    while (bytes != NULL && done < length) {
        ssize_t got = read(fd, bytes + done, length - done);
        if (got > 0) {
            done += (size_t)got;
        } else if (got == 0 || errno != EINTR) {
            he_mem_free(bytes);
            return NULL;
        }
    }
    return bytes;
}

/* A file of the page: the folder in which it lies, and the path under which it is served. */
typedef struct file {
    int folder;
    const char *name;
    const char *prefix; /* `prefix` precedes the file's name in the path of a request */
} file;

/* Reads a file of the page into memory and adds it, or skips it if it is not a regular file.
 * Returns false, with a sentence in `message`, if the file cannot be added. */
static bool add_file(srv_assets *assets, const file *from, char *message, size_t size)
{
    char path[PATH_SIZE];
    struct stat facts;
    const char *name = from->name;
    int fd = openat(from->folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 || fstat(fd, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        if (fd >= 0) {
            close(fd);
        }
        return true;
    }
    bool ok = false;
    char *bytes = NULL;
    size_t length = (size_t)facts.st_size;
    if (snprintf(path, sizeof path, "%s%s", from->prefix, name) >= (int)sizeof path) {
        snprintf(message, size,
                 "the name of the file %.60s... in the folder of the web page is too long", name);
    } else if (assets->count == SRV_ASSET_COUNT ||
               length > (size_t)SRV_ASSET_BYTES - assets->bytes) {
        snprintf(message, size, "the folder of the web page has more than %d files or %d bytes",
                 SRV_ASSET_COUNT, SRV_ASSET_BYTES);
    } else if ((bytes = read_all(fd, length)) == NULL || !add(assets, path, name, bytes, length)) {
        snprintf(message, size, "the file %s of the web page cannot be read into memory", name);
    } else {
        ok = true;
    }
    he_mem_free(bytes);
    close(fd);
    return ok;
}

/* Adds the files of a folder, if it exists, and those of the folders in it down to `depth` levels.
 * Their paths begin with from->prefix. Hidden files are skipped. Returns false, with a sentence in
 * `message`, if a file cannot be added. */
static bool add_folder(srv_assets *assets, const file *from, int depth, char *message, size_t size)
{
    int fd = openat(from->folder, from->name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *listing = fd < 0 ? NULL : fdopendir(fd);
    if (listing == NULL) {
        if (fd >= 0) {
            close(fd);
        }
        return true;
    }
    bool ok = true;
    const struct dirent *entry;
    while (ok && (entry = readdir(listing)) != NULL) {
        char prefix[PATH_SIZE];
        if (entry->d_name[0] == '.') {
            continue;
        }
        ok = add_file(assets, &(file){fd, entry->d_name, from->prefix}, message, size);
        if (ok && depth > 0 &&
            snprintf(prefix, sizeof prefix, "%s%s/", from->prefix, entry->d_name) <
                (int)sizeof prefix) {
            ok = add_folder(assets, &(file){fd, entry->d_name, prefix}, depth - 1, message, size);
        }
    }
    closedir(listing);
    return ok;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(((const asset *)a)->path, ((const asset *)b)->path);
}

static int compare_path(const void *path, const void *item)
{
    return strcmp(path, ((const asset *)item)->path);
}

static bool load(srv_assets *assets, const char *folder, char *message, size_t size)
{
    int root = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (root < 0) {
        snprintf(message, size, "%.200s is not a folder with the web page", folder);
        return false;
    }
    bool ok = add_file(assets, &(file){root, "index.html", "/"}, message, size);
    if (ok && assets->count == 0) {
        snprintf(message, size, "%.200s has no index.html", folder);
        ok = false;
    }
    ok = ok && add_file(assets, &(file){root, "docs.html", "/"}, message, size) &&
         add_folder(assets, &(file){root, "docs", "/docs/"}, 1, message, size) &&
         add_folder(assets, &(file){root, "assets", "/assets/"}, 0, message, size);
    close(root);
    qsort(assets->items, assets->count, sizeof *assets->items, compare_paths);
    return ok;
}

static void clear(srv_assets *assets)
{
    for (size_t i = 0; i < assets->count; i++) {
        api_kept_free(assets->items[i].served.body);
    }
    assets->count = 0;
    assets->bytes = 0;
}

srv_assets *srv_assets_load(const char *folder, char *message, size_t size)
{
    srv_assets *assets = he_mem_zero(1, sizeof *assets);
    if (assets == NULL) {
        return NULL;
    }
    message[0] = '\0';
    if (folder != NULL && load(assets, folder, message, size)) {
        return assets;
    }
    clear(assets);
    if (!add(assets, "/", "notice.html", notice, sizeof notice - 1)) {
        he_mem_free(assets);
        return NULL;
    }
    return assets;
}

void srv_assets_free(srv_assets *assets)
{
    if (assets != NULL) {
        clear(assets);
        he_mem_free(assets);
    }
}

const api_asset *srv_assets_find(void *context, const char *path)
{
    const srv_assets *assets = context;
    const asset *found =
        bsearch(path, assets->items, assets->count, sizeof *assets->items, compare_path);
    return found == NULL ? NULL : &found->served;
}

static bool is_folder(const char *path)
{
    struct stat facts;
    return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
}

bool srv_assets_folder(const char *configured, char *out, size_t size)
{
    if (configured[0] != '\0') {
        return snprintf(out, size, "%s", configured) < (int)size;
    }
    char executable[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", executable, sizeof executable - 1);
    if (length <= 0) {
        return false;
    }
    executable[length] = '\0';
    *strrchr(executable, '/') = '\0';
    static const char *const places[] = {"web", "../share/hedge/web"};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        if (snprintf(out, size, "%s/%s", executable, places[i]) < (int)size && is_folder(out)) {
            return true;
        }
    }
    return false;
}
