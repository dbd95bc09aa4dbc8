#include "tests/kept_journal.h"

#include "tests/journal_room.h"

#include "stored/stored.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A mesh that was written to the journal before it is published, encoded in parts. */
struct st_stage {
    size_t parts, capacity;
    struct {
        unsigned char *bytes;
        size_t size;
        unsigned coding;
    } * part;
};

/* A stored record. `uses` is a reference count: the mesh and each reader of the mesh have one
 * reference. */
typedef struct kept_record {
    size_t uses;
    /* The record. Its texts and its body are copies; its Idempotency-Key is not stored. */
    st_record record;
    char name[ST_MESH_NAME + 1];
    char ops[256];
    char moment[ST_MOMENT_NAME + 1];
    bool sum_is_wrong;
} kept_record;

typedef struct kept_mesh {
    st_card card;
    kept_record *base; /* the record with the whole mesh, which is encoded in parts */
    kept_record **records;
    size_t count, capacity, opened, parts;
    struct kept_mesh *next;
} kept_mesh;

struct kept_journal {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    kept_mesh *meshes; /* list of meshes, sorted by id */
    uint64_t newest;
    size_t out; /* number of rooms (reserved memory), stages (data written in advance) and readers
                   that are not freed yet */
    st_status refuse;
    size_t staged_edits; /* number of edits whose bytes were written in advance */
    bool ignores;
    bool stopped;
    size_t waiting;
    uint64_t secret[2];
};

/* Reads the records of one mesh that were stored when the reader was opened. */
struct st_reader {
    kept_journal *journal;
    char id[ST_MESH_ID + 1];
    kept_record **records; /* the base record, then the edits after it */
    size_t count, record, part;
    bool in_parts;
    char why[ST_DAMAGE];
};

static void *grown(void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity) {
        return array;
    }
    *capacity = *capacity == 0 ? 8 : 2 * *capacity;
    void *larger = realloc(array, *capacity * size);
    assert_non_null(larger);
    return larger;
}

static void count_out(kept_journal *journal, int by)
{
    pthread_mutex_lock(&journal->lock);
    journal->out = (size_t)((long)journal->out + by);
    pthread_mutex_unlock(&journal->lock);
}

/* --- rooms (reserved memory) and stages (data written in advance) --- */

static st_status reserve(void *self, const st_room_need *need, st_room **out)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    st_status refuse = journal->refuse;
    pthread_mutex_unlock(&journal->lock);
    st_status status = journal_room_new(refuse, need, out);
    count_out(journal, status == ST_OK);
    return status;
}

static void leave(void *self, st_room *room)
{
    if (room != NULL) {
        count_out(self, -1);
        journal_room_free(room);
    }
}

static void free_stage(st_stage *stage)
{
    if (stage != NULL) {
        for (size_t i = 0; i < stage->parts; i++) {
            free(stage->part[i].bytes);
        }
        free(stage->part);
        free(stage);
    }
}

static void add_part(st_stage *stage, const unsigned char *bytes, size_t size, unsigned coding)
{
    stage->part = grown(stage->part, stage->parts, &stage->capacity, sizeof *stage->part);
    stage->part[stage->parts].bytes = malloc(size);
    assert_non_null(stage->part[stage->parts].bytes);
    memcpy(stage->part[stage->parts].bytes, bytes, size);
    stage->part[stage->parts].size = size;
    stage->part[stage->parts++].coding = coding;
}

static st_status stage_content(void *self, const he_mesh *content, st_stage **out)
{
    kept_journal *journal = self;
    unsigned char bytes[HE_STORED_PART_ROOM];
    unsigned coding;
    size_t size;
    he_stored_writer writer;
    if (journal->refuse != ST_OK) {
        return journal->refuse;
    }
    st_stage *stage = calloc(1, sizeof *stage);
    assert_non_null(stage);
    he_stored_writer_init(&writer, content);
    while ((size = he_stored_writer_next(&writer, bytes, &coding)) > 0) {
        add_part(stage, bytes, size, coding);
    }
    *out = stage;
    count_out(journal, 1);
    return ST_OK;
}

