/* obj_name.h - writes names of groups, materials and files into OBJ files and their libraries. */
#ifndef HE_FORMAT_OBJ_OBJ_NAME_H
#define HE_FORMAT_OBJ_OBJ_NAME_H

#include "format/text/warnings.h"

#include <stdbool.h>

/* Returns the byte *p of a name, or '_' in its place if the byte would end the line, join the
 * line with the next one, or be lost when the file is read. `first` says whether *p is the first
 * byte of the name. */
static inline char he_obj_printable(const char *p, bool first)
{
    bool last = p[1] == '\0';
    bool blank = *p == ' ' || *p == '\t';
    if ((unsigned char)*p < 0x20 && *p != '\t') {
        return '_';
    }
    return (blank && (first || last)) || (*p == '\\' && last) ? '_' : *p;
}

/* Adds a warning about a name that is changed when it is written. */
void he_obj_note_name(const char *name, he_warnings *warnings);

/* A name of any length that is being written; {0} means that none is being written. */
typedef struct he_obj_name {
    const char *rest; /* the part of the name that is still to be written, or NULL */
    bool begun;
} he_obj_name;

/* Writes as much of the name as fits, and after the whole name a line feed: then the member `rest`
 * becomes NULL. At least one byte must be free. */
char *he_obj_name_write(he_obj_name *name, char *p, const char *end);

#endif
