/* stored.h - meshes and edits as bytes, to be kept and read again by any later release.
 *
 * Two things have a coded form: a CONTENT, which is a whole mesh, and an EDIT, which is one delta.
 * A mesh is loaded from a content and goes forward over the edits made after it; afterwards it and
 * its deltas are, bit for bit, what they were when the edits were made, undo and redo included.
 *
 * Numbers are little-endian. A varint has seven bits a byte, the lowest first, in as few bytes as
 * possible; a signed number is a varint of 2n or -2n - 1.
 *
 * EDIT
 *     1 byte       the version
 *     varint       how many changes
 *     runs         of changes to one column, in the order in which they were made:
 *       varint     16 * (changes - 1) + code, 0 to 10 as in edit_code.h
 *       varint     with the code of attributes: the slot
 *       changes    each: its row, as a signed difference to the row before under that code; then
 *                  by code
 *           links      before, after: 0 is HE_NONE, 1 HE_DEAD, else 2 + the signed difference to
 *                      the row
 *           values     which word of the row, 1 byte; before, after: 4 bytes each
 *           lineage    the kind of element, 1 byte; the other one, as a difference to the row
 *     objects      a run of one: kind (1 byte), length (8 bytes), and
 *                  1  an attribute that was added: its slot, its head, labels, rows
 *                  2  an attribute that was dropped: its slot and its head
 *                  3  a replace: 1 byte, 1 where ids changed their meaning, and the content
 *                  4  a material put in a slot: the slot (varint), the mark of the one that was
 *                     there (4 bytes, 0 for none; material.h), the new one, or nothing
 *
 * Where a delta replaced the content, the content after it is all that is coded: the delta that is
 * read is one replace. The high-water marks after an edit are not in it; they go beside it.
 *
 * CONTENT: a header and the arrays, as one run of bytes, cut into PARTS of HE_STORED_PART bytes
 * (the last may be shorter), each of which is coded by itself.
 *     4            "hedg"
 *     4            the version
 *     8            bytes of the header, these included: a multiple of 8
 *     3 x 4        vertices, edges, faces issued
 *     3 x 4        of them alive
 *     4            boundary half-edges
 *     4, 4, 4      slots of attributes, slots of materials, 0
 *     attributes, each:
 *       1, 8         kind: 0 no attribute, 1 an attribute; length of what follows
 *       head         domain, type, rule, components: 1 byte each; name: length (1 byte), UTF-8;
 *                    the default row
 *       labels       varint: 0 for none, else 1 + how many; each a length (varint) and UTF-8
 *       rows         varint, as many as are stored; with an attribute that was added (above) their
 *                    values follow
 *     materials, each:
 *       1, 8         kind: 0 no material, 2 a material; length of what follows
 *       look         base colour (4 doubles), metallic, roughness, emission (3), sides (1 byte: 1
 *                    for both)
 *       name         length (varint), UTF-8
 *     zeros        up to a multiple of 8
 *     arrays       position, halfedge of vertices, next, prev, origin, face, halfedge of faces;
 *                  then the rows of each attribute
 *
 * Codings of parts: in HE_CODING_PLAIN a part is those bytes; in HE_CODING_LINKS each link in it is
 * a varint as in an edit and all else plain. Links of next and prev are differences to their row
 * there; all others to the last one before them in the array and in the part that is neither
 * HE_NONE nor HE_DEAD, to their row where there is none. HE_CODING_PACKED is added to either by
 * a layer above that compresses parts (core/journal/part_packing.h), and taken off before they come
 * back.
 *
 * Bytes that are read are believed in nothing: what is wrong is refused with HE_CORRUPT and the
 * byte where it stands (in a content that of the whole, without codings), what a newer release has
 * written with HE_UNSUPPORTED and both versions, and no more memory is taken than a small multiple
 * of what came. Links and positions are not looked into: he_check does that, on the mesh that all
 * edits have led to. */
#ifndef HE_STORED_STORED_H
#define HE_STORED_STORED_H