static st_status stage_edit(void *self, const unsigned char *bytes, size_t size, st_stage **out)
{
    kept_journal *journal = self;
    if (journal->refuse != ST_OK) {
        return journal->refuse;
    }
    st_stage *stage = calloc(1, sizeof *stage);
    assert_non_null(stage);
    for (size_t at = 0; at < size; at += HE_STORED_PART) {
        const size_t left = size - at;
        add_part(stage, bytes + at, left < HE_STORED_PART ? left : HE_STORED_PART, HE_CODING_PLAIN);
    }
    *out = stage;
    count_out(journal, 1);
    pthread_mutex_lock(&journal->lock);
    journal->staged_edits++;
    pthread_mutex_unlock(&journal->lock);
    return ST_OK;
}

static void unstage(void *self, st_stage *stage)
{
    if (stage != NULL) {
        count_out(self, -1);
        free_stage(stage);
    }
}

/* --- storing records, with the lock held --- */

static kept_mesh **place_of(kept_journal *journal, const char *id)
{
    kept_mesh **at = &journal->meshes;
    while (*at != NULL && strcmp((*at)->card.id, id) < 0) {
        at = &(*at)->next;
    }
    return at;
}

static kept_mesh *find(kept_journal *journal, const char *id)
{
    kept_mesh *mesh = *place_of(journal, id);
    return mesh != NULL && strcmp(mesh->card.id, id) == 0 ? mesh : NULL;
}

static void release(kept_record *kept)
{
    if (kept != NULL && --kept->uses == 0) {
        free((void *)(uintptr_t)kept->record.body);
        free_stage(kept->record.stage);
        free(kept);
    }
}

static void remove_mesh(kept_journal *journal, kept_mesh *mesh)
{
    *place_of(journal, mesh->card.id) = mesh->next;
    for (size_t i = 0; i < mesh->count; i++) {
        release(mesh->records[i]);
    }
    release(mesh->base);
    free(mesh->records);
    free(mesh);
}

static kept_record *copy_of(const kept_mesh *mesh, const st_record *record)
{
    kept_record *out = calloc(1, sizeof *out);
    assert_non_null(out);
    out->uses = 1;
    out->record = *record;
    snprintf(out->name, sizeof out->name, "%s", record->name);
    snprintf(out->ops, sizeof out->ops, "%s", record->ops);
    snprintf(out->moment, sizeof out->moment, "%s", record->moment == NULL ? "" : record->moment);
    out->record.id = mesh->card.id;
    out->record.name = out->name;
    out->record.ops = out->ops;
    out->record.moment = record->moment == NULL ? NULL : out->moment;
    out->record.key = NULL;
    out->record.body = NULL;
    if (record->body != NULL) {
        unsigned char *body = malloc(record->body_size);
        assert_non_null(body);
        memcpy(body, record->body, record->body_size);
        out->record.body = body;
    }
    return out;
}

/* Makes a stage from an encoded mesh, which consists of parts. */
static st_stage *stage_of(const unsigned char *body, size_t size)
{
    st_stage *stage = calloc(1, sizeof *stage);
    assert_non_null(stage);
    for (size_t at = 0; at < size;) {
        size_t length = body[at + 1] | (size_t)body[at + 2] << 8 | (size_t)body[at + 3] << 16;
        add_part(stage, body + at + 5, length, body[at]);
        at += 5 + length;
    }
    return stage;
}

/* Stores the first record of a mesh: its base, the record with the whole mesh. */
static void keep_first(kept_journal *journal, const st_record *record)
{
    kept_mesh *mesh = calloc(1, sizeof *mesh);
    assert_non_null(mesh);
    kept_mesh **at = place_of(journal, record->id);
    mesh->next = *at;
    *at = mesh;
    st_card_of_record(record, &mesh->card);
    st_record base = *record;
    base.body = NULL;
    base.body_size = 0;
    mesh->base = copy_of(mesh, &base);
    if (base.stage == NULL) {
        mesh->base->record.stage = stage_of(record->body, record->body_size);
    }
}

