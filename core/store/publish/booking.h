/* booking.h - reserves room in the journal for a group of records, with the body of the first.
 *
 * A write books room while it can still be refused; then it publishes its records with the room, or
 * gives the room back. The body is coded here, before a claim takes the lock. A journal that keeps
 * nothing gives no room, and then nothing is coded. */
#ifndef HE_STORE_BOOKING_H
#define HE_STORE_BOOKING_H

#include "journal/journal.h"
#include "mesh/delta.h"

typedef struct st_booking {
    st_room *room;
    size_t body;     /* bytes of the room that are the first record's body */
    st_stage *stage; /* the first record's content, or its coded edit, in place of a body */
    bool staged_edit;
} st_booking;

/* The functions that book room. On failure *out is as it was.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY or ST_TOO_LARGE if the journal refuses. */

/* Books room for records without a body. */
st_status st_book(const st_journal *journal, const st_room_need *need, st_booking *out);
/* Books room for an edit that made `after`. If the caller may wait for the disk, large bodies are
 * staged (written to the disk before the change is published): a content that replaced another, or
 * the coded edit. */
st_status st_book_edit(const st_journal *journal, const he_delta *delta, const he_mesh *after,
                       bool may_wait, st_booking *out);
/* Books room for a whole content, the first of `records` records. Takes `stage`, the content that
 * was written in advance, on success; NULL means that it was not. */
st_status st_book_content(const st_journal *journal, const he_mesh *content, st_stage *stage,
                          size_t records, st_booking *out);
/* Writes a content that is too large for the body of a record to the disk, and may wait for that.
 * *out is NULL on failure, if the content is small, or if the journal keeps nothing. */
st_status st_book_stage(const st_journal *journal, const he_mesh *content, st_stage **out);
/* Fills in the fields of `first` that the booking decides. */
void st_booking_fill(const st_booking *booking, st_record *first);
/* Gives the room back: none of the records was published. */
void st_booking_leave(const st_journal *journal, st_booking *booking);

#endif
