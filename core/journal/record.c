#include "journal/record.h"

#include <string.h>

void st_copy_text(char *to, const char *from, size_t most)
{
    size_t length = strnlen(from, most);
    memcpy(to, from, length);
    to[length] = '\0';
}

static int lower(char c)
{
    const int byte = (unsigned char)c;
    return byte >= 'A' && byte <= 'Z' ? byte - 'A' + 'a' : byte;
}

/* Compares names as SQLite's collation NOCASE does, so that all journals list them in one order. */
static int compare_names(const char *a, const char *b)
{
    while (*a != '\0' && lower(*a) == lower(*b)) {
        a++;
        b++;
    }
    return lower(*a) - lower(*b);
}

int st_card_compare(st_card_order order, const st_card *a, const st_card *b)
{
    int first = 0;
    const int ids = strcmp(a->id, b->id);
    switch (order) {
    case ST_BY_NAME:
        first = compare_names(a->name, b->name);
        return first != 0 ? first : ids;
    case ST_BY_MODIFIED:
        first = (a->modified < b->modified) - (a->modified > b->modified);
        break;
    case ST_BY_BYTES:
        first = (a->bytes < b->bytes) - (a->bytes > b->bytes);
        break;
    case ST_CARD_ORDERS:
        break;
    }
    return first != 0 ? first : -ids;
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
