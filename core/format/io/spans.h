/* spans.h - values that a text format states once for all faces that follow: a group, a material.
 *
 * Stored as the faces where the value changes; made an attribute of the faces at the end. */
#ifndef HE_FORMAT_IO_SPANS_H
#define HE_FORMAT_IO_SPANS_H

#include "build/build.h"
#include "format/text/lines.h"
#include "format/text/notes.h"

/* {0} is empty: every face has the value 0, or the label "". */
typedef struct he_spans {
    he_ids changes;    /* pairs of first face and value */
    he_labels *labels; /* NULL for plain numbers */
} he_spans;

void he_spans_clear(he_spans *spans);
/* Gives this value to the faces from `face` on; calls come in the order of faces.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_spans_set(he_spans *spans, size_t face, uint32_t value, he_error *err);
/* he_spans_set with a name in UTF-8 as the value. */
HE_NODISCARD he_status he_spans_set_label(he_spans *spans, size_t face, const char *text,
                                          size_t length, he_error *err);
/* Reads a name in a line: the text from `p` to the end of the line, without blanks around it; each
 * continuation inside it becomes a blank. Bytes that are not UTF-8 are converted from Latin-1, with
 * a note (`notes` may be NULL): then *text differs from *own. The caller frees *own.
 * Returns HE_SYNTAX if it contains a control character.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_line_name(const he_line *line, const char *p, he_notes *notes, char **own,
                                    const char **text, size_t *length, he_error *err);
/* he_spans_set_label with such a name. */
HE_NODISCARD he_status he_spans_set_name(he_spans *spans, size_t face, const he_line *line,
                                         const char *p, he_notes *notes, he_error *err);
/* Writes the names to the faces up to `faces` of an attribute with labels, except the faces of
 * `own`: rising pairs, from a face up to before another. */
HE_NODISCARD he_status he_spans_merge(he_spans *spans, size_t faces, he_column *column,
                                      const he_ids *own, he_error *err);
/* Makes the uint32 attribute `name`, unless every face has the default. */
HE_NODISCARD he_status he_spans_finish(he_spans *spans, he_soup *soup, const char *name,
                                       he_error *err);

#endif
