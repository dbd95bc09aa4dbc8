#include "store/mesh_load.h"

#include "mesh/check.h"
#include "mesh/write.h"
#include "store/revision_name.h"
#include "store/table.h"
#include "stored/stored.h"
#include "system/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The data of the load of a mesh from the journal. */
typedef struct load {
    const st_mesh_options *options;
    uint64_t until; /* the revision at which the load stops; 0: the last revision */
    /* The mesh that is being loaded. Its `content` is NULL and its log of revisions is empty until
     * the base is read, the mesh data with which the load begins. */
    st_mesh *mesh;
    /* bytes that the mesh data takes in memory, according to the card (short description) of the
     * mesh */
    uint64_t bytes;
    uint64_t record;   /* number of the last record that was applied to the mesh; 0: none */
    uint64_t metadata; /* how often the name was changed, according to the last applied record */
    /* The oldest revision in the history, according to the last applied record. */
    uint64_t reach;
    /* The record whose parts are being read. Its texts are copies. */
    st_record pending;
    bool is_base; /* true if `pending` is the base, with which the load begins */
    char ops[ST_ENTRY_OPS];
    he_stored_reader *content; /* reads the parts, if they are mesh data */
    unsigned char *edit;       /* the bytes of the parts, if they are an encoded edit */
    /* Number of parts of `pending` that are not read yet; 0: no record is being read in parts. */
    uint64_t missing;
    char *damage;
} load;

static st_status damaged(load *l, const char *format, ...) __attribute__((format(printf, 2, 3)));
static st_status damaged(load *l, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(l->damage, ST_DAMAGE, format, arguments);
    va_end(arguments);
    return ST_DAMAGED;
}

static st_status no_memory(void)
{
    return st_memory_is_full() ? ST_BUDGET : ST_NO_MEMORY;
}

/* Returns a status for an error that occurred while record `number` was read, and stores a sentence
 * about it in l->damage. */
static st_status status_of(load *l, he_status status, uint64_t number, const he_error *err)
{
    if (status == HE_OK) {
        return ST_OK;
    }
    if (status == HE_NO_MEMORY) {
        return no_memory();
    }
    if (err->place == HE_PLACE_BYTE) {
        (void)damaged(l, "record %llu, at its byte %llu: %s", (unsigned long long)number,
                      (unsigned long long)err->at, err->text);
    } else {
        (void)damaged(l, "record %llu: %s", (unsigned long long)number, err->text);
    }
    return status == HE_UNSUPPORTED ? ST_NEWER : ST_DAMAGED;
}

static bool has_marks(const he_mesh *content, const uint32_t issued[HE_KIND_COUNT])
{
    return he_mesh_issued(content, HE_VERTEX) == issued[HE_VERTEX] &&
           he_mesh_issued(content, HE_EDGE) == issued[HE_EDGE] &&
           he_mesh_issued(content, HE_FACE) == issued[HE_FACE];
}

static st_status wrong_marks(load *l, const st_record *record)
{
    return damaged(l, "the edit in record %llu issues other ids than the record says",
                   (unsigned long long)record->number);
}

/* --- contents --- */

/* Puts the mesh data of the base into the mesh and begins the mesh's history with it. */
static st_status begin_history(load *l, const st_record *record, he_mesh *takes)
{
    st_mesh *mesh = l->mesh;
    const st_point begin = {.revision = record->revision,
                            .state = record->inverts != 0 ? record->inverts : record->revision,
                            .time = record->time};
    mesh->content = takes;
    st_log_init(&mesh->log, UINT64_MAX, &begin, takes);
    return ST_OK;
}

/* Applies a record that replaces all data of the mesh (PUT). */
static st_status replace(load *l, const st_record *record, he_mesh *takes)
{
    st_mesh *mesh = l->mesh;
    if (st_log_reserve(&mesh->log) == NULL) {
        he_mesh_free(takes);
        return no_memory();
    }
    he_mesh_free(mesh->content);
    mesh->content = takes;
    st_log_add_barrier(&mesh->log,
                       &(st_logged){.revision = record->revision,
                                    .action = ST_REPLACE,
                                    .ops = "replace",
                                    .time = record->time},
                       takes);
    return ST_OK;
}

/* Adds the delta (changes) that was read from a record to the history, as the entry of this
 * record. */
