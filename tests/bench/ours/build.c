/* Benchmark rows: building a mesh from arrays. */
#include "bench/ours/ours.h"
#include "mesh/walk.h"

#include <stdio.h>
#include <stdlib.h>

void bench_require(he_status status)
{
    if (status != HE_OK) {
        fprintf(stderr, "%s\n", he_status_title(status));
        exit(1);
    }
}

he_soup bench_soup(const bench_side *side)
{
    he_soup soup;
    const bench_input *in = &side->input;
    he_soup_init(&soup, NULL);
    soup.positions = (he_vec3 *)in->positions;
    soup.vertex_count = soup.vertex_capacity = in->vertices;
    soup.corners = in->corners;
    soup.corner_count = soup.corner_capacity = (size_t)in->faces * in->degree;
    soup.starts = in->starts;
    soup.face_count = soup.face_capacity = in->faces;
    return soup;
}

he_mesh *bench_mesh(bench_side *side)
{
    if (side->mesh == NULL) {
        he_mesh *mesh;
        he_soup soup = bench_soup(side);
        bench_require(he_build(&soup, 0, &mesh, NULL, NULL));
        side->mesh = mesh;
    }
    return side->mesh;
}

uint64_t bench_mesh_hash(const he_mesh *m)
{
    enum { MOST_CORNERS = 16 };
    uint64_t hash = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_face_is_live(m, (he_face){f})) {
            uint32_t corners[MOST_CORNERS];
            size_t degree = 0;
            he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
            do {
                corners[degree++] = he_origin(m, h).i;
                h = he_next(m, h);
            } while (h.i != first.i && degree < MOST_CORNERS);
            hash += bench_face_hash(corners, degree);
        }
    }
    return bench_counts(hash, he_mesh_vertices(m), he_mesh_edges(m), he_mesh_faces(m));
}

static void build(bench_side *side, bench_result *out)
{
    he_mesh *mesh;
    he_soup soup = bench_soup(side);
    double start = bench_seconds();
    bench_require(he_build(&soup, 0, &mesh, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, bench_mesh_hash(mesh));
    he_mesh_free(mesh);
}

const bench_row bench_build_rows[] = {{"build", build}, {NULL, NULL}};
