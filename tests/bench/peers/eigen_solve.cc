/* Eigen's program in the benchmark: SimplicialLDLT on the matrices that our program has written. */
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

extern "C" {
#include "bench/side/side.h"
}

namespace
{
using matrix = Eigen::SparseMatrix<double>;
using solver = Eigen::SimplicialLDLT<matrix>;

constexpr int SIDES = 3;

struct entry {
    uint32_t row, column;
    double value;
};

/* Reads a lower triangle, the part of a symmetric matrix that the solver reads. */
matrix read(const bench_side *side, const char *name)
{
    FILE *file = bench_open(side, name, "rb");
    uint32_t sizes[2] = {0, 0};
    std::size_t found = std::fread(sizes, sizeof sizes, 1, file);
    std::vector<entry> entries(sizes[1]);
    found += std::fread(entries.data(), sizeof(entry), entries.size(), file);
    std::fclose(file);
    if (found != 1 + entries.size()) {
        std::fprintf(stderr, "%s cannot be read\n", name);
        std::exit(1);
    }
    std::vector<Eigen::Triplet<double>> triplets;
    for (const entry &e : entries) {
        triplets.emplace_back(static_cast<int>(e.row), static_cast<int>(e.column), e.value);
    }
    const auto n = static_cast<Eigen::Index>(sizes[0]);
    matrix m(n, n);
    m.setFromTriplets(triplets.begin(), triplets.end());
    return m;
}

void require(const solver &f)
{
    if (f.info() != Eigen::Success) {
        std::fprintf(stderr, "Eigen could not factor the matrix\n");
        std::exit(1);
    }
}

void factor_of(const bench_side *side, const char *name, bench_result *out)
{
    const matrix m = read(side, name);
    const double start = bench_seconds();
    const solver f(m);
    out->value = bench_seconds() - start;
    require(f);
    out->amount = static_cast<double>(m.rows());
}

void factor(bench_side *side, bench_result *out)
{
    factor_of(side, "cotangents.bin", out);
}

void factor_biharmonic(bench_side *side, bench_result *out)
{
    factor_of(side, "biharmonic.bin", out);
}

void solve(bench_side *side, bench_result *out)
{
    const matrix m = read(side, "cotangents.bin");
    const solver f(m);
    require(f);
    Eigen::MatrixXd x(m.rows(), SIDES);
    for (Eigen::Index i = 0; i < x.size(); i++) {
        x.data()[i] = std::sin(static_cast<double>(i));
    }
    const double start = bench_seconds();
    x = f.solve(x).eval();
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(m.rows());
    bench_near(out, x.cwiseAbs().sum());
}

const bench_row rows[] = {{"factor", factor},
                          {"factor_biharmonic", factor_biharmonic},
                          {"solve", solve},
                          {nullptr, nullptr}};
} // namespace

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {rows, nullptr};
    return bench_serve(argc, argv, tables);
}
