#include "api/header/kept.h"

#include "api/header/compression.h"
#include "base/mem.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum {
    TAG = 24,
    /* A level above 9 takes several times as long to save two percent more. */
    ZSTD_LEVEL = 9
};

/* A body compressed with one content coding. */
typedef struct form {
    size_t length;
    char bytes[];
} form;

struct api_kept {
    /* The compressed forms of the body, indexed by coding; NULL: not made yet. */
    _Atomic(form *) forms[API_IDENTITY];
    char etag[TAG];
    size_t length;
    char bytes[];
};

/* Returns the hash FNV-1a (Fowler, Noll, Vo) of the bytes. It is used for the entity tag, which
 * need not resist attackers. */
static uint64_t hash(const char *bytes, size_t length)
{
    uint64_t value = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < length; i++) {
        value = (value ^ (unsigned char)bytes[i]) * UINT64_C(0x100000001b3);
    }
    return value;
}

api_kept *api_kept_new(const char *bytes, size_t length)
{
    api_kept *kept = he_mem_alloc(sizeof *kept + length);
    if (kept == NULL) {
        return NULL;
    }
    for (int i = 0; i < API_IDENTITY; i++) {
        atomic_init(&kept->forms[i], NULL);
    }
    snprintf(kept->etag, sizeof kept->etag, "\"%016" PRIx64 "\"", hash(bytes, length));
    kept->length = length;
    memcpy(kept->bytes, bytes, length);
    return kept;
}

void api_kept_free(api_kept *kept)
{
    for (int i = 0; kept != NULL && i < API_IDENTITY; i++) {
        he_mem_free(atomic_load(&kept->forms[i]));
    }
    he_mem_free(kept);
}

void api_kept_bytes(const api_kept *kept, const char **bytes, size_t *length)
{
    *bytes = kept->bytes;
    *length = kept->length;
}

const char *api_kept_etag(const api_kept *kept)
{
    return kept->etag;
}

/* The functions pack_gzip and pack_zstd compress the body to out->bytes, which has `room` bytes.
 * They return false when memory is out. */
static bool pack_gzip(const api_kept *kept, form *out, size_t room)
{
    z_stream z;
    api_compression_zlib(&z, NULL);
    if (deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS + 16, MAX_MEM_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
        return false;
    }
    z.next_in = (z_const Bytef *)kept->bytes;
    z.avail_in = (uInt)kept->length;
    z.next_out = (Bytef *)out->bytes;
    z.avail_out = (uInt)room;
    const bool ok = deflate(&z, Z_FINISH) == Z_STREAM_END;
    out->length = room - z.avail_out;
    deflateEnd(&z);
    return ok;
}

static bool pack_zstd(const api_kept *kept, form *out, size_t room)
{
    ZSTD_CCtx *zstd = ZSTD_createCCtx_advanced(api_compression_zstd(NULL));
    out->length = SIZE_MAX;
    if (zstd != NULL &&
        !ZSTD_isError(ZSTD_CCtx_setParameter(zstd, ZSTD_c_compressionLevel, ZSTD_LEVEL)) &&
        !ZSTD_isError(ZSTD_CCtx_setParameter(zstd, ZSTD_c_checksumFlag, 1))) {
        out->length = ZSTD_compress2(zstd, out->bytes, room, kept->bytes, kept->length);
    }
    ZSTD_freeCCtx(zstd);
    return !ZSTD_isError(out->length);
}

/* Returns the body compressed, or NULL when memory is out. */
static form *make_form(const api_kept *kept, api_coding coding)
{
    /* The size of the buffer: more than zlib or zstd needs in the worst case. */
    const size_t room = kept->length + kept->length / 4 + 512;
    form *made = he_mem_alloc(sizeof *made + room);
    const bool ok = made != NULL && (coding == API_GZIP ? pack_gzip(kept, made, room)
                                                        : pack_zstd(kept, made, room));
    if (!ok) {
        he_mem_free(made);
        return NULL;
    }
    return he_mem_shrink(made, sizeof *made + made->length);
}

bool api_kept_coded(api_kept *kept, api_coding coding, const char **bytes, size_t *length)
{
    form *found = atomic_load(&kept->forms[coding]);
    if (found == NULL) {
        form *made = make_form(kept, coding);
        if (made == NULL) {
            return false;
        }
        /* If another thread was faster, `found` now points to the form that the other thread made;
         * that form is sent. */
        if (atomic_compare_exchange_strong(&kept->forms[coding], &found, made)) {
            found = made;
        } else {
            he_mem_free(made);
        }
    }
    *bytes = found->bytes;
    *length = found->length;
    return true;
}
