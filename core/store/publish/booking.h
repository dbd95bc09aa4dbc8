/* booking.h - reserves space in the journal for a group of records and for the body of its first
 * record.
 *
 * A write (a change of a mesh) books space while it can still be refused; later it publishes its
 * records into this space, or gives the space back. The body is encoded when space is booked, so a
 * long edit is encoded before its commit takes the mesh's lock. A journal that stores nothing gives
 * no space, and then nothing is encoded. */
#ifndef HE_STORE_BOOKING_H
#define HE_STORE_BOOKING_H

#include "journal/journal.h"
#include "mesh/delta.h"

typedef struct st_booking {
    st_room *room;
    size_t body; /* how many of the bytes reserved in `room` are the body of the first record */
    /* Data that was written to the disk in place of the body of the first record: all mesh data, or
     * an encoded edit. */
    st_stage *stage;
    bool staged_edit;
} st_booking;

/* The next three functions book space in the journal. On failure *out is as it was.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY or ST_TOO_LARGE if the journal refuses. */

/* Books space in the journal for records without a body. */
st_status st_book(const st_journal *journal, const st_room_need *need, st_booking *out);
/* Books space in the journal for an edit; `after` is the mesh after the edit. If the caller may
 * wait for the disk, a large body is staged, which means that it is written to the disk before the
 * change is published. The body is the encoded edit, or the whole content if the edit replaced
 * it. */
st_status st_book_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       bool may_wait, st_booking *out);
/* Books space in the journal for `records` records, of which the first has the whole content. If
 * the content was written to the disk in advance, `stage` is not NULL, and on success the booking
 * owns it. */
st_status st_book_content(const st_journal *journal, const he_mesh *content, st_stage *stage,
                          size_t records, st_booking *out);
/* Writes a content that is too large for the body of a record to the disk; may wait for the disk.
 * *out is NULL on failure, if the content is small, or if the journal stores nothing. */
st_status st_book_stage(const st_journal *journal, const he_mesh *content, st_stage **out);
/* Fills in the body and the stage (data written in advance) of the first record of the group from
 * the booking. */
void st_booking_fill(const st_booking *booking, st_record *first);
/* Gives the booked space back; it must not be called once the records were published. */
void st_booking_leave(const st_journal *journal, st_booking *booking);

#endif
