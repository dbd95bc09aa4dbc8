/* booking.h - a place in the journal for a group of records, with the body of the first.
 *
 * It is booked while the write can still be refused, and is published with the write or left. The
 * body is coded here, before a claim takes the lock. A journal that keeps nothing gives no room,
 * and then nothing is coded. */
#ifndef HE_STORE_BOOKING_H
#define HE_STORE_BOOKING_H

#include "journal/journal.h"
#include "mesh/delta.h"

typedef struct st_booking {
    st_room *room;
    size_t body;     /* bytes in the room that are the first record's body */
    st_stage *stage; /* the first record's content, or its coded edit, instead of a body */
    bool staged_edit;
} st_booking;

/* Each returns ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY or ST_TOO_LARGE and then leaves *out as
 * it was. */

/* Books a place for records without a body. */
st_status st_book(const st_journal *journal, const st_room_need *need, st_booking *out);
/* Books a place for an edit that made `after`. Of a caller that may wait for the disk, what is
 * large is staged: a content that replaced another, or the coded edit. */
st_status st_book_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       bool may_wait, st_booking *out);
/* For a whole content, in `records` of which it is the first. Takes `stage` on success; NULL: the
 * content was not staged. */
st_status st_book_content(const st_journal *journal, const he_mesh *content, st_stage *stage,
                          size_t records, st_booking *out);
/* Brings a content that is too large for a body to the disk: may wait for it. *out is NULL on
 * failure, and where the content is small or nothing is kept. */
st_status st_book_stage(const st_journal *journal, const he_mesh *content, st_stage **out);
/* Fills in what `first` keeps of the booking. */
void st_booking_fill(const st_booking *booking, st_record *first);
/* Nothing of it was published. */
void st_booking_leave(const st_journal *journal, st_booking *booking);

#endif
