#include "tests/store_folder.h"

#include "stored/stored.h"

#include <assert.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- folders --- */

static const char *const copied[] = {"hedge.db", "hedge.db-wal", "hedge.db-shm", "hedge.mark"};
enum { COPIED = sizeof copied / sizeof *copied };

void folder_make(char out[FOLDER_PATH])
{
    const char *base = getenv("TMPDIR");
    (void)snprintf(out, FOLDER_PATH, "%s/hedge-store-XXXXXX", base == NULL ? "/tmp" : base);
    if (mkdtemp(out) == NULL) {
        perror(out);
        abort();
    }
}

void folder_remove(const char *folder)
{
    DIR *open_folder = opendir(folder);
    for (struct dirent *e; open_folder != NULL && (e = readdir(open_folder)) != NULL;) {
        if (unlinkat(dirfd(open_folder), e->d_name, 0) != 0 && e->d_name[0] != '.') {
            char inner[2 * FOLDER_PATH];
            (void)snprintf(inner, sizeof inner, "%s/%s", folder, e->d_name);
            folder_remove(inner);
        }
    }
    if (open_folder != NULL) {
        (void)closedir(open_folder);
    }
    (void)rmdir(folder);
}

unsigned char *folder_read(const char *folder, const char *name, size_t *size)
{
    char path[2 * FOLDER_PATH];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    (void)fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    size_t got = fread(bytes, 1, *size, file);
    assert(got == *size);
    (void)fclose(file);
    return bytes;
}

void folder_write(const char *folder, const char *name, const unsigned char *bytes, size_t size)
{
    char path[2 * FOLDER_PATH];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    size_t put = file == NULL ? 0 : fwrite(bytes, 1, size, file);
    if (file == NULL || put != size || fclose(file) != 0) {
        perror(path);
        abort();
    }
}

/* The file hedge.db-shm is not copied: SQLite rebuilds it from hedge.db-wal, whatever a killed
 * process has left in it. */
void folder_copy(const char *from, const char *to)
{
    for (size_t i = 0; i < COPIED; i++) {
        size_t size;
        unsigned char *bytes = folder_read(from, copied[i], &size);
        if (bytes != NULL && strcmp(copied[i], "hedge.db-shm") != 0) {
            folder_write(to, copied[i], bytes, size);
        }
        free(bytes);
    }
}

/* --- what a journal reported to its listener --- */

static void on_moved(void *context, uint64_t position)
{
    told_journal *told = context;
    pthread_mutex_lock(&told->lock);
    assert(position >= told->position);
    told->position = position;
    pthread_cond_broadcast(&told->changed);
    pthread_mutex_unlock(&told->lock);
}

static void on_lost(void *context, const st_loss *loss)
{
    told_journal *told = context;
    pthread_mutex_lock(&told->lock);
    told->loss = *loss;
    told->losses++;
    pthread_mutex_unlock(&told->lock);
}

void told_begin(told_journal *told, const st_journal *journal)
{
    *told = (told_journal){.journal = *journal};
    pthread_mutex_init(&told->lock, NULL);
    pthread_cond_init(&told->changed, NULL);
    const st_journal_listener listener = {told, on_moved, on_lost};
    journal->listen(journal->self, &listener);
}

void told_open(told_journal *told, const char *folder)
{
    st_sqlite_opened opened;
    if (!st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = "test"}, &opened)) {
        (void)fprintf(stderr, "%s: %s\n", folder, opened.message);
        abort();
    }
    told_begin(told, &opened.journal);
}

void told_wait(told_journal *told, uint64_t position)
{
    pthread_mutex_lock(&told->lock);
    while (told->position < position) {
        pthread_cond_wait(&told->changed, &told->lock);
    }
    pthread_mutex_unlock(&told->lock);
}

unsigned told_losses(told_journal *told)
{
    pthread_mutex_lock(&told->lock);
    unsigned losses = told->losses;
    pthread_mutex_unlock(&told->lock);
    return losses;
}

void told_end(told_journal *told)
{
    told->journal.close(told->journal.self);
    pthread_cond_destroy(&told->changed);
    pthread_mutex_destroy(&told->lock);
}

/* --- records of meshes --- */

static st_record next_record(kept_mesh *mesh, st_record_kind kind)
{
    st_record record = {.kind = kind,
                        .id = mesh->id,
                        .name = mesh->name,
                        .incarnation = mesh->incarnation,
                        .number = ++mesh->number,
                        .revision = mesh->revision,
                        .metadata = mesh->metadata,
                        .created = 1000,
                        .time = 1000 + (double)mesh->number,
                        .ops = "",
                        .bytes = 4096};
    if (mesh->content != NULL) {
        record.counts = (st_counts){he_mesh_vertices(mesh->content), he_mesh_edges(mesh->content),
                                    he_mesh_faces(mesh->content), 0};
    }
    return record;
}

st_record kept_content(kept_mesh *mesh)
{
    mesh->revision++;
    if (mesh->number == 0) {
        mesh->metadata = 1;
    }
    st_record record = next_record(mesh, ST_RECORD_CONTENT);
    record.barrier = true;
    return record;
}

st_record kept_edit(kept_mesh *mesh)
{
    mesh->revision++;
    st_record record = next_record(mesh, ST_RECORD_EDIT);
    record.ops = "vertex_move";
    return record;
}

st_record kept_rename(kept_mesh *mesh, const char *name)
{
    (void)snprintf(mesh->name, sizeof mesh->name, "%s", name);
    mesh->metadata++;
    return next_record(mesh, ST_RECORD_RENAME);
}

st_record kept_remove(kept_mesh *mesh)
{
    return next_record(mesh, ST_RECORD_REMOVE);
}

static st_status refused;

st_status kept_status(void)
{
    return refused;
}

uint64_t kept_append(const st_journal *journal, st_record record, const kept_mesh *mesh,
                     const void *body, size_t size)
{
    const bool is_content = record.kind == ST_RECORD_CONTENT && record.stage == NULL;
    const st_room_need need = {.records = 1,
                               .bytes = is_content ? he_stored_content_bound(mesh->content) : size,
                               .freeing = record.kind == ST_RECORD_REMOVE};
    st_room *room = NULL;
    refused = journal->reserve(journal->self, &need, &room);
    if (refused != ST_OK) {
        return 0;
    }
    record.body = room->bytes;
    record.body_size = size;
    if (is_content) {
        record.body_size = he_stored_content_write(mesh->content, room->bytes);
    } else if (size > 0) {
        memcpy(room->bytes, body, size);
    }
    return journal->append(journal->self, room, &record, 1);
}
