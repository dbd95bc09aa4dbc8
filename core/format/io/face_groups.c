#include "format/io/face_groups.h"

#include "base/utf8.h"

#include <string.h>

void he_face_groups_clear(he_face_groups *groups)
{
    he_ids_clear(&groups->changes);
    he_labels_release(groups->labels);
    groups->labels = NULL;
}

he_status he_face_groups_set(he_face_groups *groups, size_t face, uint32_t value, he_error *err)
{
    he_ids *changes = &groups->changes;
    size_t n = changes->count;
    if (n > 0 && changes->ids[n - 2] == face) {
        changes->ids[n - 1] = value;
        return HE_OK;
    }
    if ((n > 0 ? changes->ids[n - 1] : 0) == value) {
        return HE_OK;
    }
    he_status status = he_ids_reserve(changes, 2, err);
    if (status == HE_OK) {
        changes->ids[n] = (uint32_t)face;
        changes->ids[n + 1] = value;
        changes->count = n + 2;
    }
    return status;
}

/* Converts Latin-1 to UTF-8; `to` must have room for twice the bytes. */
static size_t widen(const char *from, size_t size, char *to)
{
    size_t length = 0;
    for (size_t i = 0; i < size; i++) {
        unsigned char c = (unsigned char)from[i];
        if (c < 0x80) {
            to[length++] = (char)c;
        } else {
            to[length++] = (char)(0xC0 | c >> 6);
            to[length++] = (char)(0x80 | (c & 0x3F));
        }
    }
    return length;
}

/* Copies [p, end) with each continuation (backslash and line end) as one blank, and without blanks
 * at the end. */
static size_t join(const char *p, const char *end, char *to)
{
    size_t length = 0;
    while (p < end) {
        const char *after = *p == '\\' ? he_continuation(p, end) : NULL;
        to[length++] = after != NULL ? ' ' : *p;
        p = after != NULL ? after : p + 1;
    }
    while (length > 0 && (to[length - 1] == ' ' || to[length - 1] == '\t')) {
        length--;
    }
    return length;
}

he_status he_face_groups_set_label(he_face_groups *groups, size_t face, const char *text,
                                   size_t length, he_error *err)
{
    uint32_t value = 0;
    he_status status = HE_OK;
    if (groups->labels == NULL) {
        groups->labels = he_labels_new();
        if (groups->labels == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for names");
        }
    }
    /* Faces without a name have the value 0, so label 0 must be the empty name, even if an
     * earlier call failed before it was added. */
    if (he_labels_count(groups->labels) == 0) {
        status = he_labels_add(groups->labels, "", 0, &value, err);
    }
    if (status == HE_OK) {
        status = he_labels_add(groups->labels, text, length, &value, err);
    }
    return status == HE_OK ? he_face_groups_set(groups, face, value, err) : status;
}

he_status he_line_name(const he_line *line, const char *p, he_warnings *warnings, he_name *out,
                       he_error *err)
{
    const char *begin = he_skip_blanks(p, line->end);
    size_t room = (size_t)(line->end - begin);
    /* memory for `room` bytes of the name as read, and for twice as many of the name in UTF-8 */
    char *name = he_mem_alloc(3 * room);
    if (name == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a name of %zu bytes", room);
    }
    size_t length = join(begin, line->end, name);
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)name[i] < 0x20 && name[i] != '\t') {
            unsigned control = (unsigned char)name[i];
            he_mem_free(name);
            return he_line_fail(err, HE_SYNTAX, line, begin,
                                "a name contains the control character %u", control);
        }
    }
    const char *text = name;
    if (!he_is_utf8(name, length)) {
        if (warnings != NULL) {
            he_warnings_add(
                warnings,
                &(he_occurrence){.code = "not_utf8",
                                 .text = "name % is read as Latin-1, because it is not UTF-8",
                                 .subject = name,
                                 .length = length,
                                 .place = HE_PLACE_LINE,
                                 .at = line->number});
        }
        length = widen(name, length, name + room);
        text = name + room;
    }
    *out = (he_name){text, length, name};
    return HE_OK;
}

he_status he_face_groups_set_name(he_face_groups *groups, size_t face, const he_line *line,
                                  const char *p, he_warnings *warnings, he_error *err)
{
    he_name name = {.own = NULL};
    he_status status = he_line_name(line, p, warnings, &name, err);
    if (status == HE_OK) {
        status = he_face_groups_set_label(groups, face, name.text, name.length, err);
    }
    he_mem_free(name.own);
    return status;
}

he_status he_face_groups_merge(he_face_groups *groups, size_t faces, he_column *column,
                               const he_ids *own, he_error *err)
{
    const he_ids *changes = &groups->changes;
    size_t k = 0, change = 0;
    he_status status = HE_OK;
    if (column->rows < faces) {
        status = he_column_extend(column, faces - column->rows, err);
    }
    for (size_t f = 0; f < faces && status == HE_OK;) {
        if (k < own->count && f >= own->ids[k]) { /* skip faces in `own`: they keep their names */
            f = own->ids[k + 1] > f ? own->ids[k + 1] : f;
            k += 2;
            continue;
        }
        while (change < changes->count && changes->ids[change] <= f) {
            change += 2;
        }
        size_t end = change < changes->count ? changes->ids[change] : faces;
        end = k < own->count && own->ids[k] < end ? own->ids[k] : end;
        const char *text =
            change > 0 ? he_labels_get(groups->labels, changes->ids[change - 1]) : "";
        uint32_t number = 0;
        status = he_labels_add(column->labels, text, strlen(text), &number, err);
        for (; f < end && f < faces && status == HE_OK; f++) {
            memcpy(he_column_row(column, f), &number, sizeof number);
        }
    }
    return status;
}

he_status he_face_groups_finish(he_face_groups *groups, he_soup *soup, const char *name,
                                he_error *err)
{
    const he_ids *changes = &groups->changes;
    size_t faces = soup->face_count;
    if (changes->count == 0 || changes->ids[0] >= faces) {
        return HE_OK;
    }
    he_column *column;
    he_status status = he_soup_column(
        soup, &(he_column_schema){name, HE_FACE, HE_UINT32, 1, HE_COPY}, &column, err);
    if (status == HE_OK) {
        status = he_column_extend(column, faces, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < changes->count; i += 2) {
        size_t end = i + 2 < changes->count ? changes->ids[i + 2] : faces;
        for (size_t f = changes->ids[i]; f < end && f < faces; f++) {
            memcpy(he_column_row(column, f), &changes->ids[i + 1], sizeof(uint32_t));
        }
    }
    column->labels = groups->labels;
    groups->labels = NULL;
    return HE_OK;
}
