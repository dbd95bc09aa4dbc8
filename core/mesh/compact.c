#include "mesh/compact.h"

#include "mesh/content.h"
#include "mesh/write.h"

void he_maps_clear(he_maps *maps)
{
    he_mem_free(maps->vertex);
    he_mem_free(maps->edge);
    he_mem_free(maps->face);
    *maps = (he_maps){0};
}

/* Says which of 64 successive elements are live: `rows` has a set bit for each live element, and
 * `before` is the number of all live elements with lower ids than the first of the 64. The new id
 * of a live element is `before` plus the number of set bits below the element's own bit. Blocks
 * take a sixteenth of the memory of an array of new ids, so they stay in the cache. */
typedef struct block {
    uint64_t rows;
    uint32_t before;
} block;

enum { BLOCK_ROWS = 64 };

typedef struct ranks {
    block *vertices, *edges, *faces;
} ranks;

static size_t block_count(uint32_t issued)
{
    return (size_t)issued / BLOCK_ROWS + 1;
}

/* Makes the blocks (bits that say which elements are live) for all `issued` elements of a kind.
 * Element i is live unless its link, which is entry i * stride of `links`, is HE_DEAD. */
static block *rank_rows(const uint32_t *links, size_t stride, uint32_t issued)
{
    block *blocks = he_mem_array(NULL, block_count(issued), sizeof *blocks);
    uint32_t live = 0;
    for (size_t i = 0; blocks != NULL && i < block_count(issued); i++) {
        size_t first = i * BLOCK_ROWS,
               end = first + BLOCK_ROWS < issued ? first + BLOCK_ROWS : issued;
        blocks[i] = (block){0, live};
        for (size_t row = first; row < end; row++) {
            uint64_t lives = links[row * stride] != HE_DEAD;
            blocks[i].rows |= lives << (row - first);
            live += (uint32_t)lives;
        }
    }
    return blocks;
}

/* Returns the number of set bits. The bits are counted in parallel in fields of 2, 4 and 8 bits; a
 * multiplication adds up the fields. */
