#include "journal/record_bytes.h"

#include "base/siphash.h"
#include "base/utf8.h"
#include "journal/crc32c.h"
#include "stored/bytes.h"

#include <math.h>
#include <string.h>

enum { AT_VERSION = 4, AT_CHAIN = 24 };

enum { BARRIER = 1, TALLY = 2, PARTS = 4, EDIT = 8, ALL_FLAGS = BARRIER | TALLY | PARTS | EDIT };

/* A frame is an encoded record. These are the kinds of elements whose numbers a frame states, in
 * the order in which they are written. */
static const he_kind counted[] = {HE_VERTEX, HE_EDGE, HE_FACE};
enum { COUNTED = sizeof counted / sizeof *counted };

/* Returns true if records of the kind have a name after the names of their operations. */
static bool is_named(st_record_kind kind)
{
    return kind == ST_RECORD_CONTENT || kind == ST_RECORD_RENAME || kind == ST_RECORD_MOMENT;
}

static unsigned version_of(st_record_kind kind)
{
    return kind == ST_RECORD_MOMENT ? 2 : 1;
}

static bool has_body(st_record_kind kind)
{
    return kind == ST_RECORD_CONTENT || kind == ST_RECORD_EDIT;
}

/* --- writing --- */

static unsigned char *put_text(unsigned char *to, const char *text, size_t most)
{
    size_t length = strnlen(text, most);
    return he_put_bytes(he_put_varint(to, length), text, length);
}

static unsigned char *put_tally(unsigned char *to, const uint32_t numbers[COUNTED])
{
    for (size_t i = 0; i < COUNTED; i++) {
        to = he_put_varint(to, numbers[i]);
    }
    return to;
}

size_t st_frame_write(const st_record *r, unsigned char *to)
{
    unsigned flags =
        (r->barrier ? (unsigned)BARRIER : 0U) | (r->tally.known ? (unsigned)TALLY : 0U) |
        (r->stage != NULL ? (unsigned)PARTS : 0U) | (r->staged_edit ? (unsigned)EDIT : 0U);
    unsigned char *at = he_put_u32(to, 0);
    at = he_put_byte(he_put_byte(at, version_of(r->kind)), r->kind);
    at = he_put_byte(he_put_byte(at, flags), 0);
    at = he_put_u64(he_put_u64(at, r->number), r->revision);
    at = he_put_u64(at, 0);
    at = he_put_bytes(at, &r->time, sizeof r->time);
    const bool names = r->kind == ST_RECORD_MOMENT;
    at = he_put_varint(he_put_varint(at, r->metadata), names ? r->named : r->inverts);
    at = he_put_varint(at, r->revision - r->reach);
    for (size_t i = 0; i < COUNTED; i++) {
        at = he_put_varint(at, r->issued[counted[i]]);
    }
    at = he_put_varint(he_put_varint(at, r->counts.vertices), r->counts.edges);
    at = he_put_varint(he_put_varint(at, r->counts.faces), r->counts.boundary);
    at = put_text(he_put_varint(at, r->bytes), r->ops, ST_FRAME_OPS);
    if (is_named(r->kind)) {
        at = put_text(at, names ? r->moment : r->name, names ? ST_MOMENT_NAME : ST_MESH_NAME);
    }
    if (r->tally.known) {
        at = put_tally(put_tally(at, r->tally.created), r->tally.deleted);
        at = put_tally(at, r->tally.modified);
    }
    at = he_put_bytes(at, r->body, r->stage == NULL ? r->body_size : 0);
    return (size_t)(at - to);
}

static uint64_t hash(const void *bytes, size_t size)
{
    static const uint64_t no_key[2] = {0, 0};
    return he_siphash_of(no_key, bytes, size);
}

uint64_t st_chain_of_origin(uint64_t origin)
{
    unsigned char bytes[sizeof origin];
    (void)he_put_u64(bytes, origin);
    return hash(bytes, sizeof bytes);
}

uint64_t st_frame_next_chain(const unsigned char *frame, size_t size)
{
    return hash(frame + AT_VERSION, size - AT_VERSION);
}

uint64_t st_frame_seal(unsigned char *frame, size_t size, uint64_t chain)
{
    (void)he_put_u64(frame + AT_CHAIN, chain);
    (void)he_put_u32(frame, st_crc32c(0, frame + AT_VERSION, size - AT_VERSION));
    return st_frame_next_chain(frame, size);
}

/* --- reading --- */

static bool take_count(he_cursor *c, uint32_t *out)
{
    uint64_t value = 0;
    bool taken = he_take_varint(c, UINT32_MAX, &value);
    *out = (uint32_t)value;
    return taken;
}

static bool take_counts(he_cursor *c, uint32_t out[COUNTED])
{
    return take_count(c, &out[0]) && take_count(c, &out[1]) && take_count(c, &out[2]);
}

static bool take_text(he_cursor *c, char *out, size_t most)
{
    uint64_t length = 0;
    const unsigned char *at = c->at;
    if (he_take_varint(c, most, &length) && he_take_bytes(c, length, out) &&
        memchr(out, '\0', length) == NULL && he_is_utf8(out, length)) {
        out[length] = '\0';
        return true;
    }
    c->at = at;
    return false;
}

static bool take_kind(unsigned char byte, st_record_kind *out)
{
    *out = (st_record_kind)byte;
    return byte >= ST_RECORD_EDIT && byte <= ST_RECORD_MOMENT;
}

