/* A record of the store, such as an edit, as bytes (core/journal/record_bytes.h). Few inputs have
 * the correct checksum by chance, so the bytes are read as they are and once more with the checksum
 * corrected. A record that can be read must be written again as the same bytes. */
#include "fuzz/fuzz.h"

#include "journal/record_bytes.h"

#include <stdlib.h>
#include <string.h>

static void write_again(const st_frame *frame, const uint8_t *bytes, size_t size)
{
    unsigned char *again = malloc(ST_FRAME_HEAD + frame->record.body_size);
    st_record record = frame->record;
    /* A dummy for a stage (data of a mesh that was written in advance). The writer only compares
     * the pointer with NULL. */
    record.stage = frame->in_parts ? (st_stage *)again : NULL;
    size_t written = st_frame_write(&record, again);
    FUZZ_REQUIRE(written <= ST_FRAME_HEAD + record.body_size, "a frame of %zu bytes", written);
    st_frame_seal(again, written, frame->chain);
    FUZZ_REQUIRE(written == size && memcmp(again, bytes, size) == 0,
                 "the record comes back as another");
    free(again);
}

static void read_frame(const uint8_t *bytes, size_t size)
{
    st_frame frame;
    he_error err = {.status = HE_OK};
    he_status status = st_frame_read(bytes, size, &frame, &err);
    if (status == HE_OK) {
        write_again(&frame, bytes, size);
        return;
    }
    FUZZ_REQUIRE((status == HE_CORRUPT || status == HE_UNSUPPORTED) && err.status == status &&
                     err.place == HE_PLACE_BYTE && err.at <= size && err.text[0] != '\0',
                 "refused with %d and \"%s\"", (int)status, err.text);
}

enum { CHAIN_AT = 24, CHAIN_END = 32 };

void fuzz_one(const uint8_t *bytes, size_t size)
{
    read_frame(bytes, size);
    if (size < CHAIN_END) {
        return;
    }
    unsigned char *mended = malloc(size);
    uint64_t chain;
    memcpy(mended, bytes, size);
    memcpy(&chain, mended + CHAIN_AT, sizeof chain);
    st_frame_seal(mended, size, chain);
    read_frame(mended, size);
    free(mended);
}
