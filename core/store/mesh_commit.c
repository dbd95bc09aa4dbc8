/* mesh_commit.c - the kinds of commit: an edit of the mesh, or of the copy on which a long edit
 * works; undo and redo; replacement of the mesh data; rename; name of a revision; removal. Each
 * change is put into the history, then appended to the journal and sent to listeners. */
#include "store/mesh_commit.h"

#include "store/revision_name.h"
#include "system/clock.h"
#include "system/lock.h"

#include <assert.h>
#include <string.h>

void st_mesh_unclaim(st_mesh *mesh)
{
    mesh->claimed = false;
    mesh->info.job[0] = '\0';
}

static double revise(st_mesh *mesh)
{
    mesh->info.revision++;
    mesh->info.modified = st_clock_utc();
    return mesh->info.modified;
}

/* Counts the elements that a change has created, deleted and modified. If the change replaced all
 * data of the mesh, or nobody reads its changes, the numbers are unknown. */
static st_tally tally_of(const st_write *w)
{
    const he_changes *changes = &w->changes;
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    st_tally tally = {.known = w->found && !changes->replaced};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        tally.created[i] = (uint32_t)changes->created[kinds[i]].count;
        tally.deleted[i] = (uint32_t)changes->deleted[kinds[i]].count;
        tally.modified[i] = (uint32_t)changes->modified[kinds[i]].count;
    }
    return tally;
}

/* Commits an edit. A reference to the edit's delta (recorded changes) keeps it in memory until the
 * edit is published, even if the history drops it. */
static void commit_edit(st_write *w, const char *ops)
{
    st_mesh *mesh = w->mesh;
    const st_tally tally = tally_of(w);
    const bool barrier = w->changes.renumbered;
    st_step *step = barrier ? NULL : st_log_hold_reserved(&mesh->log);
    double now = revise(mesh);
    const st_logged logged = {.revision = mesh->info.revision,
                              .action = ST_EDIT,
                              .ops = ops,
                              .time = now,
                              .tally = barrier ? NULL : &tally};
    if (barrier) {
        st_log_add_barrier(&mesh->log, &logged, mesh->content);
    } else {
        st_log_add_edit(&mesh->log, &logged, mesh->content);
    }
    st_record record = st_mesh_record(mesh, ST_RECORD_EDIT, &w->cause);
    st_change change = {.action = ST_REPLACE, .content = mesh->content};
    if (!barrier) {
        change.action = ST_EDIT;
        change.delta = st_step_delta(step);
        change.changes = w->found ? &w->changes : NULL;
    }
    st_mesh_publish(
        mesh,
        &(st_group){.booking = &w->booking, .records = &record, .changes = &change, .count = 1});
    st_step_release(step);
}

static void commit_steps(st_write *w)
{
    st_mesh *mesh = w->mesh;
    const st_record_kind kind = w->which == ST_UNDO ? ST_RECORD_UNDO : ST_RECORD_REDO;
    for (uint32_t i = 0; i < w->steps; i++) {
        double now = revise(mesh);
        st_log_add_step(&mesh->log, mesh->info.revision, w->which, now, mesh->content);
        w->records[i] = st_mesh_record(mesh, kind, &w->cause);
    }
    st_log_settle(&mesh->log);
    for (uint32_t i = 0; i < w->steps; i++) {
        w->records[i].reach = mesh->log.before.revision;
    }
    const st_group group = {
        .booking = &w->booking, .records = w->records, .count = w->steps, .events = w->events};
    st_mesh_publish(mesh, &group);
}

static void rename_mesh(st_mesh *mesh, const char *name)
{
    size_t length = strnlen(name, ST_MESH_NAME);
    memcpy(mesh->info.name, name, length);
    mesh->info.name[length] = '\0';
    mesh->info.metadata++;
    mesh->info.modified = st_clock_utc();
}

/* Commits a replacement of the mesh data, a rename, a replacement with a rename, or a removal. A
 * replacement with a rename makes two records, which are appended as one group. */
static void commit_facts(st_write *w)
{
    st_mesh *mesh = w->mesh;
    st_record records[2];
    st_change changes[2];
    size_t count = 0;
    if (w->kind == ST_WRITE_REPLACE) {
        double now = revise(mesh);
        st_log_add_barrier(&mesh->log,
                           &(st_logged){.revision = mesh->info.revision,
                                        .action = ST_REPLACE,
                                        .ops = "replace",
                                        .time = now},
                           mesh->content);
        changes[count] = (st_change){.action = ST_REPLACE, .content = mesh->content};
        records[count++] = st_mesh_record(mesh, ST_RECORD_CONTENT, &w->cause);
    }
    if (w->name != NULL) {
        rename_mesh(mesh, w->name);
        changes[count] = (st_change){.action = ST_EDIT, .content = mesh->content};
        records[count++] = st_mesh_record(mesh, ST_RECORD_RENAME, &w->cause);
    }
    if (w->kind == ST_WRITE_REMOVE) {
        mesh->info.removed = true;
        changes[count] = (st_change){.action = ST_REPLACE, .removed = true};
        records[count++] = st_mesh_record(mesh, ST_RECORD_REMOVE, &w->cause);
    }
    st_mesh_publish(
        mesh, &(st_group){
                  .booking = &w->booking, .records = records, .changes = changes, .count = count});
}

