#include "store/booking.h"

#include "store/limits.h"
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

st_status st_book_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       bool may_wait, st_booking *out)
{
    st_room_need need = {.records = 1};
    st_stage *stage = NULL;
    if (journal->keeps && may_wait && replaces(delta)) {
        st_status status = st_book_stage(journal, after, &stage);
        if (status != ST_OK) {
            return status;
        }
    }
    bool coded = journal->keeps && stage == NULL;
    need.bytes = coded ? he_stored_edit_bound(delta, after) : 0;
    st_status status = st_book(journal, &need, out);
    if (status == ST_OK) {
        out->stage = stage;
        out->body = coded ? he_stored_edit_write(delta, after, out->room->bytes) : 0;
    } else if (stage != NULL) {
        journal->unstage(journal->self, stage);
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
    first->body = booking->body > 0 ? booking->room->bytes : NULL;
    first->body_size = booking->body;
    first->stage = booking->stage;
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
