#pragma once

#include "base/random.h"
#include "coupling/rve/homogenisation.h"
#include "coupling/rve/representative_volume.h"
#include "tests/unit/small_specimen.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

/// Periodic specimens for tests that need one quickly, and oracles for the responses of their networks.
namespace feldspar
{
/// Table 1 in a periodic cell: some 50 grains in 12 × 12 mm, 96 in 16 × 16 mm; 50 spheres in 6 × 6 × 6 mm.
template <int dim = 2, typename Joint = FlatJointParameters>
Specimen<dim> periodic_specimen(const std::uint64_t seed = 1, const double edge = dim == 2 ? 0.012 : 0.006,
                                Joint joint = Joint())
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = edge;
  wanted.height = edge;
  if constexpr (dim == 2)
    joint.coordination_number = 4.2;
  else
    {
      wanted.dimension = 3;
      wanted.porosity = 0.36;
      joint.installation_gap_ratio = 0.05;
    }
  return make_specimen<dim>(wanted, joint, {}, seed);
}

template <int dim = 2>
RepresentativeVolume<dim> small_rve(const std::uint64_t seed = 1, const EquilibriumParameters& parameters = {},
                                    const double friction = 0.5, const Boundary& boundary = {})
{
  Specimen<dim> specimen = periodic_specimen<dim>(seed);
  specimen.joints.friction = friction;
  specimen.particle_contact.friction = friction;
  return {std::make_shared<const Network<dim>>(specimen, Tensor<dim>::Identity(), boundary), parameters};
}

/// Along the last axis.
template <int dim>
Voigt<dim> axial(const double strain)
{
  return strain * Voigt<dim>::Unit(dim - 1);
}

/// Strained along the last axis; nothing holds the other sides.
template <int dim>
Control<dim> with_free_sides(const double strain)
{
  Control<dim> control;
  control.stress_given.fill(true);
  control.stress_given[dim - 1] = false;
  control.strain[dim - 1] = strain;
  return control;
}

/// A run gone to its end.
template <typename Run>
Run at_end(Run run)
{
  while (!run.has_ended())
    run.advance();
  return run;
}

/// The largest stress along the last axis, whatever its sign.
template <typename Record>
double highest_axial_stress(const Record& record)
{
  double highest = 0.0;
  for (const auto& sample : record.samples)
    highest = std::max(highest, std::abs(sample.stress[sample.stress.size() == 3 ? 1 : 2]));
  return highest;
}

/// The balances that hold at every sample of a path, whatever breaks, slides or closes.
template <typename Record>
void expect_balances(const Record& record)
{
  EXPECT_EQ(record.failure, "");
  constexpr double tolerance = EquilibriumParameters{}.final_tolerance;
  for (const auto& sample : record.samples)
    {
      EXPECT_LE(sample.unbalanced_ratio, tolerance);
      EXPECT_LE(sample.energy_imbalance(), 1e-3);
      EXPECT_LE(sample.hill_mandel_residual, 10.0 * tolerance);
    }
}

/// No component is nothing, none is another.
template <int dim>
Voigt<dim> uneven(const double strain)
{
  const double components[] = {0.4, 1.0, -0.6, 0.3, -0.5, 0.2};
  return strain * Eigen::Map<const Voigt<dim>>(components);
}

/// Leads an RVE straight to a strain in so many steps; what broke on the way.
template <int dim>
std::size_t strain_to(RepresentativeVolume<dim>& rve, const std::type_identity_t<Voigt<dim>>& strain,
                      const unsigned int n_steps)
{
  const Voigt<dim> start = rve.state().strain;
  std::size_t n_breaks = 0;
  for (unsigned int k = 1; k <= n_steps; ++k)
    {
      auto trial = rve.trial(Voigt<dim>(start + double(k) / n_steps * (strain - start)));
      if (!trial.in_equilibrium)
        throw std::runtime_error("no equilibrium");
      n_breaks += trial.breaks.size();
      rve.accept(std::move(trial));
    }
  return n_breaks;
}

/// The change of the stress with the strain, bonds frozen, by central differences [Pa]. `step`: so small that no face opens,
/// closes or begins to slide within it.
template <int dim>
Stiffness<dim> stiffness_by_differences(const RepresentativeVolume<dim>& rve, const Voigt<dim>& here,
                                        const double step = 1e-9)
{
  Stiffness<dim> differences;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const Voigt<dim> change = step * Voigt<dim>::Unit(k);
      const auto plus = rve.trial(Voigt<dim>(here + change), Bonds::frozen);
      const auto minus = rve.trial(Voigt<dim>(here - change), Bonds::frozen);
      EXPECT_TRUE(plus.in_equilibrium && minus.in_equilibrium);
      differences.col(k) = (plus.state.stress - minus.state.stress) / (2.0 * step);
    }
  return differences;
}

template <int dim>
Voigt<dim> random_direction(Random& random)
{
  Voigt<dim> direction;
  do
    direction = Voigt<dim>::NullaryExpr([&](Eigen::Index) { return random.uniform(-1.0, 1.0); });
  while (direction.norm() > 1.0 || direction.norm() < 0.1);
  return direction.normalized();
}

/// Forces of the links of a network in small strains, at one of its states.
template <int dim>
LinkForces<dim> link_forces(const Network<dim>& network, const NetworkState<dim>& state)
{
  return Equilibrium<dim>(network, state, {}).link_forces();
}

