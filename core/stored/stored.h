/* stored.h - writes meshes and edits as bytes that every later release can read.
 *
 * Two things have a coded form: a CONTENT, which is a whole mesh, and an EDIT, which is one delta.
 * A mesh is loaded from a content, then the edits made after it are applied; afterwards the mesh
 * and its deltas are, bit for bit, what they were when the edits were made, undo and redo included.
 *
 * Numbers are little-endian. A varint has seven bits a byte, the lowest first, in as few bytes as
 * possible; a signed number is a varint of 2n or -2n - 1.
 *
 * EDIT
 *     1 byte       the version, 1 or 2; an edit of version 2 has objects of kind 5, and only these
 *                  edits do, so that a release that reads only version 1 refuses them as newer
 *     varint       how many changes
 *     runs         each a sequence of changes to one column, in the order in which they were made:
 *       varint     16 * (changes - 1) + code, 0 to 10 as in edit_code.h
 *       varint     only with the code of attributes: the slot
 *       changes    each: its row, as a signed difference to the row of the last change with that
 *                  code; then by code
 *           links      before, after: 0 is HE_NONE, 1 HE_DEAD, else 2 + the signed difference to
 *                      the row
 *           values     which word of the row, 1 byte; before, after: 4 bytes each
 *           lineage    the kind of element, 1 byte; the other element, as a difference to the row
 *     objects      a run of one change, with code 10: kind (1 byte), length (8 bytes), and
 *                  1  an attribute that was added: its slot, its head, labels, rows
 *                  2  an attribute that was dropped: its slot and its head
 *                  3  a replaced content: 1 byte (1 if ids changed their meaning, else 0), and the
 *                     new content
 *                  4  a material put in a slot: the slot (varint), the mark of the one that was
 *                     there (4 bytes, 0 for none; material.h), the new one, or nothing
 *                  5  the positions of the first vertices: how many (varint), three doubles each
 *
 * If a delta replaced the content, only the content after it is coded: the delta read back is one
 * replacement. The high-water marks after an edit (how many ids of each kind were ever issued) are
 * not part of it; they are stored beside it.
 *
 * CONTENT: a header and the arrays, as one sequence of bytes, cut into PARTS of HE_STORED_PART
 * bytes (the last may be shorter), each of which is coded by itself.
 *     4            "hedg"
 *     4            the version
 *     8            length of the header from its first byte: a multiple of 8
 *     3 x 4        vertices, edges, faces issued
 *     3 x 4        vertices, edges, faces alive
 *     4            boundary half-edges
 *     4, 4, 4      how many slots of attributes, how many slots of materials, 0
 *     attributes, each:
 *       1, 8         kind: 0 no attribute, 1 an attribute; length of what follows
 *       head         domain, type, rule, components: 1 byte each; name: length (1 byte), UTF-8;
 *                    the default row
 *       labels       varint: 0 for none, else 1 + how many; each a length (varint) and UTF-8
 *       rows         varint, how many are stored; in an attribute that was added (above) their
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
 * a varint as in an edit and all else is plain. Links of next and prev are differences to their
 * row; all other links are differences to the last one before them, in the array and in the part,
 * that is neither HE_NONE nor HE_DEAD, or to their row if there is none. HE_CODING_PACKED is added
 * to either by a layer above that compresses parts (core/journal/part_packing.h); that layer
 * decompresses them and removes the flag before they are read here.
 *
 * A reader trusts no byte. It refuses invalid bytes with HE_CORRUPT and the offset (in a content,
 * the offset in the whole without codings), and bytes of a newer release with HE_UNSUPPORTED and
 * both versions; it takes no more memory than a small multiple of its input. It does not check
 * links and positions: he_check does that, on the mesh after all edits. */
#ifndef HE_STORED_STORED_H
#define HE_STORED_STORED_H

#include "mesh/delta.h"

/* The newest version of an edit, and the version of a content. */
enum { HE_EDIT_VERSION = 2, HE_CONTENT_VERSION = 1 };

/* --- edits --- */

/* Returns the most bytes that the edit can take when it is written. `after` is the mesh after the
 * delta. */
