/* Many small edits in random places with CGAL, and compacting the mesh afterwards. */
#include "bench/peers/cgal.h"

#include <CGAL/boost/graph/Euler_operations.h>

namespace
{
namespace Euler = CGAL::Euler;

enum { SPLITS = 300000, FLIPS = 1000000, COLLAPSES = 300000 };

std::vector<Halfedge> find_picks(const bench_side *side, const Mesh &mesh, uint32_t count)
{
    bench_pick *picks = bench_picks(&side->input, &count);
    std::vector<Halfedge> found(count);
    for (uint32_t i = 0; i < count; i++) {
        Halfedge h = mesh.halfedge(Face(picks[i].face));
        Vertex from(side->input.corners[3 * picks[i].face + picks[i].corner]);
        while (mesh.source(h) != from) {
            h = mesh.next(h);
        }
        found[i] = h;
    }
    std::free(picks);
    return found;
}

void split(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    std::vector<Halfedge> picks = find_picks(side, mesh, SPLITS);
    double start = bench_seconds();
    for (Halfedge h : picks) {
        Point p = CGAL::midpoint(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
        /* The new half-edge ends at the new vertex, where h begins afterwards. */
        Halfedge before = Euler::split_edge(h, mesh);
        mesh.point(mesh.target(before)) = p;
        Euler::split_face(before, mesh.next(h), mesh);
        Halfedge back = mesh.opposite(h);
        Euler::split_face(back, mesh.next(mesh.next(back)), mesh);
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(picks.size());
    bench_exact(out, cgal_hash(mesh));
}

/* Tests the preconditions of flip_edge, which CGAL leaves to the caller. */
bool is_flip_ok(const Mesh &mesh, Halfedge h)
{
    Halfedge back = mesh.opposite(h);
    if (mesh.is_border(h) || mesh.is_border(back)) {
        return false;
    }
    Vertex c = mesh.target(mesh.next(h)), d = mesh.target(mesh.next(back));
    return c != d && mesh.halfedge(c, d) == Mesh::null_halfedge();
}

void flip(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    std::vector<Halfedge> picks = find_picks(side, mesh, FLIPS);
    uint64_t done = 0;
    double start = bench_seconds();
    for (Halfedge h : picks) {
        if (is_flip_ok(mesh, h)) {
            Euler::flip_edge(h, mesh);
            done++;
        }
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(picks.size());
    bench_exact(out, cgal_hash(mesh));
    bench_near(out, static_cast<double>(done));
}

/* Returns the time of all collapses, and sets `done` to their number. Of the two edges that become
 * one beside the face on the right, CGAL keeps the one whose number the others drop. Later picks of
 * those numbers therefore mean other edges, and only how many collapses were possible can be
 * compared. */
double collapse_all(const bench_side *side, Mesh &mesh, size_t *picked, uint64_t *done)
{
    std::vector<Halfedge> picks = find_picks(side, mesh, COLLAPSES);
    *picked = picks.size();
    *done = 0;
    double start = bench_seconds();
    for (Halfedge h : picks) {
        Edge e(h);
        if (!mesh.is_removed(e) && Euler::does_satisfy_link_condition(e, mesh)) {
            Euler::collapse_edge(e, mesh);
            ++*done;
        }
    }
    return bench_seconds() - start;
}

void collapse(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    size_t picked;
    uint64_t done;
    out->value = collapse_all(side, mesh, &picked, &done);
    out->amount = static_cast<double>(picked);
    bench_near(out, static_cast<double>(done));
}

void compact(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    size_t picked;
    uint64_t done;
    collapse_all(side, mesh, &picked, &done);
    double start = bench_seconds();
    mesh.collect_garbage();
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, mesh.number_of_faces());
}
} // namespace

const bench_row cgal_edit_rows[] = {{"split", split},
                                    {"flip", flip},
                                    {"collapse", collapse},
                                    {"compact", compact},
                                    {nullptr, nullptr}};
