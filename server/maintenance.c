#include "server/maintenance.h"

#include "base/mem.h"
#include "format/io/format.h"
#include "journal/sqlite/sqlite_backup.h"
#include "store/store.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>

bool srv_maintenance_asked(const srv_config *config)
{
    return config->backup != NULL || config->restore != NULL || config->dump != NULL ||
           config->verify;
}

static int fail(const char *why)
{
    fprintf(stderr, "hedged: %s\n", why);
    return 1;
}

static int backup(const char *folder, const char *file)
{
    char message[ST_SQLITE_MESSAGE];
    st_sqlite_opened out;
    if (!st_sqlite_backup(folder, file, message)) {
        return fail(message);
    }
    if (!st_sqlite_look(file, &out)) {
        return fail(out.message);
    }
    printf("%s holds %" PRIu64 " meshes of %s\n", file, out.journal.count(out.journal.self),
           folder);
    out.journal.close(out.journal.self);
    return 0;
}

static int restore(const char *folder, const char *file)
{
    char message[ST_SQLITE_MESSAGE], before[ST_SQLITE_MESSAGE];
    if (!st_sqlite_restore(folder, file, before, message)) {
        return fail(message);
    }
    printf("%s is restored from %s; what was there before is in %s\n", folder, file, before);
    return 0;
}

/* --- each mesh in turn --- */

/* What is done with a mesh that is whole. False with a line on stderr. */
typedef bool visit(void *context, const st_card *card, const he_mesh *content);

static void stay_open(void *self)
{
    (void)self;
}

/* Loads the mesh as the daemon would, into a store of its own, so that one mesh at a time is in
 * memory. */
static bool visit_mesh(const st_journal *journal, const st_card *card, visit *each, void *context)
{
    st_mesh *mesh;
    st_journal lent = *journal;
    lent.close = stay_open;
    st_store *store = st_store_new(
        &(st_store_options){.undo_budget = UINT64_MAX, .max_meshes = UINT64_MAX, .journal = lent});
    st_status status = store == NULL ? ST_NO_MEMORY : st_load(store, card->id, &mesh);
    bool good = false;
    if (status == ST_OK) {
        st_mesh_info info;
        const he_mesh *content = st_read_begin(mesh, &info);
        if (info.unreadable != ST_OK) {
            printf("%s: %s: %s\n", card->id,
                   info.unreadable == ST_DAMAGED ? "DAMAGED" : "OF A NEWER RELEASE",
                   st_damage(mesh));
        } else {
            good = each(context, card, content);
        }
        st_read_end(mesh);
        st_release(mesh);
    } else if (status == ST_ABSENT) {
        good = true; /* it was removed since, by a daemon beside */
    } else {
        printf("%s: NOT READ: %s\n", card->id,
               status == ST_FAILED ? "the disk refused to" : "memory is out");
    }
    st_store_free(store);
    return good;
}

enum { PAGE = 64 };

static bool visit_all(const st_journal *journal, visit *each, void *context, uint64_t counts[2])
{
    st_card cards[PAGE];
    char after[ST_MESH_ID + 1] = "";
    size_t count = PAGE;
    while (count == PAGE) {
        if (journal->list(journal->self, after, cards, PAGE, &count) != ST_OK) {
            return false;
        }
        for (size_t i = 0; i < count; i++) {
            counts[visit_mesh(journal, &cards[i], each, context) ? 0 : 1]++;
        }
        if (count > 0) {
            memcpy(after, cards[count - 1].id, sizeof after);
        }
    }
    return true;
}

static int look(const char *path, visit *each, void *context, const char *done)
{
    st_sqlite_opened out;
    uint64_t counts[2] = {0, 0};
    if (!st_sqlite_look(path, &out)) {
        return fail(out.message);
    }
    bool all = visit_all(&out.journal, each, context, counts);
    out.journal.close(out.journal.self);
    printf("%" PRIu64 " meshes %s, %" PRIu64 " not\n", counts[0], done, counts[1]);
    if (!all) {
        return fail("the list of meshes cannot be read to its end");
    }
    return counts[1] == 0 ? 0 : 1;
}

/* --- verify --- */

static bool say_whole(void *context, const st_card *card, const he_mesh *content)
{
    (void)context;
    printf("%s: whole, revision %" PRIu64 ", %u vertices, %u faces\n", card->id, card->revision,
           (unsigned)he_mesh_vertices(content), (unsigned)he_mesh_faces(content));
    return true;
}

/* --- dump --- */

/* A file that was written to its end, or is not there. */
static bool write_glb(const char *path, const he_mesh *content)
{
    char bytes[4096];
    size_t size;
    he_writer *writer = NULL;
    he_error err;
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        fprintf(stderr, "hedged: %s: %s\n", path, strerror(errno));
        return false;
    }
    bool good = he_writer_new(he_format_find("glb"), content, 0, NULL, &writer, &err) == HE_OK;
    if (!good) {
        fprintf(stderr, "hedged: %s: %s\n", path, err.text);
    }
    while (good && (size = he_writer_read(writer, bytes, sizeof bytes)) > 0) {
        good = fwrite(bytes, 1, size, file) == size;
    }
    he_writer_free(writer);
    good = fclose(file) == 0 && good;
    if (!good) {
        (void)remove(path);
    }
    return good;
}

typedef struct dump {
    const char *folder;
    FILE *list;
} dump;

/* Ids are letters, digits, '-', '_' and '.': names of files. */
static bool dump_mesh(void *context, const st_card *card, const he_mesh *content)
{
    const dump *d = context;
    char path[PATH_MAX];
    int length = snprintf(path, sizeof path, "%s/%s.glb", d->folder, card->id);
    if (length >= PATH_MAX || !write_glb(path, content)) {
        printf("%s: NOT WRITTEN\n", card->id);
        return false;
    }
    fprintf(d->list, "%s.glb\t%" PRIu64 "\t%s\n", card->id, card->revision, card->name);
    return true;
}

static int dump_all(const char *store, const char *folder)
{
    char path[PATH_MAX];
    dump d = {.folder = folder};
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "hedged: %s: %s\n", folder, strerror(errno));
        return 1;
    }
    int length = snprintf(path, sizeof path, "%s/meshes.tsv", folder);
    d.list = length < PATH_MAX ? fopen(path, "w") : NULL;
    if (d.list == NULL) {
        fprintf(stderr, "hedged: %s: %s\n", path, strerror(errno));
        return 1;
    }
    fputs("file\trevision\tname\n", d.list);
    int status = look(store, dump_mesh, &d, "written");
    return fclose(d.list) == 0 ? status : fail("the list of meshes cannot be written");
}

int srv_maintenance_run(const srv_config *config)
{
    const char *folder = srv_config_folder(config);
    if (config->verify && config->verified != NULL) {
        return look(config->verified, say_whole, NULL, "whole");
    }
    if (folder == NULL) {
        return fail("a store in memory has nothing to work on: name one by --store sqlite:DIR");
    }
    return config->backup != NULL    ? backup(folder, config->backup)
           : config->restore != NULL ? restore(folder, config->restore)
           : config->dump != NULL    ? dump_all(folder, config->dump)
                                     : look(folder, say_whole, NULL, "whole");
}