/* Commits the name of a revision. The oldest entries of the history may be dropped to make room for
 * it, but not the entry that gets the name (st_log_can_name). */
static void commit_moment(st_write *w)
{
    st_mesh *mesh = w->mesh;
    st_log_name(&mesh->log, w->named, w->moment);
    w->moment = NULL;
    st_log_settle(&mesh->log);
    mesh->info.metadata++;
    mesh->info.modified = st_clock_utc();
    st_record record = st_mesh_record(mesh, ST_RECORD_MOMENT, &w->cause);
    record.named = w->named;
    record.moment = st_log_name_of(&mesh->log, w->named);
    const st_change change = {.action = ST_EDIT,
                              .content = mesh->content,
                              .named = record.named,
                              .moment = record.moment};
    st_mesh_publish(
        mesh,
        &(st_group){.booking = &w->booking, .records = &record, .changes = &change, .count = 1});
}

/* Puts the new mesh data into the mesh. Returns the old data, which the caller frees, or NULL if
 * nothing was exchanged. */
static he_mesh *exchange_content(st_write *w)
{
    st_mesh *mesh = w->mesh;
    if (w->kind == ST_WRITE_EDIT) {
        he_mesh_record(w->content, NULL);
    }
    if (w->claimed) {
        st_mesh_unclaim(mesh);
    }
    he_mesh *before = mesh->content;
    if (before == w->content) {
        /* The data also stays in the mesh when the mesh is removed, because a long edit may still
         * be reading it. */
        return NULL;
    }
    mesh->content = w->content;
    return before;
}

/* Reserves space in the journal for the records of the write. During a claim (a long edit that
 * works on a copy of the mesh) the caller does not hold the mesh's lock; it needs none, because
 * only this thread uses the copy. */
static st_status book(st_write *w)
{
    const st_journal *journal = w->mesh->journal;
    st_room_need need = {.records = 1};
    switch (w->kind) {
    case ST_WRITE_EDIT:
        return st_book_edit(journal, w->delta, w->content, w->claimed, &w->booking);
    case ST_WRITE_REPLACE: {
        st_stage *stage = w->booking.stage;
        size_t records = w->name == NULL ? 1 : 2;
        return st_book_content(journal, w->content, stage, records, &w->booking);
    }
    case ST_WRITE_STEP:
        need.records = w->steps;
        break;
    case ST_WRITE_REMOVE:
        need.freeing = true;
        break;
    case ST_WRITE_RENAME:
    case ST_WRITE_MOMENT:
        break;
    }
    return st_book(journal, &need, &w->booking);
}

/* Returns true if the change was made from records that are lost. Space in the journal must have
 * been reserved before, because then a loss after this check includes the record of this change,
 * too. */
static bool is_from_lost(const st_write *w)
{
    st_waits *waits = w->mesh->followers->waits;
    bool lost = false;
    for (size_t i = 0; i < w->from_count && !lost; i++) {
        lost = st_waits_is_lost(waits, &w->from[i]);
    }
    return lost;
}

/* Refuses the commit if the journal has no space, if the mesh was removed or lost during a long
 * edit, or if the mesh would have more bytes than its holder (owner) may have. */
static st_status get_ready(st_write *w)
{
    const st_status unreadable = w->kind == ST_WRITE_REMOVE ? ST_OK : w->info.unreadable;
    st_status status = unreadable == ST_OK ? book(w) : unreadable;
    if (status == ST_OK && is_from_lost(w)) {
        status = ST_LOST;
    }
    if (w->claimed) {
        st_lock_write(&w->mesh->lock);
        const st_mesh_info *info = &w->mesh->info;
        if (status == ST_OK && (info->removed || info->lost)) {
            status = info->lost ? ST_LOST : ST_ABSENT;
        }
    }
    const bool grows = w->kind <= ST_WRITE_REPLACE;
    if (status == ST_OK && grows) {
        status = st_mesh_grow(w->mesh, he_mesh_bytes(w->content));
    }
    if (status != ST_OK) {
        st_write_give_up(w);
    }
    return status;
}

st_status st_write_commit(st_write *w, const char *ops)
{
    st_mesh *mesh = w->mesh;
    assert(w->found || w->unread || w->kind >= ST_WRITE_REPLACE);
    st_status status = get_ready(w);
    if (status != ST_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_mesh *discard = exchange_content(w);
    bool cut_off = w->kind == ST_WRITE_REPLACE || w->changes.renumbered;
    bool removed = w->kind == ST_WRITE_REMOVE;
    switch (w->kind) {
    case ST_WRITE_EDIT:
        commit_edit(w, ops);
        break;
    case ST_WRITE_STEP:
        commit_steps(w);
        break;
    case ST_WRITE_MOMENT:
        commit_moment(w);
        break;
    case ST_WRITE_REPLACE:
    case ST_WRITE_RENAME:
    case ST_WRITE_REMOVE:
        commit_facts(w);
        break;
    }
    st_mesh_facts(mesh, &w->info);
    if (removed) {
        /* The last record of the mesh is in the journal now. Only then may the mesh leave the
         * table, after which another mesh can get its id. */
        st_store_take_out(mesh->store, mesh);
    }
    st_write_end(w, discard);
    /* Cached copies of the mesh are freed, because they cannot be updated to the replaced data. */
    if (cut_off) {
        st_mesh_shed(mesh);
    }
    return ST_OK;
}
