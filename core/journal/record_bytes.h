/* record_bytes.h - records as bytes, to be kept and read again by any later release.
 *
 * FRAME, version 1, little-endian; varints as in stored.h:
 *     4          CRC-32C of all that follows
 *     1, 1, 2    version; kind (st_record_kind); flags (below)
 *     8, 8       number; revision
 *     8          the chain
 *     8          time, a double
 *     varints    counter of metadata; revision that is inverted; revisions that the history
 *                reaches back; high-water marks of vertices, edges and faces; live vertices,
 *                edges and faces, boundary half-edges; bytes in memory
 *     text       ops: length (varint) and UTF-8
 *     text       the name, of a content and a rename
 *     9 varints  with the flag TALLY: created, deleted, modified vertices, edges and faces
 *     the rest   the body; none with the flag PARTS: the content lies beside, in parts; with the
 *                flag EDIT too, of an edit only, those are parts of the body
 *
 * THE CHAIN ties a record to all before it: that of the first is the hash of its mesh's origin (a
 * number that no other mesh has), that of each other the hash of the frame before it from the
 * version on. The hash is the first word of SipHash-2-4-128 with the key 0. A record that is
 * missing, doubled or another mesh's breaks the chain; equal chains are equal histories.
 *
 * Bytes that are read are believed in nothing: what is wrong is refused with HE_CORRUPT and the
 * byte where it stands, what a newer release has written with HE_UNSUPPORTED and both versions. */
#ifndef HE_JOURNAL_RECORD_BYTES_H
#define HE_JOURNAL_RECORD_BYTES_H

#include "journal/record.h"

#include <stddef.h>

enum {
    ST_FRAME_VERSION = 1,
    ST_FRAME_OPS = 255, /* bytes of `ops` at most; a longer one is cut */
    /* Bytes of a frame without its body at most. */
    ST_FRAME_HEAD = 40 + 4 * 10 + 7 * 5 + (2 + ST_FRAME_OPS) + (2 + ST_MESH_NAME) + 9 * 5
};

/* What a frame holds. Texts of the record point into the struct, its body into the bytes; id,
 * incarnation, created and key are not in a frame. */
typedef struct st_frame {
    st_record record; /* `stage` is NULL */
    bool in_parts;
    uint64_t chain;
    char name[ST_MESH_NAME + 1], ops[ST_FRAME_OPS + 1];
} st_frame;

/* Write the record at `to`, which has room for ST_FRAME_HEAD bytes and the body, but for chain and
 * checksum. With a stage the flag PARTS is set, and EDIT as the record says. Returns the bytes. */
size_t st_frame_write(const st_record *record, unsigned char *to);
/* Put the chain and the checksum into a frame; returns the chain of the record after it. */
uint64_t st_frame_seal(unsigned char *frame, size_t size, uint64_t chain);

/* The chain of the first record. */
uint64_t st_chain_of_origin(uint64_t origin);
/* The chain of the record after this one. */
uint64_t st_frame_next_chain(const unsigned char *frame, size_t size);

/* HE_CORRUPT, HE_UNSUPPORTED. */
HE_NODISCARD he_status st_frame_read(const unsigned char *bytes, size_t size, st_frame *out,
                                     he_error *err);

#endif
