/* record_bytes.h - writes records (changes of meshes) as bytes that every later release can read.
 *
 * FRAME, version 1 or 2, little-endian; varints as in stored.h:
 *     4          CRC-32C of all that follows
 *     1, 1, 2    version; kind (st_record_kind); flags (below)
 *     8, 8       number; revision
 *     8          the chain
 *     8          time, a double
 *     varints    counter of metadata; revision that is undone, redone or named; how many revisions
 *                the history reaches back; ids ever issued of vertices, edges and faces; live
 *                vertices, edges and faces; boundary half-edges; bytes of the mesh in memory
 *     text       ops: length (varint) and UTF-8
 *     text       the mesh's name; only in records of a content or a rename. In records that name a
 *                revision: the name of that revision
 *     9 varints  with the flag TALLY: created, deleted, modified vertices, edges and faces
 *     the rest   the body; with the flag PARTS there is none, and the content is stored in rows
 *                of its own, in parts; with PARTS and EDIT those are parts of the encoded edit
 *
 * Version 2 has the kind ST_RECORD_MOMENT, and only records of this kind are written as version 2:
 * a release that reads only version 1 refuses them as written by a newer release.
 *
 * THE CHAIN is a hash that connects a record to all before it. The chain of the first record is the
 * hash of its mesh's origin (a number that no other mesh has). The chain of each later record is
 * the hash of the frame before it, from the version on. The hash is the first word of
 * SipHash-2-4-128 with the key 0. A record that is missing, duplicated or from another mesh breaks
 * the chain; equal chains mean equal histories.
 *
 * A reader trusts no byte: it refuses invalid bytes with HE_CORRUPT and the offset, and bytes of a
 * newer release with HE_UNSUPPORTED and both versions. */
#ifndef HE_JOURNAL_RECORD_BYTES_H
#define HE_JOURNAL_RECORD_BYTES_H

#include "journal/record.h"

#include <stddef.h>

enum {
    ST_FRAME_VERSION = 2,
    ST_FRAME_OPS = 255, /* most bytes of `ops`, the names of operations; a longer text is cut */
    /* The most bytes of a frame (an encoded record) without its body. */
    ST_FRAME_HEAD = 40 + 4 * 10 + 7 * 5 + (2 + ST_FRAME_OPS) + (2 + ST_MESH_NAME) + 9 * 5
};

/* A decoded frame. The texts of `record` point into this struct, its body points into the frame's
 * bytes. A frame does not contain the members id, incarnation, created and key of the record. */
typedef struct st_frame {
    st_record record; /* its `stage` is NULL */
    bool in_parts;
    uint64_t chain;
    char name[ST_MESH_NAME + 1], ops[ST_FRAME_OPS + 1];
} st_frame;

/* Writes the record to `to`, which has room for ST_FRAME_HEAD bytes and the body; st_frame_seal
 * writes the chain and the checksum later. If the record has a stage, the flag PARTS is set, and
 * the flag EDIT if the stage is an edit. Returns the number of bytes written. */
size_t st_frame_write(const st_record *record, unsigned char *to);
/* Writes the chain (a hash that connects a record to all before it) and the checksum into a frame.
 * Returns the chain of the next record. */
uint64_t st_frame_seal(unsigned char *frame, size_t size, uint64_t chain);

/* Returns the chain (a hash) of the first record of a mesh; `origin` is a number that no other mesh
 * has. */
uint64_t st_chain_of_origin(uint64_t origin);
/* Returns the chain (a hash) of the record after the one that this frame encodes. */
uint64_t st_frame_next_chain(const unsigned char *frame, size_t size);

/* Decodes a frame.
 * Returns HE_CORRUPT if the bytes are not valid.
 * Returns HE_UNSUPPORTED if a newer release wrote them. */
HE_NODISCARD he_status st_frame_read(const unsigned char *bytes, size_t size, st_frame *out,
                                     he_error *err);

#endif
