#include "store/publish/booking.h"

#include "base/mem.h"
#include "store/publish/limits.h"
#include "stored/stored.h"

st_status st_book(const st_journal *journal, const st_room_need *need, st_booking *out)
{
    st_room *room = NULL;
    st_status status = journal->reserve(journal->self, need, &room);
    if (status == ST_OK) {
        *out = (st_booking){.room = room};
    }
    return status;
}

static bool replaces(const he_delta *delta)
{
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        if (delta->records[i].column == HE_COL_REPLACED) {
            return true;
        }
    }
    return false;
}

/* Encodes an edit that is too large for the body of a record, and writes the encoded edit to the
 * disk. */
static st_status stage_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                            size_t bound, st_booking *out)
{
    unsigned char *bytes = bound <= ST_MOST_BODY ? he_mem_alloc(bound) : NULL;
    if (bytes == NULL) {
        return bound > ST_MOST_BODY ? ST_TOO_LARGE : ST_NO_MEMORY;
    }
    out->body = he_stored_edit_write(delta, after, bytes);
    out->staged_edit = true;
    st_status status = journal->stage_edit(journal->self, bytes, out->body, &out->stage);
    he_mem_free(bytes);
    return status;
}

static st_status stage(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       st_booking *out)
{
    const size_t bound = he_stored_edit_bound(delta, after);
    if (bound <= ST_BODY_BYTES) {
        return ST_OK;
    }
    return replaces(delta) ? st_book_stage(journal, after, &out->stage)
                           : stage_edit(journal, delta, after, bound, out);
}

st_status st_book_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       bool may_wait, st_booking *out)
{
    st_room_need need = {.records = 1};
    st_booking staged = {.room = NULL};
    if (journal->keeps && may_wait) {
        st_status status = stage(journal, delta, after, &staged);
        if (status != ST_OK) {
            return status;
        }
    }
    bool coded = journal->keeps && staged.stage == NULL;
    need.bytes = coded ? he_stored_edit_bound(delta, after) : 0;
    st_status status = st_book(journal, &need, out);
    if (status == ST_OK) {
        staged.room = out->room;
        *out = staged;
        out->body = coded ? he_stored_edit_write(delta, after, out->room->bytes) : staged.body;
    } else {
        st_booking_leave(journal, &staged);
    }
    return status;
}

st_status st_book_content(const st_journal *journal, const he_mesh *content, st_stage *stage,
                          size_t records, st_booking *out)
{
    bool coded = journal->keeps && stage == NULL;
    const st_room_need need = {.records = records,
                               .bytes = coded ? he_stored_content_bound(content) : 0};
    st_status status = st_book(journal, &need, out);
    if (status == ST_OK) {
        out->stage = stage;
        out->body = coded ? he_stored_content_write(content, out->room->bytes) : 0;
    }
    return status;
}

st_status st_book_stage(const st_journal *journal, const he_mesh *content, st_stage **out)
{
    *out = NULL;
    if (!journal->keeps || he_stored_content_bound(content) <= ST_BODY_BYTES) {
        return ST_OK;
    }
    return journal->stage(journal->self, content, out);
}

void st_booking_fill(const st_booking *booking, st_record *first)
{
    first->body = booking->body > 0 && booking->stage == NULL ? booking->room->bytes : NULL;
    first->body_size = booking->body;
    first->stage = booking->stage;
    first->staged_edit = booking->staged_edit;
}

void st_booking_leave(const st_journal *journal, st_booking *booking)
{
    if (booking->room != NULL) {
        journal->leave(journal->self, booking->room);
    }
    if (booking->stage != NULL) {
        journal->unstage(journal->self, booking->stage);
    }
    *booking = (st_booking){NULL};
}
