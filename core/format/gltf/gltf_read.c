#include "format/gltf/gltf.h"

#include "format/gltf/gltf_scene.h"

#include <string.h>

enum { HEADER = 12, CHUNK = 8 };

static const uint32_t JSON_CHUNK = 0x4E4F534A, BIN_CHUNK = 0x004E4942;

/* A chunk of bytes that is kept as a whole, because its contents are read in any order. */
typedef struct block {
    char *bytes;
    size_t length, capacity;
    uint64_t place;
} block;

typedef struct glb {
    he_import *into;
    unsigned char head[HEADER]; /* the first bytes of a header (of the file or a chunk) that is not
                                   complete yet */
    size_t head_length;
    uint64_t offset; /* offset of the next byte */
    uint64_t length; /* length of the file, as its header says */
    uint64_t left;   /* number of bytes of the present chunk that are still to come */
    size_t chunks;   /* number of chunks that have begun */
    /* The number of bytes of padding that may follow a chunk whose length is no multiple of 4. */
    size_t padding;
    bool begun, has_bin;
    block json, bin;
    block *chunk; /* where the bytes of the present chunk are stored; NULL if they are ignored */
} glb;

/* Appends bytes to a block. `most` is the largest size that the block will ever have, `limit` the
 * largest that it may have (0 for no limit). */
static he_status keep(block *b, const void *bytes, size_t n, uint64_t most, uint64_t limit,
                      he_error *err)
{
    if (limit != 0 && b->length + n > limit) {
        return he_fail_plain(err, HE_LIMIT, "the file needs more than %llu bytes of memory",
                             (unsigned long long)limit);
    }
    if (b->capacity - b->length < n) {
        size_t capacity = he_mem_grown(b->capacity, b->length + n);
        capacity = capacity > most ? (size_t)most : capacity;
        char *grown = he_mem_resize(b->bytes, capacity);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu bytes of the file",
                                 capacity);
        }
        b->bytes = grown;
        b->capacity = capacity;
    }
    memcpy(b->bytes + b->length, bytes, n);
    b->length += n;
    return HE_OK;
}

static void forget(block *b)
{
    he_mem_free(b->bytes);
    *b = (block){0};
}

static he_status read_asset(he_import *into, const block *json, const block *bin, bool has_bin,
                            he_error *err)
{
    static const unsigned char nothing[1];
    he_gltf asset;
    he_gltf_bin chunk = {NULL, bin->length, bin->place};
    if (has_bin) {
        chunk.bytes = bin->bytes == NULL ? nothing : (const unsigned char *)bin->bytes;
    }
    const he_gltf_text text = {json->bytes == NULL ? "" : json->bytes, json->length, json->place};
    he_status status = he_gltf_open(&asset, into, &text, &chunk, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_gltf_read_scene(&asset, err);
    he_gltf_close(&asset);
    return status;
}

/* --- the container --- */

static uint32_t word_at(const unsigned char *p)
{
    return (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

static he_status take_header(glb *g, he_error *err)
{
    const unsigned char *p = g->head;
    uint32_t version = word_at(p + 4);
    g->length = word_at(p + 8);
    g->begun = true;
    if (memcmp(p, "glTF", 4) != 0) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, 0,
                          "not a GLB file: it does not begin with \"glTF\"");
    }
    if (version != 2) {
        return he_fail_at(err, HE_UNSUPPORTED, HE_PLACE_BYTE, 4,
                          "the version of the GLB file is %u, not 2", version);
    }
    if (g->length < HEADER + CHUNK) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, 8,
                          "a GLB file of %llu bytes cannot hold a chunk",
                          (unsigned long long)g->length);
    }
    return HE_OK;
}

/* Skips padding. After a chunk whose length is no multiple of 4, the next chunk follows directly,
 * or after padding. If the bytes that were read as the header of a chunk begin with padding, it is
 * removed from them and the function returns true: the rest of the header is still to come. */
static bool skip_padding(glb *g)
{
    size_t n = g->padding;
    g->padding = 0;
    if (n == 0 || word_at(g->head + 4) == BIN_CHUNK ||
        (memcmp(g->head, "   ", n) != 0 && memcmp(g->head, "\0\0\0", n) != 0)) {
        return false;
    }
    g->head_length -= n;
    g->offset += n;
    memmove(g->head, g->head + n, g->head_length);
    return true;
}

static he_status take_chunk(glb *g, he_error *err)
{
    uint64_t at = g->offset - CHUNK;
    uint32_t type = word_at(g->head + 4);
    g->left = word_at(g->head);
    size_t number = g->chunks++;
    if (g->left > g->length - g->offset) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, at,
                          "a chunk declares %llu bytes, but only %llu bytes of the file follow",
                          (unsigned long long)g->left, (unsigned long long)(g->length - g->offset));
    }
    if (g->left % 4 != 0) {
        he_warnings_add(
            &g->into->warnings,
            &(he_occurrence){.code = "unaligned_chunk",
                             .text = "a chunk is read, although its length is not a multiple of 4",
                             .place = HE_PLACE_BYTE,
                             .at = at});
        g->padding = 4 - g->left % 4;
    }
    if ((type == JSON_CHUNK) != (number == 0)) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, at + 4,
                          number == 0 ? "the first chunk is not \"JSON\""
                                      : "there is a second JSON chunk");
    }
    if (type == BIN_CHUNK && number != 1) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, at + 4,
                          "a BIN chunk must be the second chunk");
    }
    g->chunk = type == JSON_CHUNK ? &g->json : type == BIN_CHUNK ? &g->bin : NULL;
    g->has_bin |= type == BIN_CHUNK;
    if (g->chunk != NULL) {
        g->chunk->place = g->offset;
    } else {
        he_warnings_add(
            &g->into->warnings,
            &(he_occurrence){.code = "ignored_chunk",
                             .text = "a chunk is ignored, because it is neither JSON nor BIN",
                             .place = HE_PLACE_BYTE,
                             .at = at});
    }
    return HE_OK;
}