static uint32_t count_bits(uint64_t bits)
{
    bits -= bits >> 1 & 0x5555555555555555u;
    bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
    bits = (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
    return (uint32_t)(bits * 0x0101010101010101u >> 56);
}

/* Returns the new id of the live element whose old id is `row`. */
static uint32_t rank(const block *blocks, uint32_t row)
{
    const block *at = &blocks[row / BLOCK_ROWS];
    return at->before + count_bits(at->rows & (((uint64_t)1 << row % BLOCK_ROWS) - 1));
}

static uint32_t rank_halfedge(const block *edges, uint32_t h)
{
    return h == HE_NONE ? HE_NONE : 2 * rank(edges, h >> 1) + (h & 1);
}

/* An iteration over the live elements of a block of 64: `row` is the old id and `fresh` the new id
 * of the present element. The iteration visits the set bits of the block from the lowest up, so
 * that no branch depends on which elements are live. */
typedef struct walk {
    const block *blocks;
    uint64_t left; /* set bits of the block that were not visited yet */
    size_t at;
    uint32_t row, fresh;
} walk;

static walk walk_block(const block *blocks, size_t at)
{
    return (walk){blocks, blocks[at].rows, at, 0, blocks[at].before - 1};
}

static bool walk_on(walk *w)
{
    if (w->left == 0) {
        return false;
    }
    w->row = (uint32_t)(w->at * BLOCK_ROWS) + (uint32_t)__builtin_ctzll(w->left);
    w->left &= w->left - 1;
    w->fresh++;
    return true;
}

/* The arguments for copying live elements from the mesh data `from` to the mesh data `to`. `ranks`
 * gives the new ids of the elements. */
typedef struct moving {
    const he_content *from;
    he_content *to;
    const ranks *ranks;
} moving;

static void move_vertices(const moving *m, size_t at)
{
    const he_content *from = m->from;
    const ranks *r = m->ranks;
    he_content *to = m->to;
    for (walk w = walk_block(r->vertices, at); walk_on(&w);) {
        to->position[w.fresh] = from->position[w.row];
        to->vertex_halfedge[w.fresh] = rank_halfedge(r->edges, from->vertex_halfedge[w.row]);
    }
}

static void move_edges(const moving *m, size_t at)
{
    const he_content *from = m->from;
    const ranks *r = m->ranks;
    he_content *to = m->to;
    for (walk w = walk_block(r->edges, at); walk_on(&w);) {
        for (uint32_t side = 0; side < 2; side++) {
            uint32_t h = 2 * w.row + side, fresh = 2 * w.fresh + side, face = from->face[h];
            to->next[fresh] = rank_halfedge(r->edges, from->next[h]);
            to->prev[fresh] = rank_halfedge(r->edges, from->prev[h]);
            to->origin[fresh] = rank(r->vertices, from->origin[h]);
            to->face[fresh] = face == HE_NONE ? HE_NONE : rank(r->faces, face);
        }
    }
}

static void move_faces(const moving *m, size_t at)
{
    const he_content *from = m->from;
    const ranks *r = m->ranks;
    he_content *to = m->to;
    for (walk w = walk_block(r->faces, at); walk_on(&w);) {
        to->face_halfedge[w.fresh] = rank_halfedge(r->edges, from->face_halfedge[w.row]);
    }
}

/* Copies the live elements of one kind to the compacted mesh. `issued` ids of that kind were
 * issued, and `move` copies the live elements of one block of 64 ids. */
static he_status move_table(const moving *m, uint32_t issued,
                            void (*move)(const moving *m, size_t at), he_progress *progress,
                            he_error *err)
{
    he_status status = HE_OK;
    for (size_t at = 0; at < block_count(issued) && status == HE_OK; at++) {
        status = he_progress_at(progress, at * BLOCK_ROWS, issued, err);
        move(m, at);
    }
    return status;
}

static he_status move_links(const he_content *from, const ranks *r, he_content *to,
                            he_progress *progress, he_error *err)
{
    const moving m = {from, to, r};
    he_status status = he_progress_phase(progress, "moving vertices", 0.2, err);
    if (status == HE_OK) {
        status = move_table(&m, from->vertices.issued, move_vertices, progress, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(progress, "moving edges", 0.8, err);
    }
    if (status == HE_OK) {
        status = move_table(&m, from->edges.issued, move_edges, progress, err);
    }
    return status != HE_OK ? status : move_table(&m, from->faces.issued, move_faces, NULL, err);
}

static void move_row(const he_column *from, size_t row, he_column *to, size_t fresh)
{
    if (row < from->rows) {
        memcpy(he_column_row(to, fresh), he_column_row(from, row), from->row_bytes);
    }
}

/* Copies the attribute values of live elements to a new column. The blocks
 * say which elements are live. `per` is the number of values for each element of the blocks: 2 if
 * the attribute belongs to half-edges, because an edge of the blocks stands for two half-edges;
 * otherwise 1. */
static void move_rows(const he_column *from, const block *blocks, uint32_t issued, uint32_t per,
                      he_column *to)
{
    for (size_t at = 0; at < block_count(issued); at++) {
        for (walk w = walk_block(blocks, at); walk_on(&w);) {
            for (uint32_t i = 0; i < per; i++) {
                move_row(from, per * (size_t)w.row + i, to, per * (size_t)w.fresh + i);
            }
        }
    }
}

static void move_values(const he_content *content, const he_column *from, const ranks *r,
                        he_column *to)
{
    switch (from->domain) {
    case HE_VERTEX:
        move_rows(from, r->vertices, content->vertices.issued, 1, to);
        break;
    case HE_HALFEDGE:
        move_rows(from, r->edges, content->edges.issued, 2, to);
        break;
    case HE_EDGE:
        move_rows(from, r->edges, content->edges.issued, 1, to);
        break;
    case HE_FACE:
        move_rows(from, r->faces, content->faces.issued, 1, to);
        break;
    case HE_MESH_KIND:
        move_row(from, 0, to, 0);
        break;
    case HE_KIND_COUNT:
        break;
    }
}

static he_status move_column(const he_content *content, const he_column *from, const ranks *r,
                             size_t rows, he_column **out, he_error *err)
{
    he_column *to;
    he_status status = he_column_like(from, rows, &to, err);
    if (status != HE_OK) {
        return status;
    }
    move_values(content, from, r, to);
    *out = to;
    return HE_OK;
}

static he_status move_columns(const he_content *from, const ranks *r, he_content *to, he_error *err)
{
    if (from->column_count == 0) {
        return HE_OK;
    }
    to->columns = he_mem_zero(from->column_count, sizeof *to->columns);
    if (to->columns == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the attributes");
    }
    to->column_capacity = from->column_count;
    he_status status = HE_OK;
    for (size_t i = 0; i < from->column_count && status == HE_OK; i++) {
        const he_column *column = from->columns[i];
        if (column != NULL) {
            size_t rows = he_content_issued(to, column->domain);
            status = move_column(from, column, r, rows, &to->columns[to->column_count], err);
            to->column_count += status == HE_OK;
        }
    }
    return status;
}

static he_status make_room(const he_content *from, he_content *to, he_error *err)
{
    he_status status = he_content_reserve_vertices(to, from->vertices.live, err);
    if (status == HE_OK) {
        status = he_content_reserve_edges(to, from->edges.live, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(to, from->faces.live, err);
    }
    if (status == HE_OK) {
        to->vertices.issued = to->vertices.live = from->vertices.live;
        to->edges.issued = to->edges.live = from->edges.live;
        to->faces.issued = to->faces.live = from->faces.live;
        to->boundary_halfedges = from->boundary_halfedges;
    }
    return status;
}

/* Returns an array with the new id of each element that was ever issued, HE_NONE for deleted
 * elements. Returns NULL if memory is out. */
static uint32_t *map_rows(const block *blocks, uint32_t issued)
{
    uint32_t *map = he_mem_array(NULL, issued, sizeof *map);
    if (map != NULL && issued > 0) {
        memset(map, 0xFF, issued * sizeof *map); /* HE_NONE */
        for (size_t at = 0; at < block_count(issued); at++) {
            for (walk w = walk_block(blocks, at); walk_on(&w);) {
                map[w.row] = w.fresh;
            }
        }
    }
    return map;
}

static bool make_maps(const he_content *from, const ranks *r, he_maps *maps)
{
    *maps = (he_maps){.vertex = map_rows(r->vertices, from->vertices.issued),
                      .edge = map_rows(r->edges, from->edges.issued),
                      .face = map_rows(r->faces, from->faces.issued),
                      .vertices = from->vertices.issued,
                      .edges = from->edges.issued,
                      .faces = from->faces.issued};
    return maps->vertex != NULL && maps->edge != NULL && maps->face != NULL;
}

he_status he_compact(he_mesh *mesh, he_maps *out, he_error *err)
{
    const he_content *from = &mesh->c;
    ranks r = {.vertices = rank_rows(from->vertex_halfedge, 1, from->vertices.issued),
               .edges = rank_rows(from->next, 2, from->edges.issued),
               .faces = rank_rows(from->face_halfedge, 1, from->faces.issued)};
    he_maps maps = {0};
    he_mesh *fresh = he_mesh_new();
    he_status status = HE_OK;
    if (r.vertices == NULL || r.edges == NULL || r.faces == NULL || fresh == NULL ||
        (out != NULL && !make_maps(from, &r, &maps))) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to compact the mesh");
        goto out;
    }
    status = make_room(from, &fresh->c, err);
    if (status == HE_OK) {
        status = move_links(from, &r, &fresh->c, mesh->progress, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(mesh->progress, "moving attributes", 1, err);
    }
    if (status == HE_OK) {
        status = move_columns(from, &r, &fresh->c, err);
    }
    if (status == HE_OK) {
        status = he_materials_pack(&from->materials, &fresh->c.materials, err);
    }
    if (status == HE_OK) {
        status = he_mesh_replace(mesh, fresh, HE_RENUMBERS, err);
    }
    if (status == HE_OK) {
        fresh = NULL;
        if (out != NULL) {
            *out = maps;
            maps = (he_maps){0};
        }
    }
out:
    he_mem_free(r.vertices);
    he_mem_free(r.edges);
    he_mem_free(r.faces);
    he_maps_clear(&maps);
    he_mesh_free(fresh);
    return status;
}
