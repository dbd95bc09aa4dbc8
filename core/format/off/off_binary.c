#include "format/off/off_binary.h"

#include <math.h>
#include <string.h>

/* Sizes in bytes. The shortest face is a triangle: five words of 32 bits for its degree, three
 * corners, and the number of numbers in its colour. */
enum { WORD = 4, SHORTEST_FACE = 5 * WORD };

static size_t vertex_numbers(const he_off_binary *b)
{
    return 3u + ((b->has & HE_OFF_NORMALS) != 0 ? 3u : 0u) +
           ((b->has & HE_OFF_COLORS) != 0 ? 4u : 0u) + ((b->has & HE_OFF_UV) != 0 ? 2u : 0u);
}

void he_off_binary_init(he_off_binary *binary, he_off_values *values, unsigned has, uint64_t offset)
{
    *binary = (he_off_binary){.values = values, .has = has, .offset = offset};
    values->vertex_colors.fractions = values->face_colors.fractions = true;
    he_source_map_init(&values->into->vertices, HE_PLACE_BYTE,
                       (uint32_t)vertex_numbers(binary) * WORD);
    he_source_map_init(&values->into->faces, HE_PLACE_BYTE, SHORTEST_FACE);
    he_warnings_add(&values->into->warnings,
                    &(he_occurrence){.code = "binary_off",
                                     .text = "the body of the file is read as big-endian binary "
                                             "numbers, because the header says BINARY",
                                     .place = HE_PLACE_BYTE,
                                     .at = offset});
}

static uint32_t word_at(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* Returns the offset in the input of the part that was just read, which has `size` bytes. */
static uint64_t begin_of(const he_off_binary *b, size_t size)
{
    return b->offset - size;
}

/* Returns a number of the input. In place of a number that is not finite, returns 0 and adds a
 * warning. */
static double value_at(const he_off_binary *b, const unsigned char *p, uint64_t at)
{
    uint32_t bits = word_at(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value)) {
        he_warnings_add(
            &b->values->into->warnings,
            &(he_occurrence){.code = "not_finite",
                             .text = "a number of the file is read as 0, because it is not finite",
                             .place = HE_PLACE_BYTE,
                             .at = at});
        return 0;
    }
    return (double)value;
}

static he_status take_count(const unsigned char *p, const char *what, uint64_t limit, uint64_t at,
                            uint64_t *out, he_error *err)
{
    uint32_t count = word_at(p);
    if (count > HE_MAX_ROWS) {
        return he_fail_at(err, HE_BAD_VALUE, HE_PLACE_BYTE, at,
                          "the file declares %u %s, more than a mesh can have", count, what);
    }
    if (limit != 0 && count > limit) {
        return he_fail_at(err, HE_LIMIT, HE_PLACE_BYTE, at,
                          "the file declares %u %s, more than the limit of %llu", count, what,
                          (unsigned long long)limit);
    }
    *out = count;
    return HE_OK;
}

static void begin_faces(he_off_binary *b)
{
    b->part = b->faces > 0 ? HE_OFF_DEGREE : HE_OFF_END;
}

/* Reads the numbers of vertices and faces. The number of edges is ignored, because it is often
 * wrong. */
static he_status take_counts(he_off_binary *b, const unsigned char *p, he_error *err)
{
    he_import *into = b->values->into;
    uint64_t at = begin_of(b, 3 * WORD);
    he_status status = take_count(p, "vertices", into->soup.limits.vertices, at, &b->vertices, err);
    if (status == HE_OK) {
        status = take_count(p + WORD, "faces", into->soup.limits.faces, at + WORD, &b->faces, err);
    }
    b->part = HE_OFF_VERTEX;
    if (b->vertices == 0) {
        begin_faces(b);
    }
    return status;
}

static he_status take_position(he_off_binary *b, const unsigned char *p, uint64_t at, he_error *err)
{
    he_soup *soup = &b->values->into->soup;
    float xyz[3];
    for (size_t i = 0; i < 3; i++) {
        uint32_t bits = word_at(p + i * WORD);
        memcpy(&xyz[i], &bits, sizeof bits);
    }
    he_status status =
        he_source_map_add(&b->values->into->vertices, (uint32_t)soup->vertex_count, at, err);
    return status == HE_OK ? he_soup_add_vertex(soup, (he_vec3){xyz[0], xyz[1], xyz[2]}, err)
                           : status;
}

