/* Parts of meshes as a store compresses them (core/journal/part_packing.h). Any bytes must be
 * decompressed to at most the size of one part or be refused with a reason; the same must hold if
 * the bytes follow the header of a zstd frame of any length. Bytes that were compressed must be
 * unchanged after decompression. */
#include "fuzz/fuzz.h"

#include "journal/part_packing.h"
#include "stored/stored.h"

#include <stdlib.h>
#include <string.h>

/* Compresses a part, which may also be left as it is, and decompresses it again. */
static void pack(st_unpacker *unpacker, const uint8_t *bytes, size_t size)
{
    unsigned char *part = malloc(HE_STORED_PART_ROOM);
    unsigned coding = HE_CODING_PLAIN;
    st_packer *packer = st_packer_new();
    FUZZ_REQUIRE(part != NULL && packer != NULL, "no memory");
    memcpy(part, bytes, size);
    const size_t packed = st_part_pack(packer, part, size, &coding);
    if (coding == HE_CODING_PLAIN) {
        FUZZ_REQUIRE(packed == size && memcmp(part, bytes, size) == 0, "a plain part has changed");
    } else {
        st_part out = {0};
        const char *why;
        FUZZ_REQUIRE(packed < size, "%zu bytes are packed into %zu", size, packed);
        FUZZ_REQUIRE(st_part_unpack(unpacker, (st_part){part, packed}, &out, &why) == ST_OK &&
                         out.size == size && memcmp(out.bytes, bytes, size) == 0,
                     "a part comes back as another");
    }
    st_packer_free(packer);
    free(part);
}

static void unpack(st_unpacker *unpacker, const uint8_t *bytes, size_t size)
{
    st_part out = {0};
    const char *why = NULL;
    const st_status status = st_part_unpack(unpacker, (st_part){bytes, size}, &out, &why);
    FUZZ_REQUIRE(status == ST_OK || (status == ST_DAMAGED && why[0] != '\0'), "refused with %d",
                 (int)status);
    if (status == ST_OK) {
        FUZZ_REQUIRE(out.size <= HE_STORED_PART_ROOM, "a part of %zu bytes", out.size);
        /* The next call of unpack would overwrite the output, so it is copied. */
        unsigned char *copy = malloc(out.size + 1);
        FUZZ_REQUIRE(copy != NULL, "no memory");
        memcpy(copy, out.bytes, out.size);
        pack(unpacker, copy, out.size);
        free(copy);
    }
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    st_unpacker *unpacker = st_unpacker_new();
    FUZZ_REQUIRE(unpacker != NULL, "no memory");
    unpack(unpacker, bytes, size);
    pack(unpacker, bytes, size < HE_STORED_PART_ROOM ? size : HE_STORED_PART_ROOM);
    st_unpacker_free(unpacker);
}
