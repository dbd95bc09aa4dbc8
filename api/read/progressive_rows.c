#include "api/read/progressive_rows.h"

#include "base/mem.h"
#include "mesh/walk.h"

#include <assert.h>
#include <string.h>

enum { VERSION = 1, HEADER = 104, VERTEX = 32, ROW = 16 };

static unsigned char *put_u32(unsigned char *at, uint32_t value)
{
    for (unsigned shift = 0; shift < 32; shift += 8) {
        *at++ = (unsigned char)(value >> shift);
    }
    return at;
}

static unsigned char *put_u64(unsigned char *at, uint64_t value)
{
    at = put_u32(at, (uint32_t)value);
    return put_u32(at, (uint32_t)(value >> 32));
}

static unsigned char *put_point(unsigned char *at, he_vec3 point)
{
    const double values[3] = {point.x, point.y, point.z};
    for (unsigned i = 0; i < 3; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        at = put_u64(at, bits);
    }
    return at;
}

/* --- writing the base --- */

static unsigned char *put_header(unsigned char *at, const api_progressive *p)
{
    const he_mesh *base = p->mesh.base;
    memcpy(at, "HEDP", 4);
    at = put_u32(at + 4, VERSION);
    at = put_u64(at, p->revision);
    at = put_u32(at, he_mesh_vertices(base));
    at = put_u32(at, he_mesh_edges(base));
    at = put_u32(at, he_mesh_faces(base));
    at = put_u32(at, (uint32_t)p->wanted);
    at = put_u32(at, (uint32_t)p->mesh.count);
    at = put_u32(at, 0);
    at = put_u32(at, p->issued[HE_VERTEX]);
    at = put_u32(at, p->issued[HE_EDGE]);
    at = put_u32(at, p->issued[HE_FACE]);
    at = put_u32(at, 0);
    at = put_point(at, p->low);
    return put_point(at, p->high);
}

static unsigned char *put_element(unsigned char *at, const he_mesh *base, he_kind kind, uint32_t id)
{
    at = put_u32(at, id);
    if (kind == HE_VERTEX) {
        at = put_u32(at, 0);
        return put_point(at, he_position(base, (he_vertex){id}));
    }
    if (kind == HE_EDGE) {
        at = put_u32(at, he_origin(base, he_edge_halfedge((he_edge){id}, 0)).i);
        at = put_u32(at, he_origin(base, he_edge_halfedge((he_edge){id}, 1)).i);
        return put_u32(at, 0);
    }
    he_halfedge h = he_face_halfedge(base, (he_face){id});
    for (unsigned i = 0; i < 3; i++) {
        at = put_u32(at, he_origin(base, h).i);
        h = he_next(base, h);
    }
    return at;
}

/* Drops the splits before `first`, which are the finest ones, because splits are sent from the last
 * to the first. */
static void drop_splits(he_progressive *mesh, size_t first)
{
    if (first == 0) {
        return;
    }
    mesh->count -= first;
    size_t moved = mesh->count == 0 ? mesh->moved.count : mesh->splits[first].first_moved;
    memmove(mesh->splits, mesh->splits + first, mesh->count * sizeof *mesh->splits);
    for (size_t i = 0; i < mesh->count; i++) {
        mesh->splits[i].first_moved -= moved;
    }
    mesh->moved.count -= moved;
    memmove(mesh->moved.ids, mesh->moved.ids + moved, mesh->moved.count * sizeof *mesh->moved.ids);
}

/* Frees unused capacity of the lists. If that fails, the lists stay as they are. */
static void fit(he_progressive *mesh)
{
    he_progressive_split *splits = he_mem_array(mesh->splits, mesh->count + 1, sizeof *splits);
    if (splits != NULL) {
        mesh->splits = splits;
        mesh->capacity = mesh->count + 1;
    }
    uint32_t *ids = he_mem_array(mesh->moved.ids, mesh->moved.count + 1, sizeof *ids);
    if (ids != NULL) {
        mesh->moved.ids = ids;
        mesh->moved.capacity = mesh->moved.count + 1;
    }
}

he_status api_progressive_write(api_progressive *p, he_progress *progress, he_error *err)
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    const he_mesh *base = p->mesh.base;
    p->base_bytes = HEADER + (size_t)he_mesh_vertices(base) * VERTEX +
                    ((size_t)he_mesh_edges(base) + he_mesh_faces(base)) * ROW;
    p->base = he_mem_alloc(p->base_bytes);
    if (p->base == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the %zu bytes of the coarsest mesh",
                             p->base_bytes);
    }
    unsigned char *at = put_header(p->base, p);
    uint64_t written = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        for (uint32_t id = he_mesh_next_live(base, kinds[k], 0); id != HE_NONE;
             id = he_mesh_next_live(base, kinds[k], (uint64_t)id + 1)) {
            he_status status = he_progress_at(progress, written++, p->base_bytes / ROW, err);
            if (status != HE_OK) {
                return status;
            }
            at = put_element(at, base, kinds[k], id);
        }
    }
    assert(at == p->base + p->base_bytes);
    he_mesh_free(p->mesh.base);
    p->mesh.base = NULL;
    drop_splits(&p->mesh, p->mesh.count - p->wanted);
    fit(&p->mesh);
    return HE_OK;
}

void api_progressive_clear(api_progressive *p)
{
    he_progressive_clear(&p->mesh);
    he_mem_free(p->base);
    p->base = NULL;
}

/* --- writing the splits --- */

static const he_progressive_split *split_at(const api_progressive *p, size_t i)
{
    return &p->mesh.splits[p->mesh.count - 1 - i];
}

static size_t split_bytes(const he_progressive_split *split)
{
    return 96 + ((size_t)split->moved + 1) / 2 * 8;
}

int64_t api_progressive_bytes(const api_progressive *p)
{
    uint64_t bytes = p->base_bytes;
    for (size_t i = 0; i < p->wanted; i++) {
        bytes += split_bytes(split_at(p, i));
    }
    return (int64_t)bytes;
}

static unsigned char *put_split(unsigned char *at, const api_progressive *p,
                                const he_progressive_split *split)
{
    const uint32_t words[] = {(uint32_t)split_bytes(split),
                              split->vertex,
                              split->from,
                              split->left,
                              split->right,
                              split->halfedge,
                              split->left_halfedge,
                              split->right_halfedge,
                              split->left_face,
                              split->right_face,
                              split->moved,
                              0};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        at = put_u32(at, words[i]);
    }
    at = put_point(at, split->at);
    at = put_point(at, split->from_at);
    for (uint32_t i = 0; i < split->moved; i++) {
        at = put_u32(at, p->mesh.moved.ids[split->first_moved + i]);
    }
    return split->moved % 2 != 0 ? put_u32(at, 0) : at;
}

static size_t take(char *buffer, size_t size, const unsigned char *bytes, size_t left)
{
    size_t count = left < size ? left : size;
    memcpy(buffer, bytes, count);
    return count;
}

size_t api_progressive_read(api_progressive *p, char *buffer, size_t size)
{
    size_t done = take(buffer, size, p->base + p->base_sent, p->base_bytes - p->base_sent);
    p->base_sent += done;
    while (done < size) {
        if (p->begin == p->end) {
            if (p->next == p->wanted) {
                break;
            }
            p->begin = 0;
            p->end = (size_t)(put_split(p->split, p, split_at(p, p->next++)) - p->split);
        }
        size_t taken = take(buffer + done, size - done, p->split + p->begin, p->end - p->begin);
        p->begin += taken;
        done += taken;
    }
    return done;
}