static void keep(kept_journal *journal, const st_record *record)
{
    kept_mesh *mesh = find(journal, record->id);
    if (record->number == 1) {
        assert_null(mesh);
        keep_first(journal, record);
        return;
    }
    assert_non_null(mesh);
    assert_true(mesh->card.incarnation == record->incarnation);
    assert_true(mesh->card.record + 1 == record->number);
    if (record->kind == ST_RECORD_REMOVE) {
        remove_mesh(journal, mesh);
        return;
    }
    st_card_of_record(record, &mesh->card);
    mesh->records = grown(mesh->records, mesh->count, &mesh->capacity, sizeof *mesh->records);
    mesh->records[mesh->count++] = copy_of(mesh, record);
}

static uint64_t append(void *self, st_room *room, const st_record *records, size_t count)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    for (size_t i = 0; i < count; i++) {
        if (journal->ignores) {
            free_stage(records[i].stage);
        } else {
            keep(journal, &records[i]);
        }
        journal->out -= records[i].stage != NULL;
    }
    uint64_t position = journal->newest += count;
    journal->out -= room != NULL;
    pthread_mutex_unlock(&journal->lock);
    free(room);
    return position;
}

static void rebase(void *self, st_stage *stage, const st_record *facts, uint64_t needed)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    journal->out--;
    kept_mesh *mesh = find(journal, facts->id);
    assert_true(needed >= facts->revision);
    if (mesh == NULL || mesh->card.incarnation != facts->incarnation) {
        free_stage(stage);
    } else {
        size_t past = 0;
        while (past < mesh->count && mesh->records[past]->record.number <= facts->number) {
            release(mesh->records[past++]);
        }
        memmove(mesh->records, mesh->records + past, (mesh->count - past) * sizeof *mesh->records);
        mesh->count -= past;
        release(mesh->base);
        mesh->base = copy_of(mesh, facts);
        mesh->base->record.stage = stage;
    }
    pthread_mutex_unlock(&journal->lock);
}

/* --- reading records --- */

static st_status open_mesh(void *self, const char *id, st_card *card, st_reader **reader)
{
    kept_journal *journal = self;
    st_status status = ST_ABSENT;
    pthread_mutex_lock(&journal->lock);
    journal->waiting++;
    pthread_cond_broadcast(&journal->changed);
    while (journal->stopped) {
        pthread_cond_wait(&journal->changed, &journal->lock);
    }
    journal->waiting--;
    kept_mesh *mesh = find(journal, id);
    if (mesh != NULL) {
        *card = mesh->card;
        status = mesh->card.damage[0] == '\0' ? ST_OK : ST_DAMAGED;
    }
    if (status == ST_OK && reader != NULL) {
        st_reader *r = calloc(1, sizeof *r);
        assert_non_null(r);
        r->journal = journal;
        snprintf(r->id, sizeof r->id, "%s", id);
        r->records = calloc(mesh->count + 1, sizeof *r->records);
        assert_non_null(r->records);
        r->records[r->count++] = mesh->base;
        for (size_t i = 0; i < mesh->count; i++) {
            r->records[r->count++] = mesh->records[i];
        }
        for (size_t i = 0; i < r->count; i++) {
            r->records[i]->uses++;
        }
        mesh->opened++;
        journal->out++;
        *reader = r;
    }
    pthread_mutex_unlock(&journal->lock);
    return status;
}