static st_status add_edit(load *l, const st_record *record)
{
    st_mesh *mesh = l->mesh;
    const st_logged logged = {.revision = record->revision,
                              .action = ST_EDIT,
                              .ops = record->ops,
                              .time = record->time,
                              .tally = &record->tally};
    if (record->barrier) {
        st_log_add_barrier(&mesh->log, &logged, mesh->content);
    } else {
        st_log_add_edit(&mesh->log, &logged, mesh->content);
    }
    return ST_OK;
}

/* Applies an edit whose record has, in place of a delta, all mesh data after the edit. */
static st_status edit_whole(load *l, const st_record *record, he_mesh *takes)
{
    st_mesh *mesh = l->mesh;
    he_delta *delta = st_log_reserve(&mesh->log);
    he_error err = {0};
    if (delta == NULL) {
        he_mesh_free(takes);
        return no_memory();
    }
    he_mesh_record(mesh->content, delta);
    he_status status =
        he_mesh_replace(mesh->content, takes, record->barrier ? HE_RENUMBERS : HE_KEEPS_IDS, &err);
    he_mesh_record(mesh->content, NULL);
    if (status != HE_OK) {
        he_mesh_free(takes);
        return status_of(l, status, record->number, &err);
    }
    return add_edit(l, record);
}

/* Puts mesh data that was read completely into the mesh. The data belongs to the base or to a later
 * record. */
static st_status take_content(load *l, const st_record *record, bool is_base, he_mesh *takes)
{
    if (!has_marks(takes, record->issued)) {
        he_mesh_free(takes);
        return wrong_marks(l, record);
    }
    if (is_base) {
        return begin_history(l, record, takes);
    }
    if (record->barrier) {
        /* records of earlier revisions may have been deleted from the disk */
        l->mesh->base = record->revision;
    }
    return record->kind == ST_RECORD_CONTENT ? replace(l, record, takes)
                                             : edit_whole(l, record, takes);
}

static void free_parts(load *l)
{
    he_stored_reader_free(l->content);
    he_mem_free(l->edit);
    l->content = NULL;
    l->edit = NULL;
    l->missing = 0;
}

/* Allocates memory for an encoded edit that is stored in parts. The size of the edit is not known
 * before its last part is read, so memory for the largest possible parts is allocated. */
static st_status begin_edit(load *l, const st_piece *piece)
{
    if (piece->parts > ST_MOST_BODY / HE_STORED_PART + 1) {
        return damaged(l, "record %llu has more parts than an edit may have",
                       (unsigned long long)l->pending.number);
    }
    l->edit = he_mem_array(NULL, (size_t)piece->parts, HE_STORED_PART);
    l->pending.body_size = 0;
    return l->edit != NULL ? ST_OK : no_memory();
}

static st_status begin_parts(load *l, const st_piece *piece)
{
    he_error err = {0};
    l->pending = piece->record;
    l->is_base = piece->kind == ST_PIECE_BASE;
    l->missing = piece->parts;
    snprintf(l->ops, sizeof l->ops, "%s", piece->record.ops == NULL ? "" : piece->record.ops);
    l->pending.ops = l->ops;
    if (piece->parts == 0) {
        return damaged(l, "record %llu has no parts", (unsigned long long)l->pending.number);
    }
    if (l->pending.staged_edit) {
        return begin_edit(l, piece);
    }
    uint64_t most =
        piece->parts > UINT64_MAX / HE_STORED_PART ? UINT64_MAX : piece->parts * HE_STORED_PART;
    return status_of(l, he_stored_reader_new(most, &l->content, &err), l->pending.number, &err);
}

static st_status take_content_part(load *l, const st_piece *piece)
{
    const st_record *record = &l->pending;
    he_mesh *content = NULL;
    he_error err = {0};
    he_status status =
        he_stored_reader_part(l->content, piece->coding, piece->bytes, piece->size, &err);
    if (status == HE_OK && --l->missing > 0) {
        return ST_OK;
    }
    if (status == HE_OK) {
        status = he_stored_reader_end(l->content, &content, &err);
    }
    free_parts(l);
    return status != HE_OK ? status_of(l, status, record->number, &err)
                           : take_content(l, record, l->is_base, content);
}

