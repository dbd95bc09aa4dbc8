/* spans.h - what a text format says once for all faces that follow: a group, a material.
 *
 * Kept as the faces where it changes; made an attribute of the faces at the end. */
#ifndef HE_FORMAT_IO_SPANS_H
#define HE_FORMAT_IO_SPANS_H

#include "build/build.h"
#include "format/text/lines.h"
#include "format/text/notes.h"

/* {0} is empty: 0, or the label "", for every face. */
typedef struct he_spans {
    he_ids changes;    /* pairs: first face, value */
    he_labels *labels; /* NULL for plain numbers */
} he_spans;

void he_spans_clear(he_spans *spans);
/* Faces from `face` on have this value; calls come in the order of faces. HE_NO_MEMORY. */
HE_NODISCARD he_status he_spans_set(he_spans *spans, size_t face, uint32_t value, he_error *err);
/* The same with a name in UTF-8. */
HE_NODISCARD he_status he_spans_set_label(he_spans *spans, size_t face, const char *text,
                                          size_t length, he_error *err);
/* A name in a line: the text from `p` to the end of the line, blanks around it left out and
 * continuations inside it made blanks. Bytes that are not UTF-8 are taken for Latin-1, with a note
 * (`notes` may be NULL): then *text is not *own. *own is freed by the caller. HE_SYNTAX for a
 * control character, HE_NO_MEMORY. */
HE_NODISCARD he_status he_line_name(const he_line *line, const char *p, he_notes *notes, char **own,
                                    const char **text, size_t *length, he_error *err);
/* he_spans_set_label with such a name. */
HE_NODISCARD he_status he_spans_set_name(he_spans *spans, size_t face, const he_line *line,
                                         const char *p, he_notes *notes, he_error *err);
/* Give the names to the faces up to `faces` of an attribute with labels, save those of `own`:
 * rising pairs, from a face to before another. */
HE_NODISCARD he_status he_spans_merge(he_spans *spans, size_t faces, he_column *column,
                                      const he_ids *own, he_error *err);
/* Make the uint32 attribute `name`, unless every face has the default. */
HE_NODISCARD he_status he_spans_finish(he_spans *spans, he_soup *soup, const char *name,
                                       he_error *err);

#endif