static he_status take_vertex(he_off_binary *b, const unsigned char *p, he_error *err)
{
    const he_soup *soup = &b->values->into->soup;
    size_t count = vertex_numbers(b), next = 3;
    uint64_t at = begin_of(b, count * WORD);
    double n[HE_OFF_LONGEST / WORD] = {0};
    he_status status = take_position(b, p, at, err);
    for (size_t i = 3; i < count && status == HE_OK; i++) {
        n[i] = value_at(b, p + i * WORD, at + i * WORD);
    }
    if (status == HE_OK && (b->has & HE_OFF_NORMALS) != 0) {
        status = he_off_add_normal(b->values, n + next, err);
        next += 3;
    }
    if (status == HE_OK && (b->has & HE_OFF_COLORS) != 0) {
        status = he_colors_add(&b->values->vertex_colors, soup->vertex_count - 1, n + next, 4, err);
        next += 4;
    }
    if (status == HE_OK && (b->has & HE_OFF_UV) != 0) {
        status = he_off_add_uv(b->values, n + next, err);
    }
    if (soup->vertex_count == b->vertices) {
        begin_faces(b);
    }
    return status;
}

static he_status take_degree(he_off_binary *b, const unsigned char *p, he_error *err)
{
    he_soup *soup = &b->values->into->soup;
    uint64_t count = 0, at = begin_of(b, WORD);
    he_status status = take_count(p, "corners in a face", soup->limits.corners, at, &count, err);
    if (status == HE_OK) {
        status = he_source_map_add(&b->values->into->faces, (uint32_t)soup->face_count, at, err);
    }
    b->left = (uint32_t)count;
    b->part = count > 0 ? HE_OFF_CORNER : HE_OFF_COLOR_COUNT;
    return status == HE_OK ? he_soup_begin_face(soup, err) : status;
}

static he_status take_corner(he_off_binary *b, const unsigned char *p, he_error *err)
{
    uint32_t vertex = word_at(p);
    if (vertex >= b->vertices) {
        return he_fail_at(err, HE_BAD_INDEX, HE_PLACE_BYTE, begin_of(b, WORD),
                          "there is no vertex %lld; the vertices are 0 to %lld",
                          (long long)(int32_t)vertex, (long long)b->vertices - 1);
    }
    b->part = --b->left > 0 ? HE_OFF_CORNER : HE_OFF_COLOR_COUNT;
    return he_soup_add_corner(&b->values->into->soup, vertex, err);
}

static void end_face(he_off_binary *b)
{
    b->part = b->values->into->soup.face_count < b->faces ? HE_OFF_DEGREE : HE_OFF_END;
}

static he_status take_color_count(he_off_binary *b, const unsigned char *p, he_error *err)
{
    uint64_t count = 0, at = begin_of(b, WORD);
    he_status status = take_count(p, "numbers of a colour", 0, at, &count, err);
    if (status == HE_OK && count != 0 && count != 3 && count != 4) {
        he_warnings_add(&b->values->into->warnings,
                        &(he_occurrence){.code = "extra_numbers",
                                         .text = "numbers after the corners of a face are ignored, "
                                                 "because a colour has 3 or 4 numbers",
                                         .place = HE_PLACE_BYTE,
                                         .at = at});
    }
    b->left = b->color_count = (uint32_t)count;
    b->part = HE_OFF_COLOR;
    if (count == 0) {
        end_face(b);
    }
    return status;
}

static he_status take_color(he_off_binary *b, const unsigned char *p, he_error *err)
{
    uint32_t i = b->color_count - b->left--;
    bool is_color = b->color_count == 3 || b->color_count == 4;
    if (is_color) {
        b->color[i] = value_at(b, p, begin_of(b, WORD));
    }
    if (b->left > 0) {
        return HE_OK;
    }
    end_face(b);
    return is_color ? he_colors_add(&b->values->face_colors, b->values->into->soup.face_count - 1,
                                    b->color, b->color_count, err)
                    : HE_OK;
}

