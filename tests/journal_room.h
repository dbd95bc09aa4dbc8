/* journal_room.h - what the journals of tests have in common: rooms, which reserve space for the
 * bodies of records, and no Idempotency-Keys. */
#ifndef TESTS_JOURNAL_ROOM_H
#define TESTS_JOURNAL_ROOM_H

#include "journal/journal.h"

/* Makes a room for `need`. If `refuse` is not ST_OK it is returned instead, except that deletions
 * are accepted on a full disk. The memory comes from the C library, so that tests of failing
 * allocations affect the store alone. */
st_status journal_room_new(st_status refuse, const st_room_need *need, st_room **out);
void journal_room_free(st_room *room);

/* The function `keys` of a journal that stores no Idempotency-Keys. */
st_status journal_keys_none(void *self, const char *id, st_take_key *take, void *context);

#endif