#include "mesh/delta.h"

enum { HE_STORED_VERSION = 1 };

/* --- edits --- */

/* Bytes that the edit takes at most. `after` is the mesh as the delta has left it. */
size_t he_stored_edit_bound(const he_delta *delta, const he_mesh *after);
/* Write it to `to`, which has room for the bound; returns the bytes. Allocates nothing. */
size_t he_stored_edit_write(const he_delta *delta, const he_mesh *after, unsigned char *to);
/* Bring a mesh forward over an edit that was made on its like; `issued` are the high-water marks
 * after it, indexed by kind. *out is the edit's delta as it would be had the edit been made on this
 * mesh, the caller's to free. HE_CORRUPT with the byte, also where the mesh holds something else
 * than the edit was made on; HE_UNSUPPORTED; HE_NO_MEMORY. After any of these the mesh is as it
 * was. */
HE_NODISCARD he_status he_stored_edit_forward(const unsigned char *bytes, size_t size,
                                              const uint32_t issued[HE_KIND_COUNT], he_mesh *mesh,
                                              he_delta **out, he_error *err);

/* --- contents, part by part --- */

enum { HE_STORED_PART = 1 << 16, HE_STORED_PART_ROOM = HE_STORED_PART + 8 };

enum { HE_CODING_PLAIN = 0, HE_CODING_LINKS = 1, HE_CODING_PACKED = 2 };

/* Where a mesh that is being coded stands. Allocates nothing, so it may be dropped at any time; the
 * mesh stays as it is meanwhile. */
typedef struct he_stored_writer {
    const he_mesh *mesh;
    unsigned stage;
    size_t slot, label;
    uint64_t header;           /* its bytes */
    uint64_t done;             /* bytes before the piece at hand */
    const unsigned char *from; /* what is left of the piece at hand */
    size_t left;
    int links;     /* it is an array of links: he_links of content_code.h */
    uint32_t row;  /* of the next of them */
    uint32_t last; /* the one before it, */
    bool has_last; /* if there is one in the part */
    unsigned char scratch[256];
} he_stored_writer;

void he_stored_writer_init(he_stored_writer *writer, const he_mesh *mesh);
/* The next part, to HE_STORED_PART_ROOM bytes at `to`; returns its bytes, 0 after the last. */
size_t he_stored_writer_next(he_stored_writer *writer, unsigned char *to, unsigned *coding);
/* How many parts the whole mesh makes. */
uint64_t he_stored_parts(const he_mesh *mesh);

typedef struct he_stored_reader he_stored_reader;

/* Makes a reader of a content of at most `most` bytes, such as HE_STORED_PART for each part there
 * is. A content that says it has more is refused before memory is taken for it. HE_NO_MEMORY. */
HE_NODISCARD he_status he_stored_reader_new(uint64_t most, he_stored_reader **out, he_error *err);
void he_stored_reader_free(he_stored_reader *reader);
/* The next part. HE_CORRUPT with the byte of the content where it shows, HE_UNSUPPORTED,
 * HE_NO_MEMORY: the reader is good only to be freed then. */
HE_NODISCARD he_status he_stored_reader_part(he_stored_reader *reader, unsigned coding,
                                             const unsigned char *bytes, size_t size,
                                             he_error *err);
/* All parts have come: the mesh, which is the caller's. HE_CORRUPT where parts are missing. */
HE_NODISCARD he_status he_stored_reader_end(he_stored_reader *reader, he_mesh **out, he_error *err);

/* --- contents as one block: each part with its coding (1 byte) and length (4 bytes) before it ---
 */

size_t he_stored_content_bound(const he_mesh *mesh);
/* Returns the bytes. Allocates nothing. */
size_t he_stored_content_write(const he_mesh *mesh, unsigned char *to);
HE_NODISCARD he_status he_stored_content_read(const unsigned char *bytes, size_t size,
                                              he_mesh **out, he_error *err);

#endif
