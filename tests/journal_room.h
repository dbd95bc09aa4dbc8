/* journal_room.h - what the journals of tests do alike: rooms for bodies, and no kept keys. */
#ifndef TESTS_JOURNAL_ROOM_H
#define TESTS_JOURNAL_ROOM_H

#include "journal/journal.h"

/* A room for `need`, or `refuse` where that is not ST_OK: but a removal is admitted although the
 * disk is full. Its memory is the system's, so that tests of failing allocations see those of the
 * store alone. */
st_status journal_room_new(st_status refuse, const st_room_need *need, st_room **out);
void journal_room_free(st_room *room);

/* `keys` of a journal that forgets them. */
st_status journal_keys_none(void *self, const char *id, st_take_key *take, void *context);

#endif
