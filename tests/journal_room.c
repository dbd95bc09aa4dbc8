#include "tests/journal_room.h"

#include <stdlib.h>

st_status journal_room_new(st_status refuse, const st_room_need *need, st_room **out)
{
    if (refuse != ST_OK && !(need->freeing && refuse == ST_FULL)) {
        return refuse;
    }
    st_room *room = malloc(sizeof *room + need->bytes);
    if (room == NULL) {
        return ST_NO_MEMORY;
    }
    *room = (st_room){.bytes = (unsigned char *)(room + 1), .size = need->bytes};
    *out = room;
    return ST_OK;
}

void journal_room_free(st_room *room)
{
    free(room);
}

st_status journal_keys_none(void *self, const char *id, st_take_key *take, void *context)
{
    (void)self;
    (void)id;
    (void)take;
    (void)context;
    return ST_OK;
}
