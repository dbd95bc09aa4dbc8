#include "tests/codings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <zlib.h>
#include <zstd.h>

char *coding_pack(const char *coding, const void *bytes, size_t length, size_t *packed)
{
    bool gzip = strcmp(coding, "gzip") == 0;
    z_stream z = {.next_in = (z_const Bytef *)bytes, .avail_in = (unsigned)length};
    if (gzip) {
        assert_int_equal(deflateInit2(&z, 6, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    }
    size_t room = gzip ? deflateBound(&z, length) : ZSTD_compressBound(length);
    char *out = malloc(room);
    assert_non_null(out);
    if (gzip) {
        z.next_out = (Bytef *)out;
        z.avail_out = (unsigned)room;
        assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
        *packed = room - z.avail_out;
        deflateEnd(&z);
    } else {
        *packed = ZSTD_compress(out, room, bytes, length, 3);
        assert_false(ZSTD_isError(*packed));
    }
    return out;
}

static bool unpack_gzip(z_stream *z, char *out, size_t room)
{
    z->next_out = (Bytef *)out;
    z->avail_out = (unsigned)room;
    return inflate(z, Z_FINISH) == Z_STREAM_END && z->avail_in == 0;
}

char *coding_unpack(const char *coding, const void *bytes, size_t length, size_t *plain)
{
    bool gzip = strcmp(coding, "gzip") == 0;
    for (size_t room = 8 * length + 4096; room < (size_t)1 << 32; room *= 4) {
        char *out = malloc(room + 1);
        assert_non_null(out);
        bool good;
        if (gzip) {
            z_stream z = {.next_in = (z_const Bytef *)bytes, .avail_in = (unsigned)length};
            assert_int_equal(inflateInit2(&z, 31), Z_OK);
            good = unpack_gzip(&z, out, room);
            *plain = room - z.avail_out;
            inflateEnd(&z);
        } else {
            *plain = ZSTD_decompress(out, room, bytes, length);
            good = !ZSTD_isError(*plain);
        }
        if (good) {
            out[*plain] = '\0';
            return out;
        }
        free(out);
        if (room > 2000 * length + 100000) {
            break;
        }
    }
    return NULL;
}
