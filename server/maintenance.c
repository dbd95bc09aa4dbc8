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
    printf("%s is restored from %s; the previous store is in %s\n", folder, file, before);
    return 0;
}

/* --- visiting all meshes of a store --- */

/* A function that processes a mesh; `whole` is false if the mesh is damaged and `content` is only
 * what is left of it. Returns false on failure, after it has printed why. */
typedef bool visit(void *context, const st_mesh_info *info, const he_mesh *content, bool whole);

static void stay_open(void *self)
{
    (void)self;
}

/* Prints the damage of a mesh, and passes the undamaged state that is left of the mesh to
 * `each`. */
static void visit_damaged(const st_card *card, st_mesh *mesh, const char *damage, visit *each,
                          void *context)
{
    st_mesh_info info;
    printf("%s: DAMAGED: %s\n", card->id, damage);
    if (mesh != NULL) {
        const he_mesh *content = st_read_begin(mesh, &info);
        (void)each(context, &info, content, false);
        st_read_end(mesh);
    }
}

/* Reads one mesh of a store and passes it to `each`, or prints why it cannot be read. Returns true
 * if the mesh is undamaged and was processed. The store must be opened for this mesh alone, so that
 * only one mesh is in memory at a time. */
static bool visit_in(st_store *store, const st_card *card, visit *each, void *context)
{
    st_mesh *mesh = NULL;
    st_mesh_info info;
    char damage[ST_DAMAGE] = "";
    const st_status status =
        store == NULL ? ST_NO_MEMORY : st_salvage(store, card->id, &mesh, damage);
    bool good = status == ST_ABSENT; /* a daemon deleted it meanwhile */
    if (status == ST_DAMAGED ||
        (status == ST_OK && (damage[0] != '\0' || card->damage[0] != '\0'))) {
        visit_damaged(card, mesh, damage[0] != '\0' ? damage : card->damage, each, context);
    } else if (status == ST_OK) {
        const he_mesh *content = st_read_begin(mesh, &info);
        good = each(context, &info, content, true);
        st_read_end(mesh);
    } else if (status == ST_NEWER) {
        printf("%s: WRITTEN BY A NEWER RELEASE: %s\n", card->id, damage);
    } else if (status != ST_ABSENT) {
        printf("%s: NOT READ: %s\n", card->id,
               status == ST_FAILED ? "a read of the disk failed"
                                   : "not enough memory for this mesh");
    }
    st_release(mesh);
    return good;
}

static bool visit_mesh(const st_journal *journal, const st_card *card, visit *each, void *context)
{
    st_journal lent = *journal;
    lent.close = stay_open;
    st_store *store = st_store_new(
        &(st_store_options){.undo_budget = UINT64_MAX, .max_meshes = UINT64_MAX, .journal = lent});
    const bool good = visit_in(store, card, each, context);
    st_store_free(store);
    return good;
}

/* Returns true if the text is a valid id of a mesh. This is checked because the id becomes a file
 * name, and in a damaged or forged store an id may be any text. */
static bool is_id(const char *id)
{
    return id[0] != '\0' && id[0] != '.' &&
           strspn(id, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") ==
               strlen(id);
}

static bool visit_card(const st_journal *journal, const st_card *card, visit *each, void *context)
{
    if (!is_id(card->id)) {
        printf("(a mesh without an id): DAMAGED: its id cannot be read\n");
        return false;
    }
    return visit_mesh(journal, card, each, context);
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
            counts[visit_card(journal, &cards[i], each, context) ? 0 : 1]++;
        }
        if (count > 0) {
            memcpy(after, cards[count - 1].id, sizeof after);
        }
    }
    return true;
}

static void say_fault(void *context, const char *what)
{
    const char *path = context;
    printf("%s: DAMAGED: %s\n", path, what);
}

/* Opens a store, passes each of its meshes to `each`, and prints for how many that succeeded;
 * `done` is the word for success, such as "written". A damaged file is read as far as possible.
 * Returns the exit status of the process. */
static int look(const char *path, visit *each, void *context, const char *done)
{
    st_sqlite_opened out;
    uint64_t counts[2] = {0, 0};
    if (!st_sqlite_look(path, &out)) {
        return fail(out.message);
    }
    const unsigned faults = st_sqlite_faults(&out.journal, say_fault, (void *)(uintptr_t)path);
    const uint64_t there = out.journal.count(out.journal.self);
    const bool all = visit_all(&out.journal, each, context, counts);
    out.journal.close(out.journal.self);
    const uint64_t reached = counts[0] + counts[1];
    printf("%" PRIu64 " meshes %s, %" PRIu64 " not", counts[0], done, counts[1]);
    if (faults > 0 && there > reached) {
        printf(", %" PRIu64 " cannot be found", there - reached);
    }
    printf(faults > 0 ? "; the database file itself is damaged\n" : "\n");
    if (!all) {
        return fail("not all meshes could be listed, because the list cannot be read to its end");
    }
    return counts[1] == 0 && faults == 0 ? 0 : 1;
}

/* --- verify --- */

static bool say_whole(void *context, const st_mesh_info *info, const he_mesh *content, bool whole)
{
    (void)context;
    printf("%s: %s, revision %" PRIu64 ", %u vertices, %u faces\n", info->id,
           whole ? "whole" : "only an earlier state of the mesh is undamaged", info->revision,
           (unsigned)he_mesh_vertices(content), (unsigned)he_mesh_faces(content));
    return true;
}

/* --- dump --- */

/* Writes a mesh as a GLB file. On failure no file is left. */
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

/* Writes a mesh to a file that is named after the mesh's id, and adds a line about it to the list.
 * Ids consist of letters, digits, '-', '_' and '.', so they are valid file names. If only a part of
 * a damaged mesh is left, the name contains its revision, so that the file is not mistaken for the
 * whole mesh. */
static bool dump_mesh(void *context, const st_mesh_info *info, const he_mesh *content, bool whole)
{
    const dump *d = context;
    char path[PATH_MAX], name[ST_MESH_ID + 64], revision[32];
    (void)snprintf(revision, sizeof revision, ".revision-%" PRIu64, info->revision);
    (void)snprintf(name, sizeof name, "%s%s.glb", info->id, whole ? "" : revision);
    int length = snprintf(path, sizeof path, "%s/%s", d->folder, name);
    if (length >= PATH_MAX || !write_glb(path, content)) {
        printf("%s: NOT WRITTEN\n", info->id);
        return false;
    }
    if (!whole) {
        printf("%s: saved as it was at revision %" PRIu64 ", in %s\n", info->id, info->revision,
               name);
    }
    fprintf(d->list, "%s\t%" PRIu64 "\t%s\n", name, info->revision, info->name);
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
        return fail("a store in memory keeps nothing on the disk: give the folder of a store with "
                    "--store sqlite:DIR");
    }
    return config->backup != NULL    ? backup(folder, config->backup)
           : config->restore != NULL ? restore(folder, config->restore)
           : config->dump != NULL    ? dump_all(folder, config->dump)
                                     : look(folder, say_whole, NULL, "whole");
}
