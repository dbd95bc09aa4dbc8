/* obj_name.h - writes names of groups, materials and files into OBJ files and their libraries. */
#ifndef HE_FORMAT_OBJ_OBJ_NAME_H
#define HE_FORMAT_OBJ_OBJ_NAME_H

#include "format/text/notes.h"

#include <stdbool.h>

/* Returns '_' for a byte that would end the line, join the next one, or not read back, else the
 * byte. `first` says whether *p is the name's first byte. */
static inline char he_obj_printable(const char *p, bool first)
{
    bool last = p[1] == '\0';
    bool blank = *p == ' ' || *p == '\t';
    if ((unsigned char)*p < 0x20 && *p != '\t') {
        return '_';
    }
    return (blank && (first || last)) || (*p == '\\' && last) ? '_' : *p;
}

/* Notes a name that is not written as it is. */
void he_obj_note_name(const char *name, he_notes *notes);

/* A name of any length while it is written; {0} is none. */
typedef struct he_obj_name {
    const char *rest; /* NULL: none */
    bool begun;
} he_obj_name;

/* Writes as much as fits, and after the whole name a line feed: rest is then NULL. At least one
 * byte must be free. */
char *he_obj_name_write(he_obj_name *name, char *p, const char *end);

#endif
