/* face_groups.h - values that a text format states once for all the faces that follow, such as a
 * group or a material.
 *
 * While a file is read, only the faces where the value changes are stored; at the end the values
 * become an attribute of the faces. */
#ifndef HE_FORMAT_IO_FACE_GROUPS_H
#define HE_FORMAT_IO_FACE_GROUPS_H

#include "build/build.h"
#include "format/text/lines.h"
#include "format/text/warnings.h"

/* The values of consecutive faces. {0} is empty: every face has the value 0, or the label "". */
typedef struct he_face_groups {
    he_ids changes;    /* pairs: a face, and the value that holds from this face on */
    he_labels *labels; /* NULL for plain numbers */
} he_face_groups;

void he_face_groups_clear(he_face_groups *groups);
/* Gives a value to all faces from `face` on. Calls must come in the order of faces.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_face_groups_set(he_face_groups *groups, size_t face, uint32_t value,
                                          he_error *err);
/* Does what he_face_groups_set does, with a name in UTF-8 as the value. */
HE_NODISCARD he_status he_face_groups_set_label(he_face_groups *groups, size_t face,
                                                const char *text, size_t length, he_error *err);
/* A name that was read from a file. */
typedef struct he_name {
    const char *text; /* the name in UTF-8, not ended by a NUL; points into `own` */
    size_t length;
    char *own; /* the caller frees it */
} he_name;

/* Reads a name in a line: the text from `p` to the end of the line, without blanks around it; each
 * continuation (a backslash before a line end) inside it becomes a blank. Bytes that are not UTF-8
 * are converted from Latin-1, with a warning in `warnings` (may be NULL).
 * Returns HE_SYNTAX if the name contains a control character.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_line_name(const he_line *line, const char *p, he_warnings *warnings,
                                    he_name *out, he_error *err);
/* Does what he_face_groups_set_label does, with a name that he_line_name reads from the line. */
HE_NODISCARD he_status he_face_groups_set_name(he_face_groups *groups, size_t face,
                                               const he_line *line, const char *p,
                                               he_warnings *warnings, he_error *err);
/* Writes the names of the faces before face `faces` to an attribute with labels, except for the
 * faces in the ranges that `own` lists: rising pairs of a first face and the face after the
 * last. */
HE_NODISCARD he_status he_face_groups_merge(he_face_groups *groups, size_t faces, he_column *column,
                                            const he_ids *own, he_error *err);
/* Makes the uint32 attribute `name` of the faces, unless every face has the default value. */
HE_NODISCARD he_status he_face_groups_finish(he_face_groups *groups, he_soup *soup,
                                             const char *name, he_error *err);

#endif