static he_status take_part(he_off_binary *b, const unsigned char *p, he_error *err)
{
    switch (b->part) {
    case HE_OFF_COUNTS:
        return take_counts(b, p, err);
    case HE_OFF_VERTEX:
        return take_vertex(b, p, err);
    case HE_OFF_DEGREE:
        return take_degree(b, p, err);
    case HE_OFF_CORNER:
        return take_corner(b, p, err);
    case HE_OFF_COLOR_COUNT:
        return take_color_count(b, p, err);
    case HE_OFF_COLOR:
        return take_color(b, p, err);
    case HE_OFF_END:
        break;
    }
    return HE_OK;
}

static size_t size_of(const he_off_binary *b)
{
    switch (b->part) {
    case HE_OFF_COUNTS:
        return 3 * (size_t)WORD;
    case HE_OFF_VERTEX:
        return vertex_numbers(b) * WORD;
    case HE_OFF_DEGREE:
    case HE_OFF_CORNER:
    case HE_OFF_COLOR_COUNT:
    case HE_OFF_COLOR:
    case HE_OFF_END:
        break;
    }
    return WORD;
}

/* Handles bytes after the last face. A few are ignored, but as many as the shortest face has mean
 * that the number of faces in the header is wrong. */
static he_status take_trailing(he_off_binary *b, size_t n, he_error *err)
{
    if (b->trailing == 0) {
        he_warnings_add(&b->values->into->warnings,
                        &(he_occurrence){.code = "trailing_bytes",
                                         .text = "bytes after the last face are ignored, because "
                                                 "the header declares no more faces",
                                         .place = HE_PLACE_BYTE,
                                         .at = b->offset});
    }
    b->trailing += n;
    b->offset += n;
    return b->trailing < SHORTEST_FACE
               ? HE_OK
               : he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, b->offset - b->trailing,
                            "the file has more than the %llu faces that it declares",
                            (unsigned long long)b->faces);
}

he_status he_off_binary_feed(he_off_binary *binary, const unsigned char *bytes, size_t n,
                             he_error *err)
{
    he_off_binary *b = binary;
    const unsigned char *p = bytes, *end = bytes + n;
    he_status status = HE_OK;
    while (p < end && status == HE_OK) {
        if (b->part == HE_OFF_END) {
            return take_trailing(b, (size_t)(end - p), err);
        }
        size_t size = size_of(b), part = size - b->held_count;
        const unsigned char *whole = p;
        part = part < (size_t)(end - p) ? part : (size_t)(end - p);
        if (part < size) {
            memcpy(b->held + b->held_count, p, part);
            b->held_count += part;
            whole = b->held;
        }
        p += part;
        b->offset += part;
        if (part == size || b->held_count == size) {
            b->held_count = 0;
            status = take_part(b, whole, err);
        }
        if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
            err->place = HE_PLACE_BYTE;
            err->at = begin_of(b, size);
        }
    }
    return status;
}

static he_status too_short(const he_off_binary *b, const char *what, size_t came,
                           uint64_t announced, he_error *err)
{
    return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, b->offset,
                      "the file ends after %zu of the %llu %s that it declares", came,
                      (unsigned long long)announced, what);
}

he_status he_off_binary_finish(he_off_binary *binary, he_error *err)
{
    const he_soup *soup = &binary->values->into->soup;
    switch (binary->part) {
    case HE_OFF_COUNTS:
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, binary->offset,
                          "the file ends before its counts of vertices, faces and edges");
    case HE_OFF_VERTEX:
        return too_short(binary, "vertices", soup->vertex_count, binary->vertices, err);
    case HE_OFF_DEGREE:
        return too_short(binary, "faces", soup->face_count, binary->faces, err);
    case HE_OFF_CORNER:
    case HE_OFF_COLOR_COUNT:
    case HE_OFF_COLOR:
        return too_short(binary, "faces", soup->face_count - 1, binary->faces, err);
    case HE_OFF_END:
        break;
    }
    return he_off_values_finish(binary->values, err);
}