static st_status read_piece(st_reader *r, st_piece *out)
{
    kept_journal *journal = r->journal;
    st_status status = ST_OK;
    pthread_mutex_lock(&journal->lock);
    *out = (st_piece){.kind = ST_PIECE_END};
    const kept_record *at = r->record < r->count ? r->records[r->record] : NULL;
    if (at != NULL && at->sum_is_wrong) {
        status = ST_DAMAGED;
        snprintf(r->why, sizeof r->why, "record %llu: its sum is wrong",
                 (unsigned long long)at->record.number);
        out->why = r->why;
    } else if (at != NULL && !r->in_parts) {
        out->kind = r->record == 0 ? ST_PIECE_BASE : ST_PIECE_RECORD;
        out->record = at->record;
        out->parts = at->record.stage == NULL ? 0 : at->record.stage->parts;
        r->in_parts = at->record.stage != NULL;
        r->part = 0;
    } else if (at != NULL) {
        out->kind = ST_PIECE_PART;
        out->bytes = at->record.stage->part[r->part].bytes;
        out->size = at->record.stage->part[r->part].size;
        out->coding = at->record.stage->part[r->part++].coding;
        r->in_parts = r->part < at->record.stage->parts;
        kept_mesh *mesh = find(journal, r->id);
        if (mesh != NULL) {
            mesh->parts++;
        }
    }
    r->record += at != NULL && !r->in_parts;
    pthread_mutex_unlock(&journal->lock);
    return status;
}

static void shut(st_reader *r)
{
    if (r != NULL) {
        kept_journal *journal = r->journal;
        pthread_mutex_lock(&journal->lock);
        for (size_t i = 0; i < r->count; i++) {
            release(r->records[i]);
        }
        journal->out--;
        pthread_mutex_unlock(&journal->lock);
        free(r->records);
        free(r);
    }
}

static void condemn(st_reader *r, const char *damage)
{
    kept_journal *journal = r->journal;
    pthread_mutex_lock(&journal->lock);
    kept_mesh *mesh = find(journal, r->id);
    if (mesh != NULL && mesh->base == r->records[0]) {
        snprintf(mesh->card.damage, sizeof mesh->card.damage, "%s", damage);
    }
    pthread_mutex_unlock(&journal->lock);
}

static st_status list_cards(void *self, const char *after, st_card *out, size_t limit,
                            size_t *count)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    *count = 0;
    for (kept_mesh *mesh = *place_of(journal, after); mesh != NULL && *count < limit;
         mesh = mesh->next) {
        if (strcmp(mesh->card.id, after) > 0) {
            out[(*count)++] = mesh->card;
        }
    }
    pthread_mutex_unlock(&journal->lock);
    return ST_OK;
}

static bool is_in_page(const st_card_page *page, const st_card *card)
{
    return page->after == NULL || st_card_compare(page->order, page->after, card) < 0;
}

static st_status list_cards_by(void *self, const st_card_page *page, st_card *out, size_t *count)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    *count = 0;
    for (const kept_mesh *mesh = journal->meshes; mesh != NULL; mesh = mesh->next) {
        if (!is_in_page(page, &mesh->card)) {
            continue;
        }
        size_t at = *count < page->limit ? (*count)++ : page->limit;
        while (at > 0 && st_card_compare(page->order, &mesh->card, &out[at - 1]) < 0) {
            if (at < page->limit) {
                out[at] = out[at - 1];
            }
            at--;
        }
        if (at < page->limit) {
            out[at] = mesh->card;
        }
    }
    pthread_mutex_unlock(&journal->lock);
    return ST_OK;
}

static uint64_t count_meshes(void *self)
{
    kept_journal *journal = self;
    uint64_t count = 0;
    pthread_mutex_lock(&journal->lock);
    for (const kept_mesh *mesh = journal->meshes; mesh != NULL; mesh = mesh->next) {
        count++;
    }
    pthread_mutex_unlock(&journal->lock);
    return count;
}

/* --- functions for tests --- */

size_t kept_journal_staged_edits(kept_journal *journal)
{
    pthread_mutex_lock(&journal->lock);
    const size_t staged = journal->staged_edits;
    pthread_mutex_unlock(&journal->lock);
    return staged;
}

kept_journal *kept_journal_new(void)
{
    kept_journal *journal = calloc(1, sizeof *journal);
    assert_non_null(journal);
    pthread_mutex_init(&journal->lock, NULL);
    pthread_cond_init(&journal->changed, NULL);
    journal->secret[0] = 3;
    journal->secret[1] = 7;
    return journal;
}

