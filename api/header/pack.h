/* pack.h - an answer's body, coded while it is pulled.
 *
 *     api_pack_new -> api_pack_whole -> api_pack_begin -> api_pack_read ... -> 0
 *
 * The levels are the fastest, 1 of either library: who waits for a million faces waits for us and
 * not for the line, and beyond the first level a text of coordinates shrinks by some percent at
 * twice the price. The same body gives the same bytes however it is read. */
#ifndef HE_API_HEADER_PACK_H
#define HE_API_HEADER_PACK_H

#include "api/header/coding.h"

#include <stddef.h>
#include <stdint.h>

typedef struct api_pack api_pack;

/* Bytes, or a reader as in api_answer; borrowed. */
typedef struct api_plain {
    const char *bytes; /* NULL: `read` */
    size_t length;
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
} api_plain;

/* `coding` is not identity. NULL when memory is out. */
api_pack *api_pack_new(api_coding coding, const api_plain *plain);
void api_pack_free(api_pack *pack);

/* Is the body no longer than API_PACK_AT_ONCE? Then all of it, plain, lent as long as the pack. May
 * read from the body; before the first api_pack_read. */
bool api_pack_whole(api_pack *pack, const char **bytes, size_t *length);

/* Take the memory that coding needs, after api_pack_whole and before api_pack_read. False when it
 * is not there: nothing has happened. */
bool api_pack_begin(api_pack *pack);
/* Instead: give the body as it is. */
void api_pack_give_up(api_pack *pack);

/* As api_answer's read. What came out of API_PACK_TURN plain bytes is given, so that no call takes
 * long however far the body packs; only where nothing came out of so many (zlib holds back up to
 * 4 MiB of zeros) it reads on. */
int64_t api_pack_read(void *pack, char *buffer, size_t size);

#endif