/* --- records --- */

static st_status take_edit(load *l, const st_record *record)
{
    st_mesh *mesh = l->mesh;
    he_delta *delta = NULL;
    he_error err = {0};
    if (st_log_reserve(&mesh->log) == NULL) {
        return no_memory();
    }
    he_status status = he_stored_edit_forward(record->body, record->body_size, record->issued,
                                              mesh->content, &delta, &err);
    if (status != HE_OK) {
        return status_of(l, status, record->number, &err);
    }
    st_log_lend(&mesh->log, delta);
    return has_marks(mesh->content, record->issued) ? add_edit(l, record) : wrong_marks(l, record);
}

static st_status take_edit_part(load *l, const st_piece *piece)
{
    st_record *record = &l->pending;
    if (piece->coding != HE_CODING_PLAIN || piece->size > HE_STORED_PART) {
        return damaged(
            l, "a part of the edit of record %llu has a coding that a part of an edit cannot have",
            (unsigned long long)record->number);
    }
    memcpy(l->edit + record->body_size, piece->bytes, piece->size);
    record->body_size += piece->size;
    if (--l->missing > 0) {
        return ST_OK;
    }
    record->body = l->edit;
    l->mesh->appended += record->body_size;
    const st_status status = take_edit(l, record);
    free_parts(l);
    return status;
}

static st_status take_part(load *l, const st_piece *piece)
{
    if (l->missing == 0) {
        return damaged(l, "the store has a part of content that belongs to no record");
    }
    return l->edit != NULL ? take_edit_part(l, piece) : take_content_part(l, piece);
}

static st_status take_whole(load *l, const st_record *record)
{
    he_mesh *content = NULL;
    he_error err = {0};
    he_status status = he_stored_content_read(record->body, record->body_size, &content, &err);
    return status != HE_OK ? status_of(l, status, record->number, &err)
                           : take_content(l, record, false, content);
}

static st_status take_step(load *l, const st_record *record)
{
    st_mesh *mesh = l->mesh;
    st_revision_log *log = &mesh->log;
    st_action which = record->kind == ST_RECORD_UNDO ? ST_UNDO : ST_REDO;
    he_delta *delta = NULL;
    he_error err = {0};
    if (st_log_top(log, which) != record->inverts || record->inverts == 0) {
        return damaged(
            l,
            "record %llu undoes or redoes revision %llu, which is not the next one to undo or redo",
            (unsigned long long)record->number, (unsigned long long)record->inverts);
    }
    if (!st_log_reserve_steps(log, which, 1, mesh->content)) {
        return no_memory();
    }
    st_log_deltas(log, which, 1, &delta);
    if (which == ST_UNDO) {
        he_delta_undo(delta, mesh->content);
    } else {
        he_delta_redo(delta, mesh->content);
    }
    /* If an edit replaced all mesh data, only this number in its record tells how many ids it has
     * issued. */
    he_status status = he_mesh_issue(mesh->content, record->issued, &err);
    if (status == HE_OK && !has_marks(mesh->content, record->issued)) {
        return wrong_marks(l, record);
    }
    if (status == HE_OK) {
        st_log_add_step(log, record->revision, which, record->time, mesh->content);
    }
    return status_of(l, status, record->number, &err);
}

/* Names a revision. A revision that the log has no entry of was not after the base, and the base
 * replaced its entry; then the name is gone, too. */
static st_status take_moment(load *l, const st_record *record)
{
    st_revision_log *log = &l->mesh->log;
    const st_status status = st_log_can_name(log, record->named, 0);
    if (status == ST_AHEAD || record->named == 0) {
        return damaged(l, "record %llu names revision %llu, which the mesh does not have",
                       (unsigned long long)record->number, (unsigned long long)record->named);
    }
    if (status == ST_GONE) {
        return ST_OK;
    }
    char *name = st_log_name_new(record->moment);
    if (name == NULL) {
        return no_memory();
    }
    st_log_name(log, record->named, name);
    return ST_OK;
}

