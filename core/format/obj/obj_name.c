#include "format/obj/obj_name.h"

#include <string.h>

void he_obj_note_name(const char *name, he_warnings *warnings)
{
    for (const char *p = name; *p != '\0'; p++) {
        if (he_obj_printable(p, p == name) != *p) {
            he_warnings_add(
                warnings, &(he_occurrence){.code = "names_changed",
                                           .text = "name % is written with '_' in place of a "
                                                   "character that a line of the file cannot hold",
                                           .subject = name,
                                           .length = strlen(name)});
            break;
        }
    }
}

char *he_obj_name_write(he_obj_name *name, char *p, const char *end)
{
    while (*name->rest != '\0') {
        if (end - p < 2) {
            return p;
        }
        *p++ = he_obj_printable(name->rest, !name->begun);
        name->begun = true;
        name->rest++;
    }
    *p++ = '\n';
    *name = (he_obj_name){NULL, false};
    return p;
}