static he_status take_rest(glb *g, const unsigned char *p, size_t n, he_error *err)
{
    he_status status = HE_OK;
    if (g->chunk != NULL) {
        status = keep(g->chunk, p, n, g->chunk->length + g->left, g->into->soup.limits.bytes, err);
        if (status != HE_OK && err != NULL) {
            err->place = HE_PLACE_BYTE;
            err->at = g->offset;
        }
    }
    g->left -= n;
    g->offset += n;
    return status;
}

static he_status glb_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    glb *g = state;
    const unsigned char *p = bytes, *end = p + n;
    he_status status = HE_OK;
    while (p < end && status == HE_OK) {
        size_t there = (size_t)(end - p);
        if (g->left > 0) {
            size_t part = there < g->left ? there : (size_t)g->left;
            status = take_rest(g, p, part, err);
            p += part;
            continue;
        }
        if (g->begun && g->offset + g->head_length == g->length) {
            return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, g->length,
                              "the file is longer than the %llu bytes that its header declares",
                              (unsigned long long)g->length);
        }
        size_t size = g->begun ? CHUNK : HEADER, part = size - g->head_length;
        uint64_t inside = g->begun ? g->length - g->offset - g->head_length : HEADER;
        part = part < inside ? part : (size_t)inside;
        part = there < part ? there : part;
        memcpy(g->head + g->head_length, p, part);
        g->head_length += part;
        p += part;
        if (g->head_length == size && !(g->begun && skip_padding(g))) {
            g->offset += size;
            g->head_length = 0;
            status = g->begun ? take_chunk(g, err) : take_header(g, err);
        }
    }
    return status;
}

static he_status glb_finish(void *state, he_error *err)
{
    glb *g = state;
    uint64_t at = g->offset + g->head_length;
    if (!g->begun) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, at,
                          "not a GLB file: it ends inside its header of 12 bytes");
    }
    if (at < g->length) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, at,
                          "the file is shorter than the %llu bytes that its header declares",
                          (unsigned long long)g->length);
    }
    if (g->head_length > 0 && g->head_length != g->padding) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, g->offset,
                          "%zu bytes follow the last chunk, which are too few for another chunk",
                          g->head_length);
    }
    he_status status = read_asset(g->into, &g->json, &g->bin, g->has_bin, err);
    forget(&g->json);
    forget(&g->bin);
    return status;
}

static void glb_close(void *state)
{
    glb *g = state;
    forget(&g->json);
    forget(&g->bin);
    he_mem_free(g);
}

static he_status glb_open(he_import *into, void **state, he_error *err)
{
    glb *g = he_mem_zero(1, sizeof *g);
    if (g == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the GLB file");
    }
    g->into = into;
    *state = g;
    return HE_OK;
}

const he_reading he_glb_reading = {glb_open, glb_feed, glb_finish, glb_close, true};

bool he_glb_sniff(const char *bytes, size_t n)
{
    return n >= 4 && memcmp(bytes, "glTF", 4) == 0;
}

/* --- JSON alone --- */

typedef struct text {
    he_import *into;
    block json;
} text;

static he_status gltf_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    text *t = state;
    he_status status = keep(&t->json, bytes, n, SIZE_MAX, t->into->soup.limits.bytes, err);
    if (status != HE_OK && err != NULL) {
        err->place = HE_PLACE_BYTE;
        err->at = t->json.length;
    }
    return status;
}

static he_status gltf_finish(void *state, he_error *err)
{
    text *t = state;
    he_status status = read_asset(t->into, &t->json, &(block){0}, false, err);
    forget(&t->json);
    return status;
}

static void gltf_close(void *state)
{
    text *t = state;
    forget(&t->json);
    he_mem_free(t);
}

static he_status gltf_open(he_import *into, void **state, he_error *err)
{
    text *t = he_mem_zero(1, sizeof *t);
    if (t == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the glTF file");
    }
    t->into = into;
    *state = t;
    return HE_OK;
}

const he_reading he_gltf_reading = {gltf_open, gltf_feed, gltf_finish, gltf_close, true};

/* Returns true if the bytes begin with a JSON object that has a member "asset", which is near the
 * beginning of nearly all glTF files. */
bool he_gltf_sniff(const char *bytes, size_t n)
{
    static const char member[] = "\"asset\"";
    const char *p = bytes, *end = bytes + n;
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n')) {
        p++;
    }
    if (p == end || *p != '{') {
        return false;
    }
    for (; (size_t)(end - p) >= sizeof member - 1; p++) {
        if (memcmp(p, member, sizeof member - 1) == 0) {
            return true;
        }
    }
    return false;
}