size_t he_stored_edit_bound(const he_delta *delta, const he_mesh *after);
/* Writes the edit to `to`, which must have room for he_stored_edit_bound bytes, and returns the
 * number of bytes written. Allocates nothing. */
size_t he_stored_edit_write(const he_delta *delta, const he_mesh *after, unsigned char *to);
/* Applies a stored edit to a mesh in the state on which it was made; `issued` are the high-water
 * marks (numbers of ids ever issued) after the edit, indexed by kind. *out, which the caller frees,
 * is the delta that the edit would have recorded on this mesh. On failure the mesh is as it was.
 * Returns HE_CORRUPT with the byte if the bytes are not valid, or the mesh is not in that state.
 * Returns HE_UNSUPPORTED if a newer release wrote the bytes.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_stored_edit_forward(const unsigned char *bytes, size_t size,
                                              const uint32_t issued[HE_KIND_COUNT], he_mesh *mesh,
                                              he_delta **out, he_error *err);

/* --- contents, written and read part by part --- */

enum { HE_STORED_PART = 1 << 16, HE_STORED_PART_ROOM = HE_STORED_PART + 8 };

enum { HE_CODING_PLAIN = 0, HE_CODING_LINKS = 1, HE_CODING_PACKED = 2 };

/* The state of a writer between two parts. It owns no memory, so the caller may drop it at any
 * time. The mesh must not change meanwhile. The bytes are made in pieces, such as the head of an
 * attribute or an array, of which a part may contain several, or only a section of one. */
typedef struct he_stored_writer {
    const he_mesh *mesh;
    unsigned stage; /* kind of the next piece */
    /* indices of the attribute or material whose piece is written next (slot), and of its label */
    size_t slot, label;
    uint64_t header; /* length of the header in bytes */
    uint64_t done;   /* number of bytes of all pieces made so far */
    /* Points to the bytes of the current piece (a header, a label or an array) that are not written
     * yet. */
    const unsigned char *from;
    size_t left;   /* how many bytes of the present piece are not written yet */
    int links;     /* how links of the present piece are coded: he_links of content_code.h */
    uint32_t row;  /* row of the next link to write */
    uint32_t last; /* the id in the last link written, if has_last is true */
    bool has_last; /* true if an id was written before in this part and array */
    unsigned char scratch[256];
} he_stored_writer;

void he_stored_writer_init(he_stored_writer *writer, const he_mesh *mesh);
/* Writes the next part, at most HE_STORED_PART_ROOM bytes, to `to`. Returns the number of bytes
 * written, 0 after the last part. */
size_t he_stored_writer_next(he_stored_writer *writer, unsigned char *to, unsigned *coding);
/* Returns into how many parts the whole mesh is cut. */
uint64_t he_stored_parts(const he_mesh *mesh);

typedef struct he_stored_reader he_stored_reader;

/* Makes a reader of a content of at most `most` bytes, such as HE_STORED_PART for each part there
 * is. The reader refuses a content that claims to be larger before it allocates anything for it.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_stored_reader_new(uint64_t most, he_stored_reader **out, he_error *err);
void he_stored_reader_free(he_stored_reader *reader);
/* Reads the next part. After a failure the caller can only free the reader.
 * Returns HE_CORRUPT with the byte of the content if the bytes are not valid.
 * Returns HE_UNSUPPORTED if a newer release wrote them.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_stored_reader_part(he_stored_reader *reader, unsigned coding,
                                             const unsigned char *bytes, size_t size,
                                             he_error *err);
/* Makes the mesh, which the caller owns, after the last part was read.
 * Returns HE_CORRUPT if parts are missing. */
HE_NODISCARD he_status he_stored_reader_end(he_stored_reader *reader, he_mesh **out, he_error *err);

/* --- contents as one block: before each part stand its coding (1 byte) and length (4 bytes) --- */

size_t he_stored_content_bound(const he_mesh *mesh);
/* Writes a content and returns the number of bytes written. Allocates nothing. */
size_t he_stored_content_write(const he_mesh *mesh, unsigned char *to);
HE_NODISCARD he_status he_stored_content_read(const unsigned char *bytes, size_t size,
                                              he_mesh **out, he_error *err);

#endif
