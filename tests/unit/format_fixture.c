#include "unit/format_fixture.h"

he_status read_pieces(const format_file *file, size_t piece, const he_limits *limits,
                      he_import *out, he_error *err)
{
    const size_t length = file->length;
    he_reader *reader;
    he_status status = he_reader_new(he_format_find(file->format), limits, &reader, err);
    if (status != HE_OK) {
        return status;
    }
    piece = piece == 0 ? length : piece;
    for (size_t at = 0; at < length && status == HE_OK; at += piece) {
        size_t n = length - at < piece ? length - at : piece;
        /* each piece is copied to a block of exactly its size, so that the sanitizer detects reads
         * beyond the end of the piece */
        char *bytes = malloc(n);
        assert_non_null(bytes);
        memcpy(bytes, (const char *)file->bytes + at, n);
        status = he_reader_feed(reader, bytes, n, err);
        free(bytes);
    }
    if (status == HE_OK) {
        status = he_reader_finish(reader, out, err);
    } else {
        he_error again = {0};
        assert_int_equal(he_reader_finish(reader, out, &again), status);
        assert_string_equal(again.text, err->text);
    }
    he_reader_free(reader);
    return status;
}

void expect_same_columns(const he_column *a, const he_column *b)
{
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->domain, b->domain);
    assert_int_equal(a->type, b->type);
    assert_int_equal(a->components, b->components);
    assert_int_equal(a->rows, b->rows);
    assert_memory_equal(a->data, b->data, a->rows * a->row_bytes);
    assert_int_equal(a->labels == NULL, b->labels == NULL);
    if (a->labels != NULL) {
        assert_int_equal(he_labels_count(a->labels), he_labels_count(b->labels));
        for (size_t i = 0; i < he_labels_count(a->labels); i++) {
            assert_string_equal(he_labels_get(a->labels, i), he_labels_get(b->labels, i));
        }
    }
}

void expect_same_imports(const he_import *a, const he_import *b)
{
    const he_soup *s = &a->soup, *t = &b->soup;
    assert_int_equal(s->vertex_count, t->vertex_count);
    assert_int_equal(s->corner_count, t->corner_count);
    assert_int_equal(s->face_count, t->face_count);
    assert_int_equal(s->column_count, t->column_count);
    if (s->vertex_count > 0) {
        assert_memory_equal(s->positions, t->positions, s->vertex_count * sizeof(he_vec3));
    }
    if (s->face_count > 0) {
        assert_memory_equal(s->starts, t->starts, s->face_count * sizeof(uint32_t));
    }
    if (s->corner_count > 0) {
        assert_memory_equal(s->corners, t->corners, s->corner_count * sizeof(uint32_t));
    }
    for (size_t i = 0; i < s->column_count && s->columns != NULL && t->columns != NULL; i++) {
        expect_same_columns(s->columns[i], t->columns[i]);
    }
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        assert_int_equal(he_source_map_find(&a->vertices, v), he_source_map_find(&b->vertices, v));
    }
    for (uint32_t f = 0; f < s->face_count; f++) {
        assert_int_equal(he_source_map_find(&a->faces, f), he_source_map_find(&b->faces, f));
    }
    assert_int_equal(a->warnings.count, b->warnings.count);
    assert_int_equal(a->warnings.more, b->warnings.more);
    for (size_t i = 0; i < a->warnings.count; i++) {
        char x[HE_WARNING_TEXT], y[HE_WARNING_TEXT];
        he_warning_text(&a->warnings.items[i], x, sizeof x);
        he_warning_text(&b->warnings.items[i], y, sizeof y);
        assert_string_equal(x, y);
    }
}

he_status read_bytes(const char *format, const void *text, size_t length, he_import *out,
                     he_error *err)
{
    static const size_t pieces[] = {1, 2, 3, 7};
    const format_file file = {format, text, length};
    he_error first = {0};
    he_status status = read_pieces(&file, 0, NULL, out, &first);
    for (size_t i = 0; i < sizeof pieces / sizeof *pieces; i++) {
        he_import other = {0};
        he_error second = {0};
        he_status again = read_pieces(&file, pieces[i], NULL, &other, &second);
        assert_int_equal(again, status);
        assert_string_equal(first.text, second.text);
        assert_int_equal(first.place, second.place);
        assert_int_equal(first.at, second.at);
        if (status == HE_OK) {
            expect_same_imports(out, &other);
            he_import_clear(&other);
        }
    }
    *err = first;
    return status;
}