/* Checks that a record is the next record of this mesh. */
static st_status check_record(load *l, const st_record *record)
{
    const st_mesh *mesh = l->mesh;
    if (mesh->content == NULL) {
        return damaged(l, "the first record of the mesh has no mesh data");
    }
    bool revises = record->kind <= ST_RECORD_CONTENT;
    uint64_t number = l->record + 1;
    uint64_t revision = st_log_head(&mesh->log) + (revises ? 1 : 0);
    if (record->incarnation != mesh->info.incarnation || record->number != number ||
        record->revision != revision) {
        return damaged(l, "record %llu is missing", (unsigned long long)number);
    }
    return ST_OK;
}

static st_status take_record(load *l, const st_piece *piece)
{
    const st_record *record = &piece->record;
    st_status status = check_record(l, record);
    if (status != ST_OK) {
        return status;
    }
    l->record = record->number;
    l->metadata = record->metadata;
    l->reach = record->reach;
    l->mesh->appended += st_rebase_bytes(record);
    switch (record->kind) {
    case ST_RECORD_EDIT:
        return record->stage != NULL ? begin_parts(l, piece) : take_edit(l, record);
    case ST_RECORD_UNDO:
    case ST_RECORD_REDO:
        return take_step(l, record);
    case ST_RECORD_CONTENT:
        return record->stage != NULL ? begin_parts(l, piece) : take_whole(l, record);
    case ST_RECORD_RENAME:
        /* nothing is to be done, because the name of the mesh is taken from its card */
        return ST_OK;
    case ST_RECORD_MOMENT:
        return take_moment(l, record);
    case ST_RECORD_REMOVE:
        break;
    }
    return damaged(l, "record %llu is of a kind that an existing mesh cannot have",
                   (unsigned long long)record->number);
}

static st_status take_base(load *l, const st_piece *piece)
{
    const st_record *record = &piece->record;
    if (l->mesh->content != NULL || record->incarnation != l->mesh->info.incarnation ||
        record->revision == 0) {
        return damaged(l, "the record from which the mesh is loaded belongs to another mesh");
    }
    if (l->until != 0 && record->revision > l->until) {
        return ST_GONE;
    }
    /* More memory is freed than the mesh data takes, because the arrays of a mesh have spare
     * capacity, and because an earlier revision is copied after the load. */
    st_make_room(l->options->store, l->until == 0 ? l->bytes + l->bytes / 2 : 2 * l->bytes);
    l->record = record->number;
    l->metadata = record->metadata;
    l->reach = record->reach;
    l->mesh->base = record->revision;
    return begin_parts(l, piece);
}

static st_status take(load *l, const st_piece *piece)
{
    if (l->missing > 0 && piece->kind != ST_PIECE_PART) {
        return damaged(l, "parts of record %llu are missing",
                       (unsigned long long)l->pending.number);
    }
    switch (piece->kind) {
    case ST_PIECE_BASE:
        return take_base(l, piece);
    case ST_PIECE_PART:
        return take_part(l, piece);
    case ST_PIECE_RECORD:
        return take_record(l, piece);
    case ST_PIECE_END:
        break;
    }
    return l->mesh->content != NULL ? ST_OK
                                    : damaged(l, "the records of the mesh have no mesh data");
}

/* --- the end --- */

static st_status check_card(load *l, const st_card *card)
{
    const he_mesh *content = l->mesh->content;
    const st_counts *counts = &card->counts;
    if (l->record != card->record || st_log_head(&l->mesh->log) != card->revision ||
        l->metadata != card->metadata) {
        return damaged(l, "the last record is number %llu, but the mesh should have %llu",
                       (unsigned long long)l->record, (unsigned long long)card->record);
    }
    if (he_mesh_vertices(content) != counts->vertices || he_mesh_edges(content) != counts->edges ||
        he_mesh_faces(content) != counts->faces ||
        he_mesh_boundary_halfedges(content) != counts->boundary) {
        return damaged(
            l,
            "the records lead to other numbers of elements than the mesh had when it was stored");
    }
    return ST_OK;
}

static st_status check_content(load *l)
{
    he_problem problem;
    size_t total = 0;
    he_error err = {0};
    he_status status = he_check(l->mesh->content, &problem, 1, &total, &err);
    if (status != HE_OK) {
        return no_memory();
    }
    return total == 0 ? ST_OK : damaged(l, "I%d: %.140s", problem.rule, problem.text);
}

/* Ends the loading of the history. It is now as it was before the mesh left memory, unless the undo
 * budget is much smaller now. */
