#include "api/header/kept.h"

#include "api/header/compressor.h"
#include "base/mem.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { TAG = 24 };

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

/* Returns the body compressed, or NULL when memory is out. */
static form *compress(const api_kept *kept, api_coding coding)
{
    /* The size of the buffer: more than zlib or zstd needs in the worst case. */
    const size_t room = kept->length + kept->length / 4 + 512;
    const api_plain plain = {.bytes = kept->bytes, .length = kept->length};
    form *made = he_mem_alloc(sizeof *made + room);
    api_compressor *compressor = api_compressor_new(coding, &plain);
    bool ok = made != NULL && compressor != NULL && api_compressor_begin(compressor);
    int64_t got = ok ? 1 : 0;
    for (size_t at = 0; ok && got > 0; at += (size_t)got) {
        got = api_compressor_read(compressor, made->bytes + at, room - at);
        made->length = at;
        ok = got >= 0;
    }
    api_compressor_free(compressor);
    form *fitted = ok ? he_mem_resize(made, sizeof *made + made->length) : NULL;
    if (fitted == NULL) {
        he_mem_free(made);
    }
    return fitted;
}

bool api_kept_coded(api_kept *kept, api_coding coding, const char **bytes, size_t *length)
{
    form *found = atomic_load(&kept->forms[coding]);
    if (found == NULL) {
        form *made = compress(kept, coding);
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
