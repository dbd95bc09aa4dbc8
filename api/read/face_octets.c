#include "api/read/face_octets.h"

#include "api/request/mesh_access.h"
#include "base/mem.h"
#include "mesh/walk.h"

#include <string.h>

enum { WORDS = 4096 };

typedef enum part { OFFSETS, CORNERS, IDS, COUNT, END } part;

typedef struct faces {
    const he_mesh *mesh;
    part part;         /* the part of the answer that is written */
    uint32_t face;     /* the face that is written next; HE_NONE: there are no more */
    he_halfedge first; /* of `face`, if one of its corners was written already, else HE_NONE */
    he_halfedge at;    /* the next corner of `face` */
    uint32_t corners;  /* how many corners the faces before `face` have */
    /* The numbers that were written; the bytes from `sent` on were not sent yet. */
    unsigned char bytes[WORDS * sizeof(uint32_t)];
    size_t sent, length;
} faces;

static void put(faces *f, uint32_t word)
{
    const unsigned char bytes[] = {(unsigned char)word, (unsigned char)(word >> 8),
                                   (unsigned char)(word >> 16), (unsigned char)(word >> 24)};
    memcpy(f->bytes + f->length, bytes, sizeof bytes);
    f->length += sizeof bytes;
}

static void begin(faces *f, part which)
{
    f->part = which;
    f->face = he_mesh_next_live(f->mesh, HE_FACE, 0);
    f->first = (he_halfedge){HE_NONE};
}

static void step(faces *f)
{
    f->face = he_mesh_next_live(f->mesh, HE_FACE, (uint64_t)f->face + 1);
}

/* Writes one corner, and goes to the next one. */
static void put_corner(faces *f)
{
    if (he_is_none(f->first.i)) {
        f->first = f->at = he_face_halfedge(f->mesh, (he_face){f->face});
    }
    put(f, he_origin(f->mesh, f->at).i);
    f->at = he_next(f->mesh, f->at);
    if (f->at.i == f->first.i) {
        f->first = (he_halfedge){HE_NONE};
        step(f);
    }
}

/* Writes the next number of the answer, and goes to the next part if it was the last of its part.
 */
static void put_next(faces *f)
{
    const bool last = f->face == HE_NONE;
    switch (f->part) {
    case OFFSETS:
        put(f, f->corners);
        if (last) {
            begin(f, CORNERS);
        } else {
            f->corners += he_face_degree(f->mesh, (he_face){f->face});
            step(f);
        }
        return;
    case CORNERS:
        if (last) {
            begin(f, IDS);
        } else {
            put_corner(f);
        }
        return;
    case IDS:
        if (last) {
            f->part = COUNT;
        } else {
            put(f, f->face);
            step(f);
        }
        return;
    case COUNT:
        put(f, he_mesh_faces(f->mesh));
        f->part = END;
        return;
    case END:
        return;
    }
}

static int64_t read_faces(void *stream, char *buffer, size_t size)
{
    faces *f = stream;
    if (f->sent == f->length) {
        f->sent = f->length = 0;
        while (f->part != END && f->length < sizeof f->bytes) {
            put_next(f);
        }
    }
    const size_t left = f->length - f->sent, length = left < size ? left : size;
    memcpy(buffer, f->bytes + f->sent, length);
    f->sent += length;
    return (int64_t)length;
}

static void free_faces(void *stream)
{
    he_mem_free(stream);
}

void api_face_octets(api_exchange *x)
{
    if (!api_keep_mesh(x)) {
        return;
    }
    faces *f = he_mem_zero(1, sizeof *f);
    if (f == NULL) {
        api_fail_memory(x);
        return;
    }
    f->mesh = x->content;
    begin(f, OFFSETS);
    const uint64_t corners =
        he_mesh_count(f->mesh, HE_HALFEDGE) - (uint64_t)he_mesh_boundary_halfedges(f->mesh);
    const uint64_t words = 2 * (uint64_t)he_mesh_faces(f->mesh) + corners + 2;
    const api_stream stream = {(int64_t)(words * sizeof(uint32_t)), read_faces, f, free_faces};
    api_answer_stream(x, 200, "application/octet-stream", &stream);
}
