/* journal_room.h - functions for the journals that tests use instead of a disk. A room is memory
 * that is reserved for the records of a write before the write begins. */
#ifndef TESTS_JOURNAL_ROOM_H
#define TESTS_JOURNAL_ROOM_H

#include "journal/journal.h"

/* Allocates a room that meets `need`. If `refuse` is not ST_OK, fails with that status; but a
 * deletion succeeds if that status is ST_FULL. The memory comes from the C library, so that tests
 * that make allocations fail affect only the store. */
st_status journal_room_new(st_status refuse, const st_room_need *need, st_room **out);
void journal_room_free(st_room *room);

/* A journal's function `keys` that finds no Idempotency-Keys, because the journal stores none. */
st_status journal_keys_none(void *self, const char *id, st_take_key *take, void *context);

#endif
