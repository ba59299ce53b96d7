// A damaged representative volume is solved with a factor of its network: ours, in blocks of the motions of two grains,
// beside those of Eigen and CHOLMOD of the same matrix, on one core. Some 400 discs, some 100 spheres as in published
// samples, and some 600.

#include "benchmarks/on_one_thread.h"
#include "coupling/network/network.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>

#include <map>

namespace feldspar
{
namespace
{
template <int dim>
const Network<dim>& network(const double width)
{
  static std::map<double, Network<dim>> known;
  if (const auto found = known.find(width); found != known.end())
    return found->second;
  SpecimenParameters wanted;
  wanted.dimension = dim;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = width;
  wanted.porosity = dim == 2 ? 0.16 : 0.36;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  return known.try_emplace(width, make_specimen<dim>(wanted, joint, {}, 1)).first->second;
}

constexpr double relative_shift = 1e-6; // of the diagonal, so that nothing floats

template <int dim>
auto pattern_of_joints(const Network<dim>& of)
{
  return std::make_shared<const StiffnessPattern>(of.links(), of.n_grains(),
                                                  [&](const std::uint32_t link) { return link < of.n_joints(); });
}

template <int dim>
BlockFactor<dim> stiffness(const Network<dim>& of, const std::shared_ptr<const StiffnessPattern>& pattern)
{
  BlockFactor<dim> matrix(pattern);
  for (std::uint32_t k = 0; k < of.n_joints(); ++k)
    matrix.add(of.links()[k], of.bonded_stiffness(k));
  for (std::size_t i = 0; i < of.n_grains(); ++i)
    for (int c = 0; c < n_motions<dim>; ++c)
      matrix.set_diagonal(i, c, (1.0 + relative_shift) * matrix.diagonal(i, c));
  return matrix;
}

template <int dim>
Eigen::SparseMatrix<double> sparse_stiffness(const Network<dim>& of)
{
  constexpr int n = n_motions<dim>;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::uint32_t k = 0; k < of.n_joints(); ++k)
    {
      const Link<dim>& link = of.links()[k];
      const Eigen::Matrix<double, 2 * n, 2 * n> of_link =
        link.by_grains.transpose() * of.bonded_stiffness(k) * link.by_grains;
      const auto motion = [&](const int i) { return n * int(i < n ? link.grain_1 : link.grain_2) + i % n; };
      for (int r = 0; r < 2 * n; ++r)
        for (int c = 0; c < 2 * n; ++c)
          entries.emplace_back(motion(r), motion(c), of_link(r, c));
    }
  const auto size = Eigen::Index(n) * Eigen::Index(of.n_grains());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  for (Eigen::Index i = 0; i < size; ++i)
    matrix.coeffRef(i, i) *= 1.0 + relative_shift;
  return matrix;
}

using OfEigen = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
using OfCholmod = Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>>;

template <int dim>
void block_factorise(benchmark::State& state)
{
  const auto& of = network<dim>(1e-4 * double(state.range(0)));
  const auto pattern = pattern_of_joints(of);
  for (auto _ : state)
    {
      BlockFactor<dim> matrix = stiffness(of, pattern);
      matrix.factorise();
      benchmark::DoNotOptimize(matrix);
    }
  state.counters["grains"] = double(of.n_grains());
}

template <int dim>
void block_solve(benchmark::State& state)
{
  const auto& of = network<dim>(1e-4 * double(state.range(0)));
  const auto pattern = pattern_of_joints(of);
  BlockFactor<dim> matrix = stiffness(of, pattern);
  matrix.factorise();
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n_motions<dim> * Eigen::Index(of.n_grains()), -1.0, 1.0);
  for (auto _ : state)
    benchmark::DoNotOptimize(Eigen::VectorXd(matrix.solve(x)));
}

/// The pattern is analysed once, as ours is.
template <int dim, typename Factor>
void library_factorise(benchmark::State& state)
{
  const auto matrix = sparse_stiffness(network<dim>(1e-4 * double(state.range(0))));
  Factor factor(matrix);
  for (auto _ : state)
    factor.factorize(matrix);
}

template <int dim, typename Factor>
void library_solve(benchmark::State& state)
{
  const auto matrix = sparse_stiffness(network<dim>(1e-4 * double(state.range(0))));
  const Factor factor(matrix);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
  for (auto _ : state)
    benchmark::DoNotOptimize(Eigen::VectorXd(factor.solve(x)));
}

#define FELDSPAR_FACTORS(dim, width)                                                                                   \
  BENCHMARK(block_factorise<dim>)->Arg(width);                                                                         \
  BENCHMARK(library_factorise<dim, OfEigen>)->Arg(width);                                                              \
  BENCHMARK(library_factorise<dim, OfCholmod>)->Arg(width);                                                            \
  BENCHMARK(block_solve<dim>)->Arg(width);                                                                             \
  BENCHMARK(library_solve<dim, OfEigen>)->Arg(width);                                                                  \
  BENCHMARK(library_solve<dim, OfCholmod>)->Arg(width)

FELDSPAR_FACTORS(2, 325); // width of the cell in tenths of a millimetre
FELDSPAR_FACTORS(3, 74);
FELDSPAR_FACTORS(3, 133);
} // namespace
} // namespace feldspar

int main(int argc, char** argv) { return feldspar::run_on_one_thread(argc, argv); }
