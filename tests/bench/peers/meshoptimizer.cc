/* meshoptimizer's program in the benchmark: only decimation, of an indexed triangle list in
 * floats. */
#include <meshoptimizer.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

extern "C" {
#include "bench/side/side.h"
}

namespace
{
/* Writes the result in binary PLY, as the other programs do. */
void write(const bench_side *side, const std::vector<float> &points,
           const std::vector<unsigned> &corners)
{
    char path[512];
    bench_path(side, "decimated.ply", path, sizeof path);
    FILE *file = std::fopen(path, "wb");
    if (file == nullptr) {
        std::fprintf(stderr, "%s cannot be written\n", path);
        std::exit(1);
    }
    std::fprintf(file,
                 "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\n"
                 "property float y\nproperty float z\nelement face %zu\n"
                 "property list uchar int vertex_indices\nend_header\n",
                 points.size() / 3, corners.size() / 3);
    std::fwrite(points.data(), sizeof points[0], points.size(), file);
    for (size_t i = 0; i < corners.size(); i += 3) {
        std::fputc(3, file);
        std::fwrite(&corners[i], sizeof corners[0], 3, file);
    }
    std::fclose(file);
}

/* Decimates to a tenth of the faces. Vertices that are no longer used stay in the file. */
void decimate(bench_side *side, bench_result *out)
{
    const bench_input &in = side->input;
    size_t corners = 3 * static_cast<size_t>(in.faces);
    std::vector<float> points(in.positions, in.positions + 3 * static_cast<size_t>(in.vertices));
    std::vector<unsigned> kept(corners);
    double start = bench_seconds();
    kept.resize(meshopt_simplify(kept.data(), in.corners, corners, points.data(), in.vertices,
                                 3 * sizeof(float), corners / 10, 1e9f, 0, nullptr));
    out->value = bench_seconds() - start;
    out->amount = in.faces;
    bench_near(out, static_cast<double>(kept.size() / 3));
    write(side, points, kept);
}

const bench_row rows[] = {{"decimate", decimate}, {nullptr, nullptr}};
} // namespace

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {rows, nullptr};
    return bench_serve(argc, argv, tables);
}