/// The derivative of the forces of a link, by differences about a motion.
template <int dim>
JointStiffness<dim> derivative_by_differences(const Network<dim>& network, const ActiveLink<dim>& active,
                                              const Motion<dim>& motion)
{
  JointStiffness<dim> derivative;
  for (int c = 0; c < n_motions<dim>; ++c)
    {
      const double by = c < dim ? 1e-12 : 1e-9;
      const Motion<dim> way = by * Motion<dim>::Unit(c);
      derivative.col(c) = (response(network, active, Motion<dim>(motion + way)).forces -
                           response(network, active, Motion<dim>(motion - way)).forces) /
                          (2.0 * by);
    }
  return derivative;
}

/// Expects it of the response there. Forces of some 1e4 N are good to 1e-16 of them, over 2e-12 m.
template <int dim>
void expect_derivative_of_differences(const LinkResponse<dim>& found, const Network<dim>& network,
                                      const ActiveLink<dim>& active, const Motion<dim>& motion)
{
  const JointStiffness<dim> slopes = derivative_by_differences(network, active, motion);
  for (int c = 0; c < n_motions<dim>; ++c)
    EXPECT_LT((found.derivative.col(c) - slopes.col(c)).norm(), 1e-4 * found.derivative.col(c).norm() + 10.0) << c;
}

/// |found - expected| / |expected|.
template <typename Found, typename Expected>
double relative(const Eigen::MatrixBase<Found>& found, const Eigen::MatrixBase<Expected>& expected)
{
  return (found - expected).norm() / expected.norm();
}

/// Condensation by a dense factor with full pivoting, from the links' stiffnesses alone: shares neither iterations nor
/// preconditioner with what it checks. Where grains float the motions of least norm are taken; they lie in the kernel of
/// what the boundary does not admit.
template <int dim>
struct DirectSolution
{
  DirectSolution(const Network<dim>& of, const LinkStiffnesses<dim>& link_stiffnesses)
    : DirectSolution(of, link_stiffnesses, *of.conditions())
  {
  }

  DirectSolution(const Network<dim>& of, const LinkStiffnesses<dim>& link_stiffnesses,
                 const BoundaryConditions<dim>& conditions)
    : network(of)
  {
    constexpr int n_strains = n_voigt<dim>;
    const Eigen::Index n = network.n_unknowns();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index c = 0; c < n; ++c)
      {
        const Unknowns unit = Unknowns::Unit(n, c);
        Unknowns column = Unknowns::Zero(n);
        for (std::size_t k = 0; k < link_stiffnesses.size(); ++k)
          if (link_stiffnesses[k])
            add_forces<dim>(network.links()[k], *link_stiffnesses[k] * link_motion(network.links()[k], unit), column);
        all.col(c) = column;
      }
    const Eigen::Index n_own = n - n_strains;
    const Eigen::MatrixXd kernel = admitted(conditions, n_own);
    const Eigen::MatrixXd of_admitted = kernel.transpose() * all.topLeftCorner(n_own, n_own) * kernel;
    motions = kernel * of_admitted.completeOrthogonalDecomposition().solve(-kernel.transpose() *
                                                                           all.topRightCorner(n_own, n_strains));
    stiffness = (all.bottomRightCorner(n_strains, n_strains) + all.bottomLeftCorner(n_strains, n_own) * motions) /
                network.volume();
    affine_stiffness = all.bottomRightCorner(n_strains, n_strains) / network.volume();
  }

  /// A basis of the motions that the boundary admits.
  Eigen::MatrixXd admitted(const BoundaryConditions<dim>& conditions, const Eigen::Index n_own) const
  {
    if (conditions.are_none())
      return Eigen::MatrixXd::Identity(n_own, n_own);
    std::vector<Eigen::VectorXd> not_admitted;
    const auto moved = [&](const std::uint32_t grain, const int motion) -> Eigen::VectorXd {
      return Eigen::VectorXd::Unit(n_own, n_motions<dim> * Eigen::Index(grain) + motion);
    };
    for (int c = 0; c < dim; ++c)
      {
        for (const std::uint32_t grain : conditions.held())
          not_admitted.push_back(moved(grain, c));
        for (const auto& piece : conditions.pieces())
          {
            not_admitted.push_back(Eigen::VectorXd::Zero(n_own));
            for (const auto& pair : piece)
              not_admitted.back() += pair.share * (moved(pair.image, c) - moved(pair.owner, c));
          }
      }
    if (network.boundary().kind != BoundaryKind::edge)
      for (const auto& piece : conditions.pieces())
        for (const auto& pair : piece)
          for (int turn = dim; turn < n_motions<dim>; ++turn)
            not_admitted.push_back(moved(pair.image, turn) - moved(pair.owner, turn));
    Eigen::MatrixXd rows(Eigen::Index(not_admitted.size()), n_own);
    for (std::size_t k = 0; k < not_admitted.size(); ++k)
      rows.row(Eigen::Index(k)) = not_admitted[k].transpose();
    return rows.fullPivLu().kernel();
  }

  /// Grains and strain under a strain.
  Unknowns at(const Voigt<dim>& strain) const
  {
    Unknowns unknowns(network.n_unknowns());
    unknowns << motions * strain, strain;
    return unknowns;
  }

  const Network<dim>& network;
  Eigen::MatrixXd motions; ///< under unit strains
  Stiffness<dim> stiffness;
  Stiffness<dim> affine_stiffness;
};

template <int dim>
LinkStiffnesses<dim> intact_stiffnesses(const Network<dim>& network)
{
  LinkStiffnesses<dim> result;
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    result.push_back(&network.bonded_stiffness(j));
  return result;
}
} // namespace feldspar
