#include "journal/record.h"

#include <string.h>

void st_copy_text(char *to, const char *from, size_t most)
{
    size_t length = strnlen(from, most);
    memcpy(to, from, length);
    to[length] = '\0';
}

void st_card_of_record(const st_record *record, st_card *card)
{
    st_copy_text(card->id, record->id, ST_MESH_ID);
    st_copy_text(card->name, record->name, ST_MESH_NAME);
    card->incarnation = record->incarnation;
    card->metadata = record->metadata;
    card->revision = record->revision;
    card->record = record->number;
    card->created = record->created;
    card->modified = record->time;
    card->counts = record->counts;
    card->bytes = record->bytes;
    st_copy_text(card->holder, record->holder == NULL ? "" : record->holder, ST_HOLDER);
}
