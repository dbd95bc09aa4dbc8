/* pieces.h - several threads write a document together.
 *
 * The rows of a large mesh, such as its vertices, are cut into pieces of some thousand rows. Lent
 * threads (base/parallel.h) write as many pieces as there are threads at once, each into a buffer
 * of its own, and the reader of the document then gets the buffers in order:
 *
 *     document   header | piece 0 | piece 1 | piece 2 | piece 0 | piece 1 | ... | end
 *                       |<---- written at once ------>|<---- written at once ...
 *
 * A piece whose text is longer than its buffer is written to its end when its turn comes. */
#ifndef HE_FORMAT_IO_PIECES_H
#define HE_FORMAT_IO_PIECES_H

#include "format/io/format.h"

typedef struct he_pieces he_pieces;

/* Makes the pieces of a document that `writing` writes of `mesh`. Returns NULL, so that one thread
 * writes the document, if the mesh is small, if `writing` cannot cut, if `progress` is NULL or
 * lends no threads, or if memory is out. The lent threads must be there as long as the pieces. */
he_pieces *he_pieces_new(const he_writing *writing, const he_mesh *mesh,
                         const he_progress *progress);
void he_pieces_free(he_pieces *pieces);
/* Writes the next bytes of the document at `*p`, up to `end`, and advances `*p`; `state` is the
 * state of the writer. If all pieces were written, cuts the next ones. Returns false if no row
 * begins where the document stands, or if `pieces` is NULL: then the writer itself must go on. */
bool he_pieces_write(he_pieces *pieces, void *state, char **p, const char *end);

#endif
