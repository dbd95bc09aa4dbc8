#include "format/io/pieces.h"

#include "base/parallel.h"
#include "mesh/mesh.h"

#include <string.h>

/* FIRST_ROWS is the number of rows of the first pieces. The rows of all pieces double each time, up
 * to MOST_ROWS, so that little work is lost if the client reads only the beginning. BUFFER bytes
 * are enough for MOST_ROWS rows of most files. A mesh with fewer than LEAST_ROWS vertices and faces
 * is written by one thread. */
enum {
    MOST_PIECES = 8,
    FIRST_ROWS = 1024,
    MOST_ROWS = 8192,
    BUFFER = 768 * 1024,
    LEAST_ROWS = 4 * MOST_ROWS
};

typedef struct piece {
    void *state;
    char *buffer;
    size_t from, to; /* bytes of the buffer that were written and not yet read */
    bool ended;      /* true if the buffer has the last bytes of the piece */
} piece;

struct he_pieces {
    const he_writing *writing;
    const he_parallel *parallel;
    piece *piece;
    uint32_t most; /* number of pieces that can be written at once */
    uint32_t rows; /* number of rows of the next pieces */
    /* The pieces that are being read: the next one, and how many there are. */
    uint32_t next, count;
};

he_pieces *he_pieces_new(const he_writing *writing, const he_mesh *mesh,
                         const he_progress *progress)
{
    const he_parallel *parallel = progress == NULL ? NULL : progress->parallel;
    uint64_t rows = (uint64_t)he_mesh_vertices(mesh) + he_mesh_faces(mesh);
    if (writing->cut == NULL || parallel == NULL || parallel->threads < 2 || rows < LEAST_ROWS) {
        return NULL;
    }
    he_pieces *made = he_mem_zero(1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    made->writing = writing;
    made->parallel = parallel;
    made->most = parallel->threads < MOST_PIECES ? parallel->threads : MOST_PIECES;
    made->rows = FIRST_ROWS;
    made->piece = he_mem_zero(made->most, sizeof *made->piece);
    bool good = made->piece != NULL;
    for (uint32_t i = 0; good && i < made->most; i++) {
        made->piece[i].state = he_mem_alloc(writing->state_bytes);
        made->piece[i].buffer = he_mem_alloc(BUFFER);
        good = made->piece[i].state != NULL && made->piece[i].buffer != NULL;
    }
    if (!good) {
        he_pieces_free(made);
        return NULL;
    }
    return made;
}

void he_pieces_free(he_pieces *pieces)
{
    if (pieces == NULL) {
        return;
    }
    for (uint32_t i = 0; pieces->piece != NULL && i < pieces->most; i++) {
        he_mem_free(pieces->piece[i].state);
        he_mem_free(pieces->piece[i].buffer);
    }
    he_mem_free(pieces->piece);
    he_mem_free(pieces);
}

/* Writes rows of a piece up to `end`, or to the end of the piece. Returns the end of what it
 * wrote. */
static char *go_on(const he_writing *writing, piece *one, char *p, const char *end)
{
    while (!one->ended && end - p >= HE_WRITE_ROOM) {
        one->ended = !writing->step(one->state, &p, end);
    }
    return p;
}

static he_status fill(void *context, uint32_t i, he_error *err)
{
    (void)err;
    he_pieces *pieces = context;
    piece *one = &pieces->piece[i];
    char *p = go_on(pieces->writing, one, one->buffer, one->buffer + BUFFER);
    one->to = (size_t)(p - one->buffer);
    return HE_OK;
}

/* Cuts the next pieces and writes them. Returns false if no row begins where the document
 * stands. */
static bool begin(he_pieces *pieces, void *state)
{
    uint32_t count = 0;
    while (count < pieces->most &&
           pieces->writing->cut(state, pieces->piece[count].state, pieces->rows)) {
        pieces->piece[count].from = pieces->piece[count].to = 0;
        pieces->piece[count].ended = false;
        count++;
    }
    pieces->next = 0;
    pieces->count = count;
    if (count == 0) {
        return false;
    }
    pieces->rows = pieces->rows < MOST_ROWS ? 2 * pieces->rows : MOST_ROWS;
    /* No part fails and nobody cancels, so every part has run. */
    he_error unused = {0};
    (void)pieces->parallel->run(pieces->parallel->self, count, fill, pieces, NULL, &unused);
    return true;
}

bool he_pieces_write(he_pieces *pieces, void *state, char **p, const char *end)
{
    if (pieces == NULL || (pieces->next == pieces->count && !begin(pieces, state))) {
        return false;
    }
    piece *one = &pieces->piece[pieces->next];
    size_t left = one->to - one->from, room = (size_t)(end - *p);
    size_t taken = left < room ? left : room;
    memcpy(*p, one->buffer + one->from, taken);
    one->from += taken;
    *p += taken;
    if (one->from == one->to) {
        *p = go_on(pieces->writing, one, *p, end);
        pieces->next += one->ended;
    }
    return true;
}
