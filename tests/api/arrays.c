#include "tests/api/arrays.h"

#include "draw/draw_arrays.h"
#include "mesh/walk.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

uint32_t arrays_u32(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

uint64_t arrays_u64(const char *p)
{
    return arrays_u32(p) | (uint64_t)arrays_u32(p + 4) << 32;
}

void arrays_forget(arrays *c)
{
    free(c->rows[VERTEX_PART]);
    free(c->rows[TRIANGLE_PART]);
    *c = (arrays){0};
}

static void grow(arrays *c, int part, uint32_t count)
{
    assert_true(count >= c->count[part]);
    c->rows[part] = realloc(c->rows[part], (size_t)count * ROW + 1);
    assert_non_null(c->rows[part]);
    memset(c->rows[part] + (size_t)c->count[part] * ROW, 0, (size_t)(count - c->count[part]) * ROW);
    c->count[part] = count;
}

static void put_part(arrays *c, int part, const char *at, uint64_t base, uint32_t sent)
{
    if (base == 0) {
        assert_int_equal(sent, c->count[part]);
        memcpy(c->rows[part], at, (size_t)sent * ROW);
        return;
    }
    const char *row = at + (size_t)(sent + 3) / 4 * ROW;
    for (uint32_t i = 0; i < sent; i++) {
        uint32_t place = arrays_u32(at + 4 * (size_t)i);
        assert_true(place < c->count[part]);
        assert_true(i == 0 || place > arrays_u32(at + 4 * (size_t)(i - 1)));
        memcpy(c->rows[part] + (size_t)place * ROW, row + (size_t)i * ROW, ROW);
    }
    for (size_t i = sent; i % 4 != 0; i++) {
        assert_int_equal(arrays_u32(at + 4 * i), 0);
    }
}

void arrays_apply(arrays *c, const char *body, size_t length)
{
    assert_true(length >= HEADER);
    assert_memory_equal(body, "HEDG", 4);
    assert_int_equal(arrays_u32(body + 4), 2);
    uint64_t base = arrays_u64(body + 16), layout = arrays_u64(body + 80);
    uint64_t part[2] = {arrays_u64(body + 24), arrays_u64(body + 32)};
    assert_true(length == HEADER + part[0] + part[1]);
    if (base == 0) {
        arrays fresh = {.whole = c->whole + 1, .changes = c->changes, .bytes = c->bytes};
        arrays_forget(c);
        *c = fresh;
        c->layout = layout;
        memcpy(c->frame, body + 48, sizeof c->frame);
    } else {
        assert_true(base == c->revision && layout == c->layout);
        assert_memory_equal(c->frame, body + 48, sizeof c->frame);
        c->changes++;
        c->bytes += length;
    }
    const char *at = body + HEADER;
    for (int i = 0; i < 2; i++) {
        uint32_t sent = arrays_u32(body + 88 + 4 * i);
        grow(c, i, arrays_u32(body + 40 + 4 * i));
        assert_true(part[i] ==
                    (base == 0 ? 0 : (uint64_t)(sent + 3) / 4 * ROW) + (uint64_t)sent * ROW);
        put_part(c, i, at, base, sent);
        at += part[i];
    }
    c->revision = arrays_u64(body + 8);
}

bench_reply arrays_ask(api_bench *b, const char *mesh, const arrays *c)
{
    char target[200];
    int used = snprintf(target, sizeof target, "/v1/meshes/%s/geometry", mesh);
    if (c->layout != 0) {
        snprintf(target + used, sizeof target - (size_t)used, "?since=%" PRIu64 "&layout=%" PRIu64,
                 c->revision, c->layout);
    }
    return bench_send(b, "GET", target, NULL, NULL);
}

void arrays_update(api_bench *b, const char *mesh, arrays *c)
{
    bench_reply r = arrays_ask(b, mesh, c);
    if (r.status != 200) {
        fail_msg("%d %s", r.status, r.body);
    }
    arrays_apply(c, r.body, r.length);
    bench_reply_free(&r);
}

void arrays_assert_same(const arrays *a, const arrays *b)
{
    assert_true(a->revision == b->revision && a->layout == b->layout);
    assert_memory_equal(a->frame, b->frame, sizeof a->frame);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(a->count[i], b->count[i]);
        assert_memory_equal(a->rows[i], b->rows[i], (size_t)a->count[i] * ROW);
    }
}

/* Checks the arrays of the mesh that a viewer draws: the triangles of each live face must be
 * consecutive and in order, unused entries of the array of triangles must be zeros, and each vertex
 * must have its own entry. */
void arrays_check(const arrays *c, const he_mesh *m)
{
    he_frame frame;
    memcpy(&frame, c->frame, sizeof frame);
    he_draw_arrays d;
    he_draw_arrays_walk walk = {0};
    uint32_t faces = 0;
    assert_int_equal(he_draw_arrays_init(&d, m, &frame, NULL), HE_OK);
    bool *seen = calloc(m->c.faces.issued + 1, sizeof *seen);
    assert_non_null(seen);
    for (uint32_t slot = 0; slot < c->count[TRIANGLE_PART]; slot++) {
        const char *row = c->rows[TRIANGLE_PART] + (size_t)slot * ROW;
        uint32_t words[4] = {arrays_u32(row), arrays_u32(row + 4), arrays_u32(row + 8),
                             arrays_u32(row + 12)};
        if (words[0] == words[1]) {
            assert_true((words[0] | words[2] | words[3]) == 0 && walk.left == 0);
            continue;
        }
        uint32_t face = words[3] & ((1u << HE_DRAWN_SIDES) - 1), wanted[HE_DRAWN_ROW];
        if (walk.left == 0) {
            assert_true(he_face_is_live(m, (he_face){face}) && !seen[face]);
            seen[face] = true;
            faces++;
            he_draw_arrays_begin(&d, face, &walk);
        }
        assert_true(he_draw_arrays_next(&d, &walk, wanted));
        assert_memory_equal(wanted, words, sizeof words);
    }
    assert_true(walk.left == 0);
    assert_int_equal(faces, he_mesh_faces(m));
    assert_int_equal(c->count[VERTEX_PART], he_mesh_issued(m, HE_VERTEX));
    for (uint32_t v = 0; v < c->count[VERTEX_PART]; v++) {
        float row[HE_DRAWN_ROW];
        he_draw_arrays_vertex(&d, v, row);
        assert_memory_equal(row, c->rows[VERTEX_PART] + (size_t)v * ROW, ROW);
        assert_true(row[0] * row[0] + row[1] * row[1] + row[2] * row[2] <= 1.000001f);
    }
    free(seen);
    he_draw_arrays_clear(&d);
}