static void end_history(load *l)
{
    st_log_drop(&l->mesh->log, l->reach);
    st_log_limit(&l->mesh->log, l->options->undo_budget);
}

/* Returns true if `piece`, the next thing read from the disk, belongs to a later revision than that
 * at which the load stops. */
static bool is_beyond(const load *l, const st_piece *piece)
{
    return piece->kind == ST_PIECE_END ||
           (l->until != 0 && l->missing == 0 && l->mesh->content != NULL &&
            piece->kind == ST_PIECE_RECORD && piece->record.revision > l->until);
}

static st_status read_pieces(load *l, st_reader *reader)
{
    const st_journal *journal = l->options->journal;
    st_piece piece;
    st_status status = ST_OK;
    bool ends = false;
    while (status == ST_OK && !ends) {
        status = journal->read(reader, &piece);
        if (status == ST_DAMAGED || status == ST_NEWER) {
            (void)damaged(l, "%s", piece.why);
        }
        ends = status == ST_OK && is_beyond(l, &piece);
        if (status == ST_OK && (!ends || piece.kind == ST_PIECE_END)) {
            status = take(l, &piece);
        }
    }
    return status;
}

static load begin_load(const st_mesh_options *options, const st_card *card, uint64_t until,
                       char damage[ST_DAMAGE])
{
    damage[0] = '\0';
    return (load){.options = options,
                  .until = until,
                  .bytes = card->bytes,
                  .damage = damage,
                  .mesh = st_mesh_bare(options, card)};
}

st_status st_mesh_salvage(const st_mesh_options *options, const st_card *card, st_reader *reader,
                          st_mesh **out, char damage[ST_DAMAGE])
{
    char why[ST_DAMAGE];
    load l = begin_load(options, card, 0, why);
    if (l.mesh == NULL) {
        return no_memory();
    }
    st_status status = read_pieces(&l, reader);
    if (status == ST_OK) {
        status = check_card(&l, card);
    }
    memcpy(damage, why, ST_DAMAGE);
    if (status == ST_DAMAGED && l.mesh->content != NULL) {
        status = ST_OK;
    }
    if (status == ST_OK && check_content(&l) == ST_DAMAGED) {
        memcpy(damage, why, ST_DAMAGE);
        status = ST_DAMAGED;
    }
    free_parts(&l);
    if (status != ST_OK) {
        st_release(l.mesh);
        return status;
    }
    l.mesh->info.revision = st_log_head(&l.mesh->log);
    *out = l.mesh;
    return ST_OK;
}

st_status st_mesh_load(const st_mesh_options *options, st_card *card, st_reader *reader,
                       uint64_t until, st_mesh **out)
{
    load l = begin_load(options, card, until, card->damage);
    if (l.mesh == NULL) {
        return no_memory();
    }
    st_status status = read_pieces(&l, reader);
    if (status == ST_OK && until == 0) {
        status = check_card(&l, card);
    } else if (status == ST_OK && st_log_head(&l.mesh->log) != until) {
        status = ST_GONE;
    }
    if (status == ST_OK) {
        status = check_content(&l);
    }
    free_parts(&l);
    if (status != ST_OK) {
        if (status == ST_DAMAGED) {
            options->journal->condemn(reader, card->damage);
        }
        st_release(l.mesh);
        return status;
    }
    if (until == 0) {
        end_history(&l);
    }
    *out = l.mesh;
    return ST_OK;
}

st_status st_mesh_load_apart(st_mesh *mesh, uint64_t until, st_mesh **out)
{
    const st_journal *journal = mesh->journal;
    const st_mesh_options options = st_store_mesh_options(mesh->store);
    st_reader *reader = NULL;
    st_card card;
    *out = NULL;
    st_status status =
        journal->keeps ? journal->open(journal->self, mesh->info.id, &card, &reader) : ST_GONE;
    if (status == ST_OK) {
        until = until == 0 ? card.revision : until;
        status = card.incarnation == mesh->info.incarnation
                     ? st_mesh_load(&options, &card, reader, until, out)
                     : ST_GONE;
        journal->shut(reader);
    }
    bool none = status == ST_ABSENT || status == ST_DAMAGED || status == ST_NEWER;
    return none ? ST_GONE : status;
}
