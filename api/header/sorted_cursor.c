#include "api/header/sorted_cursor.h"

#include "api/header/path.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A cursor is the text "by-ORDER.KEY.ID". It does not begin like a cursor of the list in the order
 * of ids, which is the letter m and an id. The key is in hexadecimal digits: the bytes of the name,
 * or the 8 bytes of a number, which for a time are those of its IEEE 754 double. */

const char *const api_order_names[] = {
    [ST_BY_NAME] = "name", [ST_BY_MODIFIED] = "modified", [ST_BY_BYTES] = "bytes", NULL};

enum { WORD = 8 };

#define BY "by-"

/* Copies the key of a card, by which lists in this order are sorted, to `out`. Returns its number
 * of bytes. */
static size_t key_of(st_card_order order, const st_card *card, unsigned char out[ST_MESH_NAME])
{
    uint64_t word = card->bytes;
    if (order == ST_BY_NAME) {
        const size_t length = strlen(card->name);
        memcpy(out, card->name, length);
        return length;
    }
    if (order == ST_BY_MODIFIED) {
        memcpy(&word, &card->modified, sizeof word);
    }
    for (size_t i = 0; i < WORD; i++) {
        out[i] = (unsigned char)(word >> (8 * (WORD - 1 - i)));
    }
    return WORD;
}

/* Sets the key of a card. Returns false if no card has such a key. */
static bool set_key(st_card_order order, const unsigned char *key, size_t length, st_card *out)
{
    uint64_t word = 0;
    if (order == ST_BY_NAME) {
        memcpy(out->name, key, length);
        out->name[length] = '\0';
        return memchr(key, '\0', length) == NULL;
    }
    for (size_t i = 0; i < WORD && i < length; i++) {
        word = word << 8 | key[i];
    }
    if (order == ST_BY_MODIFIED) {
        memcpy(&out->modified, &word, sizeof word);
        return length == WORD && isfinite(out->modified);
    }
    out->bytes = word;
    return length == WORD && word <= INT64_MAX;
}

void api_sorted_cursor_write(st_card_order order, const st_card *last, char out[API_SORTED_CURSOR])
{
    static const char digits[] = "0123456789abcdef";
    unsigned char key[ST_MESH_NAME];
    const size_t length = key_of(order, last, key);
    size_t used = (size_t)snprintf(out, API_SORTED_CURSOR, BY "%s.", api_order_names[order]);
    for (size_t i = 0; i < length; i++) {
        out[used++] = digits[key[i] >> 4];
        out[used++] = digits[key[i] & 15];
    }
    (void)snprintf(out + used, API_SORTED_CURSOR - used, ".%s", last->id);
}

static int digit_of(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Reads the bytes of a key from `length` hexadecimal digits. */
static bool read_key(const char *text, size_t length, unsigned char out[ST_MESH_NAME])
{
    if (length % 2 != 0 || length > 2 * (size_t)ST_MESH_NAME) {
        return false;
    }
    for (size_t i = 0; i < length; i += 2) {
        const int high = digit_of(text[i]), low = digit_of(text[i + 1]);
        if (high < 0 || low < 0) {
            return false;
        }
        out[i / 2] = (unsigned char)(16 * high + low);
    }
    return true;
}

/* Returns the order that a cursor names; *place is then the text after it. Returns ST_CARD_ORDERS
 * if the cursor names none. */
static st_card_order find_order(const char *text, const char **place)
{
    int order = 0;
    for (; order < ST_CARD_ORDERS; order++) {
        char begin[16];
        const int length = snprintf(begin, sizeof begin, BY "%s.", api_order_names[order]);
        if (strncmp(text, begin, (size_t)length) == 0) {
            *place = text + length;
            break;
        }
    }
    return (st_card_order)order;
}

/* Reads the text "KEY.ID". */
static bool read_place(const char *text, st_card_order order, st_card *last)
{
    unsigned char key[ST_MESH_NAME] = {0};
    const size_t digits = strcspn(text, ".");
    const char *id = text[digits] == '.' ? text + digits + 1 : "";
    if (!api_path_is_mesh_id(id) || !read_key(text, digits, key) ||
        !set_key(order, key, digits / 2, last)) {
        return false;
    }
    st_copy_text(last->id, id, ST_MESH_ID);
    return true;
}

bool api_sorted_cursor_read(const char *text, st_card_order order, st_card *last,
                            api_problem *problem)
{
    const char *place = "";
    const st_card_order named = find_order(text, &place);
    if (named != ST_CARD_ORDERS && named != order) {
        return api_problem_set(problem, API_BAD_CURSOR,
                               "the cursor belongs to the list of meshes with sort=%s, but the "
                               "request has sort=%s",
                               api_order_names[named], api_order_names[order]);
    }
    return read_place(place, order, last) ||
           api_problem_set(problem, API_BAD_CURSOR,
                           "the cursor \"%.100s\" does not belong to the list of meshes with "
                           "sort=%s",
                           text, api_order_names[order]);
}