he_import read_text(const char *format, const char *text)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes(format, text, strlen(text), &import, &err) != HE_OK) {
        fail_msg("%s\n%s", text, err.text);
    }
    return import;
}

void expect_bytes_refused(const format_file *file, he_status wanted, uint64_t line,
                          const char *words)
{
    he_import import = {0};
    he_error err = {0};
    he_status status = read_bytes(file->format, file->bytes, file->length, &import, &err);
    /* The text of the message must not repeat the line number, which the error has in a member of
     * its own (core/base/status.h). */
    if (status != wanted || err.place != HE_PLACE_LINE || err.at != line ||
        strstr(err.text, words) == NULL || strncmp(err.text, "line ", 5) == 0) {
        fail_msg("%.300s\ngot %s, line %llu: %s\nwanted %s, line %llu, %s",
                 (const char *)file->bytes, he_status_slug(status), (unsigned long long)err.at,
                 err.text, he_status_slug(wanted), (unsigned long long)line, words);
    }
}

void expect_refused(const char *format, const char *text, he_status wanted, uint64_t line,
                    const char *words)
{
    const format_file file = {format, text, strlen(text)};
    expect_bytes_refused(&file, wanted, line, words);
}

void expect_refused_at_byte(const format_file *file, he_status wanted, uint64_t at,
                            const char *words)
{
    he_import import = {0};
    he_error err = {0};
    he_status status = read_bytes(file->format, file->bytes, file->length, &import, &err);
    if (status != wanted || err.place != HE_PLACE_BYTE || err.at != at ||
        strstr(err.text, words) == NULL) {
        fail_msg("got %s, %llu: %s\nwanted %s, byte %llu, %s", he_status_slug(status),
                 (unsigned long long)err.at, err.text, he_status_slug(wanted),
                 (unsigned long long)at, words);
    }
}

void expect_counts(const he_import *import, size_t vertices, size_t faces, size_t corners)
{
    assert_int_equal(import->soup.vertex_count, vertices);
    assert_int_equal(import->soup.face_count, faces);
    assert_int_equal(import->soup.corner_count, corners);
}

void expect_corners(const he_import *import, const uint32_t *corners, size_t count)
{
    assert_int_equal(import->soup.corner_count, count);
    assert_memory_equal(import->soup.corners, corners, count * sizeof *corners);
}

const he_column *find_column(const he_import *import, he_kind domain, const char *name)
{
    for (size_t i = 0; i < import->soup.column_count; i++) {
        const he_column *column = import->soup.columns[i];
        if (column->domain == domain && strcmp(column->name, name) == 0) {
            return column;
        }
    }
    return NULL;
}

const he_column *expect_shape(const he_import *import, const attribute_shape *shape, he_type type)
{
    const he_column *column = find_column(import, shape->domain, shape->name);
    assert_non_null(column);
    assert_int_equal(column->type, type);
    assert_int_equal(column->components, shape->components);
    assert_int_equal(column->rows, shape->rows);
    return column;
}

void expect_doubles(const he_import *import, const attribute_shape *shape, const double *values)
{
    const he_column *column = expect_shape(import, shape, HE_DOUBLE);
    assert_memory_equal(column->data, values, shape->rows * shape->components * sizeof *values);
}

void expect_bytes(const he_import *import, he_kind domain, uint32_t components,
                  const unsigned char *values, size_t rows)
{
    const he_column *column = find_column(import, domain, "color");
    assert_non_null(column);
    assert_true(column->type == HE_FLOAT || column->type == HE_DOUBLE);
    assert_int_equal(column->components, components);
    assert_int_equal(column->rows, rows);
    for (size_t i = 0; i < rows * components; i++) {
        double value;
        float single;
        if (column->type == HE_DOUBLE) {
            memcpy(&value, column->data + i * sizeof value, sizeof value);
            assert_true(value == values[i] / 255.0);
        } else {
            memcpy(&single, column->data + i * sizeof single, sizeof single);
            assert_true(single == (float)(values[i] / 255.0));
        }
    }
}