void kept_journal_free(kept_journal *journal)
{
    assert_int_equal(journal->out, 0);
    while (journal->meshes != NULL) {
        remove_mesh(journal, journal->meshes);
    }
    pthread_cond_destroy(&journal->changed);
    pthread_mutex_destroy(&journal->lock);
    free(journal);
}

static void tell_health(void *self, st_health *out)
{
    kept_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    const st_status refuse = journal->refuse;
    pthread_mutex_unlock(&journal->lock);
    *out = (st_health){.status = refuse == ST_FULL || refuse == ST_FAILED ? refuse : ST_OK};
}

st_journal kept_journal_open(kept_journal *journal)
{
    /* functions that are not set below are those of the journal in memory, for which every change
     * is durable at once */
    st_journal out = st_journal_memory();
    out.self = journal;
    out.keeps = true;
    memcpy(out.secret, journal->secret, sizeof out.secret);
    out.reserve = reserve;
    out.leave = leave;
    out.append = append;
    out.stage = stage_content;
    out.stage_edit = stage_edit;
    out.unstage = unstage;
    out.rebase = rebase;
    out.open = open_mesh;
    out.read = read_piece;
    out.shut = shut;
    out.condemn = condemn;
    out.list = list_cards;
    out.list_by = list_cards_by;
    out.keys = journal_keys_none;
    out.count = count_meshes;
    out.health = tell_health;
    return out;
}

void kept_journal_refuse(kept_journal *journal, st_status status)
{
    pthread_mutex_lock(&journal->lock);
    journal->refuse = status;
    pthread_mutex_unlock(&journal->lock);
}

void kept_journal_ignore(kept_journal *journal)
{
    pthread_mutex_lock(&journal->lock);
    journal->ignores = true;
    pthread_mutex_unlock(&journal->lock);
}

static void set_stopped(kept_journal *journal, bool stopped)
{
    pthread_mutex_lock(&journal->lock);
    journal->stopped = stopped;
    pthread_cond_broadcast(&journal->changed);
    pthread_mutex_unlock(&journal->lock);
}

void kept_journal_stop(kept_journal *journal)
{
    set_stopped(journal, true);
}

void kept_journal_go(kept_journal *journal)
{
    set_stopped(journal, false);
}

void kept_journal_await(kept_journal *journal, size_t openers)
{
    pthread_mutex_lock(&journal->lock);
    while (journal->waiting < openers) {
        pthread_cond_wait(&journal->changed, &journal->lock);
    }
    pthread_mutex_unlock(&journal->lock);
}

kept_facts kept_journal_facts(kept_journal *journal, const char *id)
{
    pthread_mutex_lock(&journal->lock);
    const kept_mesh *mesh = find(journal, id);
    assert_non_null(mesh);
    const kept_facts facts = {.records = mesh->count,
                              .base = mesh->base->record.revision,
                              .opened = mesh->opened,
                              .parts = mesh->parts,
                              .condemned = mesh->card.damage[0] != '\0'};
    pthread_mutex_unlock(&journal->lock);
    return facts;
}

size_t kept_journal_out(kept_journal *journal)
{
    pthread_mutex_lock(&journal->lock);
    size_t out = journal->out;
    pthread_mutex_unlock(&journal->lock);
    return out;
}

void kept_journal_damage(kept_journal *journal, const char *id, size_t n, kept_damage how,
                         size_t at)
{
    pthread_mutex_lock(&journal->lock);
    kept_mesh *mesh = find(journal, id);
    assert_non_null(mesh);
    assert_true(n < mesh->count);
    kept_record *kept = mesh->records[n];
    if (how == KEPT_SUM) {
        kept->sum_is_wrong = true;
    } else {
        unsigned char *body = (unsigned char *)(uintptr_t)kept->record.body;
        assert_true(at < kept->record.body_size);
        if (how == KEPT_CUT) {
            kept->record.body_size = at;
        } else {
            body[at] ^= how == KEPT_NEWER ? 2 : 1;
        }
    }
    pthread_mutex_unlock(&journal->lock);
}