static bool take_numbers(he_cursor *c, st_record *r)
{
    uint64_t back = 0;
    bool taken = he_take_varint(c, UINT64_MAX, &r->metadata) &&
                 he_take_varint(c, UINT64_MAX, &r->inverts) &&
                 he_take_varint(c, r->revision, &back);
    r->reach = r->revision - back;
    if (r->kind == ST_RECORD_MOMENT) {
        r->named = r->inverts;
        r->inverts = 0;
    }
    for (size_t i = 0; taken && i < COUNTED; i++) {
        taken = take_count(c, &r->issued[counted[i]]);
    }
    r->issued[HE_HALFEDGE] = 2 * r->issued[HE_EDGE];
    return taken && take_count(c, &r->counts.vertices) && take_count(c, &r->counts.edges) &&
           take_count(c, &r->counts.faces) && take_count(c, &r->counts.boundary) &&
           he_take_varint(c, UINT64_MAX, &r->bytes);
}

/* Reads a frame (encoded record) up to its texts, which are the names of operations and of the
 * mesh. */
static he_status read_head(he_cursor *c, st_frame *out, unsigned *flags, he_error *err)
{
    st_record *r = &out->record;
    unsigned char bytes[4];
    if (!he_take_bytes(c, sizeof bytes, bytes)) {
        return he_refuse_at(c, err, "the record is cut short in its header");
    }
    *flags = bytes[2];
    if (!take_kind(bytes[1], &r->kind) || bytes[0] != version_of(r->kind) ||
        (*flags & ~(unsigned)ALL_FLAGS) != 0 || bytes[3] != 0) {
        c->at -= sizeof bytes - 1;
        return he_refuse_at(
            c, err,
            "the record has an unknown kind or flag, or a kind that its version does not have");
    }
    r->barrier = (*flags & BARRIER) != 0;
    r->tally.known = (*flags & TALLY) != 0;
    out->in_parts = (*flags & PARTS) != 0;
    r->staged_edit = (*flags & EDIT) != 0;
    if (!he_take_u64(c, &r->number) || !he_take_u64(c, &r->revision) ||
        !he_take_u64(c, &out->chain) || !he_take_bytes(c, sizeof r->time, &r->time) ||
        !take_numbers(c, r)) {
        return he_refuse_at(c, err, "the header of the record is cut short");
    }
    if (r->number == 0 || r->revision == 0 || !isfinite(r->time)) {
        return he_refuse_at(c, err, "a number in the header of the record is out of range");
    }
    return HE_OK;
}

static he_status read_rest(he_cursor *c, st_frame *out, he_error *err)
{
    st_record *r = &out->record;
    const size_t most = r->kind == ST_RECORD_MOMENT ? ST_MOMENT_NAME : ST_MESH_NAME;
    if (!take_text(c, out->ops, ST_FRAME_OPS) ||
        (is_named(r->kind) && !take_text(c, out->name, most))) {
        return he_refuse_at(c, err, "a text in the record is cut short, too long or not UTF-8");
    }
    if (r->tally.known && (!take_counts(c, r->tally.created) || !take_counts(c, r->tally.deleted) ||
                           !take_counts(c, r->tally.modified))) {
        return he_refuse_at(c, err, "the totals in the record are cut short");
    }
    if (he_left(c) > 0 && (out->in_parts || !has_body(r->kind))) {
        return he_refuse_at(c, err,
                            "the record has a body, which a record of its kind cannot have");
    }
    if (out->in_parts && !has_body(r->kind)) {
        return he_refuse_at(
            c, err, "the record has its content in parts, but a record of its kind has no content");
    }
    if (r->staged_edit && (!out->in_parts || r->kind != ST_RECORD_EDIT)) {
        return he_refuse_at(c, err,
                            "the record has its body in parts, which only an edit can have");
    }
    r->body = c->at;
    r->body_size = he_left(c);
    return HE_OK;
}

he_status st_frame_read(const unsigned char *bytes, size_t size, st_frame *out, he_error *err)
{
    he_cursor c = he_cursor_over(bytes, size);
    uint32_t sum;
    if (!he_take_u32(&c, &sum) || he_left(&c) == 0) {
        return he_refuse_at(&c, err, "the record is cut short in its header");
    }
    if (st_crc32c(0, c.at, he_left(&c)) != sum) {
        return he_refuse_at(&c, err, "the checksum of the record is wrong");
    }
    if (*c.at == 0 || *c.at > ST_FRAME_VERSION) {
        return *c.at == 0
                   ? he_refuse_at(&c, err, "the record declares a version that no release wrote")
                   : he_fail_at(
                         err, HE_UNSUPPORTED, HE_PLACE_BYTE, AT_VERSION,
                         "the record has version %u, and this release reads up to version %d",
                         *c.at, ST_FRAME_VERSION);
    }
    /* The frame is decoded into a local variable, so that *out is unchanged if decoding fails. */
    st_frame frame = {.record = {.ops = ""}};
    unsigned flags = 0;
    he_status status = read_head(&c, &frame, &flags, err);
    if (status == HE_OK) {
        status = read_rest(&c, &frame, err);
    }
    if (status == HE_OK) {
        *out = frame;
        out->record.ops = out->ops;
        out->record.name = out->name;
        out->record.moment = out->record.kind == ST_RECORD_MOMENT ? out->name : NULL;
    }
    return status;
}
