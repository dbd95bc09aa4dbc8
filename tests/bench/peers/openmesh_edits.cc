/* Many small edits in random places with OpenMesh, and compacting the mesh afterwards. */
#include "bench/peers/openmesh.h"

namespace
{
enum { SPLITS = 300000, FLIPS = 1000000, COLLAPSES = 300000 };

std::vector<TriMesh::HalfedgeHandle> find_picks(const bench_side *side, const TriMesh &mesh,
                                                uint32_t count)
{
    bench_pick *picks = bench_picks(&side->input, &count);
    std::vector<TriMesh::HalfedgeHandle> found(count);
    for (uint32_t i = 0; i < count; i++) {
        TriMesh::HalfedgeHandle h =
            mesh.halfedge_handle(TriMesh::FaceHandle(static_cast<int>(picks[i].face)));
        int from = static_cast<int>(side->input.corners[3 * picks[i].face + picks[i].corner]);
        while (mesh.from_vertex_handle(h).idx() != from) {
            h = mesh.next_halfedge_handle(h);
        }
        found[i] = h;
    }
    std::free(picks);
    return found;
}

void split(bench_side *side, bench_result *out)
{
    TriMesh mesh = mesh_of<TriMesh>(side);
    std::vector<TriMesh::HalfedgeHandle> picks = find_picks(side, mesh, SPLITS);
    double start = bench_seconds();
    for (TriMesh::HalfedgeHandle h : picks) {
        TriMesh::Point p =
            (mesh.point(mesh.from_vertex_handle(h)) + mesh.point(mesh.to_vertex_handle(h))) * 0.5;
        mesh.split(mesh.edge_handle(h), p);
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(picks.size());
    bench_exact(out, mesh_hash(mesh));
}

void flip(bench_side *side, bench_result *out)
{
    TriMesh mesh = mesh_of<TriMesh>(side);
    std::vector<TriMesh::HalfedgeHandle> picks = find_picks(side, mesh, FLIPS);
    uint64_t done = 0;
    double start = bench_seconds();
    for (TriMesh::HalfedgeHandle h : picks) {
        TriMesh::EdgeHandle e = mesh.edge_handle(h);
        if (mesh.is_flip_ok(e)) {
            mesh.flip(e);
            done++;
        }
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(picks.size());
    bench_exact(out, mesh_hash(mesh));
    bench_near(out, static_cast<double>(done));
}

/* Returns the time of all collapses, and sets `done` to their number. */
double collapse_all(const bench_side *side, TriMesh &mesh, size_t *picked, uint64_t *done)
{
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    std::vector<TriMesh::HalfedgeHandle> picks = find_picks(side, mesh, COLLAPSES);
    *picked = picks.size();
    *done = 0;
    double start = bench_seconds();
    for (TriMesh::HalfedgeHandle h : picks) {
        if (!mesh.status(mesh.edge_handle(h)).deleted() && mesh.is_collapse_ok(h)) {
            mesh.collapse(h);
            ++*done;
        }
    }
    return bench_seconds() - start;
}

void collapse(bench_side *side, bench_result *out)
{
    TriMesh mesh = mesh_of<TriMesh>(side);
    size_t picked;
    uint64_t done;
    out->value = collapse_all(side, mesh, &picked, &done);
    out->amount = static_cast<double>(picked);
    bench_exact(out, mesh_hash(mesh));
    bench_near(out, static_cast<double>(done));
}

void compact(bench_side *side, bench_result *out)
{
    TriMesh mesh = mesh_of<TriMesh>(side);
    size_t picked;
    uint64_t done;
    collapse_all(side, mesh, &picked, &done);
    double start = bench_seconds();
    mesh.garbage_collection();
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, static_cast<double>(mesh.n_faces()));
    uint64_t hash = 0;
    for (auto f : mesh.faces()) {
        uint32_t corners[3];
        TriMesh::HalfedgeHandle h = mesh.halfedge_handle(f);
        for (uint32_t &corner : corners) {
            const TriMesh::Point &p = mesh.point(mesh.from_vertex_handle(h));
            corner = bench_place_hash(p[0], p[1], p[2]);
            h = mesh.next_halfedge_handle(h);
        }
        hash += bench_face_hash(corners, 3);
    }
    bench_exact(out, bench_counts(hash, mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()));
}
} // namespace

const bench_row openmesh_edit_rows[] = {{"split", split},
                                        {"flip", flip},
                                        {"collapse", collapse},
                                        {"compact", compact},
                                        {nullptr, nullptr}};
