#include "api/progressive_rows.h"

#include "mesh/walk.h"

#include <string.h>

enum { VERSION = 1, HEADER = 104, VERTEX = 32, ROW = 16 };

static void put_u32(api_progressive *p, uint32_t value)
{
    for (unsigned shift = 0; shift < 32; shift += 8) {
        p->buffer[p->end++] = (unsigned char)(value >> shift);
    }
}

static void put_u64(api_progressive *p, uint64_t value)
{
    put_u32(p, (uint32_t)value);
    put_u32(p, (uint32_t)(value >> 32));
}

static void put_point(api_progressive *p, he_vec3 point)
{
    const double values[3] = {point.x, point.y, point.z};
    for (unsigned i = 0; i < 3; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_u64(p, bits);
    }
}

static const he_vertex_split *split_at(const api_progressive *p, uint64_t i)
{
    return &p->mesh.splits[p->mesh.count - 1 - (size_t)i];
}

static size_t split_bytes(const he_vertex_split *split)
{
    return 96 + ((size_t)split->moved + 1) / 2 * 8;
}

int64_t api_progressive_bytes(const api_progressive *p)
{
    const he_mesh *base = p->mesh.base;
    uint64_t bytes = HEADER + (uint64_t)he_mesh_vertices(base) * VERTEX +
                     ((uint64_t)he_mesh_edges(base) + he_mesh_faces(base)) * ROW;
    for (size_t i = 0; i < p->wanted; i++) {
        bytes += split_bytes(split_at(p, i));
    }
    return (int64_t)bytes;
}

static void put_header(api_progressive *p)
{
    const he_mesh *base = p->mesh.base;
    memcpy(p->buffer, "HEDP", 4);
    p->end = 4;
    put_u32(p, VERSION);
    put_u64(p, p->revision);
    put_u32(p, he_mesh_vertices(base));
    put_u32(p, he_mesh_edges(base));
    put_u32(p, he_mesh_faces(base));
    put_u32(p, (uint32_t)p->wanted);
    put_u32(p, (uint32_t)p->mesh.count);
    put_u32(p, 0);
    put_u32(p, p->issued[HE_VERTEX]);
    put_u32(p, p->issued[HE_EDGE]);
    put_u32(p, p->issued[HE_FACE]);
    put_u32(p, 0);
    put_point(p, p->low);
    put_point(p, p->high);
}

static void put_element(api_progressive *p, he_kind kind, uint32_t id)
{
    const he_mesh *base = p->mesh.base;
    put_u32(p, id);
    if (kind == HE_VERTEX) {
        put_u32(p, 0);
        put_point(p, he_position(base, (he_vertex){id}));
    } else if (kind == HE_EDGE) {
        put_u32(p, he_origin(base, he_edge_halfedge((he_edge){id}, 0)).i);
        put_u32(p, he_origin(base, he_edge_halfedge((he_edge){id}, 1)).i);
        put_u32(p, 0);
    } else {
        he_halfedge h = he_face_halfedge(base, (he_face){id});
        for (unsigned i = 0; i < 3; i++) {
            put_u32(p, he_origin(base, h).i);
            h = he_next(base, h);
        }
    }
}

static void put_split(api_progressive *p, const he_vertex_split *split)
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
        put_u32(p, words[i]);
    }
    put_point(p, split->at);
    put_point(p, split->from_at);
    for (uint32_t i = 0; i < split->moved; i++) {
        put_u32(p, p->mesh.moved.ids[split->first_moved + i]);
    }
    if (split->moved % 2 != 0) {
        put_u32(p, 0);
    }
}

static const he_kind parts[] = {HE_VERTEX, HE_EDGE, HE_FACE};
enum { PARTS = sizeof parts / sizeof *parts };

/* One more row into the buffer; false at the end. */
static bool fill(api_progressive *p)
{
    p->begin = p->end = 0;
    if (p->part == 0) {
        put_header(p);
        p->part = 1;
        p->next = 0;
        return true;
    }
    for (; p->part <= PARTS; p->part++, p->next = 0) {
        he_kind kind = parts[p->part - 1];
        uint32_t id = he_mesh_next_live(p->mesh.base, kind, p->next);
        if (id != HE_NONE) {
            put_element(p, kind, id);
            p->next = (uint64_t)id + 1;
            return true;
        }
    }
    if (p->next < p->wanted) {
        put_split(p, split_at(p, p->next++));
        return true;
    }
    return false;
}

size_t api_progressive_read(api_progressive *p, char *buffer, size_t size)
{
    size_t done = 0;
    while (done < size) {
        if (p->begin == p->end && !fill(p)) {
            break;
        }
        size_t take = p->end - p->begin < size - done ? p->end - p->begin : size - done;
        memcpy(buffer + done, p->buffer + p->begin, take);
        p->begin += take;
        done += take;
    }
    return done;
}
