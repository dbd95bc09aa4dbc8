/* part_packing.h - compresses the parts of stored meshes by zstd (HE_CODING_PACKED of stored.h).
 *
 * In each part, links (ids) are first coded as differences; then the part is compressed by itself
 * at level 1, as one zstd frame that states its uncompressed size. So a part can be read without
 * the parts before it, and reading one never takes more memory than the longest possible part. */
#ifndef HE_JOURNAL_PART_PACKING_H
#define HE_JOURNAL_PART_PACKING_H

#include "journal/journal.h"

typedef struct st_packer st_packer;
typedef struct st_unpacker st_unpacker;

/* Makes a compressor. Returns NULL if memory is out: the caller may then store parts
 * uncompressed. */
st_packer *st_packer_new(void);
void st_packer_free(st_packer *packer); /* takes NULL */
/* Compresses a part of `size` bytes, at most HE_STORED_PART_ROOM, in place; adds HE_CODING_PACKED
 * to *coding and returns the new size. A part that hardly becomes shorter is left as it is. If
 * `packer` is NULL or memory is out, every part is left as it is. */
size_t st_part_pack(st_packer *packer, unsigned char *part, size_t size, unsigned *coding);

/* The bytes of a part, which are borrowed. */
typedef struct st_part {
    const unsigned char *bytes;
    size_t size;
} st_part;

/* Makes a decompressor. Returns NULL if memory is out. */
st_unpacker *st_unpacker_new(void);
void st_unpacker_free(st_unpacker *unpacker); /* takes NULL */
/* Decompresses a part. *out is valid until the next part is decompressed; its size is at most
 * HE_STORED_PART_ROOM.
 * Returns ST_NO_MEMORY if memory is out.
 * Returns ST_DAMAGED if the part is not valid; *why, a string literal, says what is wrong. */
st_status st_part_unpack(st_unpacker *unpacker, st_part packed, st_part *out, const char **why);

#endif