void expect_u32s(const he_import *import, const attribute_shape *shape, const uint32_t *values)
{
    const he_column *column = expect_shape(import, shape, HE_UINT32);
    assert_memory_equal(column->data, values, shape->rows * shape->components * sizeof *values);
}

const char *face_label(const he_import *import, const char *name, size_t face)
{
    const he_column *column = find_column(import, HE_FACE, name);
    assert_non_null(column);
    assert_non_null(column->labels);
    assert_true(face < column->rows);
    uint32_t value;
    memcpy(&value, he_column_row(column, face), sizeof value);
    return he_labels_get(column->labels, value);
}

const he_warning *find_warning(const he_warnings *warnings, const char *code, const char *subject)
{
    for (size_t i = 0; i < warnings->count; i++) {
        const he_warning *note = &warnings->items[i];
        if (strcmp(note->code, code) == 0 && strcmp(note->subject, subject) == 0) {
            return note;
        }
    }
    return NULL;
}

void expect_warning(const he_import *import, const char *code, const char *subject, uint64_t count,
                    uint64_t line)
{
    const he_warning *note = find_warning(&import->warnings, code, subject);
    if (note == NULL) {
        fail_msg("no note %s '%s'", code, subject);
        return;
    }
    assert_int_equal(note->count, count);
    assert_int_equal(note->at, line);
}

he_mesh *build_import(he_import *import)
{
    he_mesh *mesh = NULL;
    he_error err = {0};
    if (he_build(&import->soup, 0, &mesh, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(mesh);
    return mesh;
}

he_mesh *mesh_of_text(const char *format, const char *text)
{
    he_import import = read_text(format, text);
    he_mesh *mesh = build_import(&import);
    he_import_clear(&import);
    return mesh;
}

char *write_encoded(const char *format, const char *encoding, const he_mesh *mesh, size_t size,
                    he_warnings *warnings, size_t *out_length)
{
    he_writer *writer;
    he_error err = {0};
    const he_format *row = he_format_find(format);
    int number = he_format_encoding(row, encoding);
    assert_true(number >= 0);
    if (he_writer_new(row, mesh, (size_t)number, NULL, &writer, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    size_t length = 0, capacity = 1024, n;
    char *text = malloc(capacity), *buffer = malloc(size);
    assert_non_null(text);
    assert_non_null(buffer);
    while ((n = he_writer_read(writer, buffer, size)) > 0) {
        assert_true(n <= size);
        if (length + n + 1 > capacity) {
            capacity = 2 * (length + n + 1);
            text = realloc(text, capacity);
            assert_non_null(text);
        }
        memcpy(text + length, buffer, n);
        length += n;
    }
    assert_int_equal(he_writer_read(writer, buffer, size), 0);
    if (warnings != NULL) {
        *warnings = *he_writer_warnings(writer);
    }
    he_writer_free(writer);
    free(buffer);
    text[length] = '\0';
    *out_length = length;
    return text;
}

char *write_pieces(const char *format, const he_mesh *mesh, size_t size, he_warnings *warnings)
{
    size_t length;
    return write_encoded(format, "ascii", mesh, size, warnings, &length);
}

char *write_bytes(const char *format, const char *encoding, const he_mesh *mesh,
                  he_warnings *warnings, size_t *length)
{
    static const size_t sizes[] = {1, 13, 511, 512, 513, 65536};
    char *bytes = write_encoded(format, encoding, mesh, 4096, warnings, length);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        size_t again;
        char *other = write_encoded(format, encoding, mesh, sizes[i], NULL, &again);
        assert_int_equal(again, *length);
        assert_memory_equal(other, bytes, again);
        free(other);
    }
    return bytes;
}

char *write_text(const char *format, const he_mesh *mesh, he_warnings *warnings)
{
    static const size_t sizes[] = {1, 13, 511, 512, 513, 65536};
    char *text = write_pieces(format, mesh, 4096, warnings);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        char *other = write_pieces(format, mesh, sizes[i], NULL);
        assert_string_equal(other, text);
        free(other);
    }
    return text;
}
