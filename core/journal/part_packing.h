/* part_packing.h - parts of contents, compressed by zstd (HE_CODING_PACKED of stored.h).
 *
 * Each part is packed by itself, after its links were coded, and says how long it is unpacked: as
 * one zstd frame with its content size, at level 1. So a part is read without those before it, and
 * none takes more memory than the longest part there is. */
#ifndef HE_JOURNAL_PART_PACKING_H
#define HE_JOURNAL_PART_PACKING_H

#include "journal/journal.h"

typedef struct st_packer st_packer;
typedef struct st_unpacker st_unpacker;

/* NULL when memory is out: parts may stay as they are. */
st_packer *st_packer_new(void);
void st_packer_free(st_packer *packer); /* takes NULL */
/* Packs the part of `size` bytes where it stands, which is at most HE_STORED_PART_ROOM; adds
 * HE_CODING_PACKED to *coding and returns the new size. A part that hardly gets shorter stays as it
 * is, and so does every one where `packer` is NULL or memory is out. */
size_t st_part_pack(st_packer *packer, unsigned char *part, size_t size, unsigned *coding);

/* NULL when memory is out. */
st_unpacker *st_unpacker_new(void);
void st_unpacker_free(st_unpacker *unpacker); /* takes NULL */
/* Unpacks a part; *out is good until the next one, and *out_size at most HE_STORED_PART_ROOM.
 * ST_NO_MEMORY; ST_DAMAGED, and *why says what is wrong: a literal. */
st_status st_part_unpack(st_unpacker *unpacker, const unsigned char *part, size_t size,
                         const unsigned char **out, size_t *out_size, const char **why);

#endif
