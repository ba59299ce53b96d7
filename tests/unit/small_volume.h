#pragma once

#include "coupling/homogenisation.h"
#include "coupling/representative_volume.h"
#include "dem/genesis.h"
#include "dem/random.h"

#include <Eigen/QR>

#include <memory>

/// Periodic specimens for tests that need one quickly, and oracles for what their networks answer.
namespace feldspar
{
/// Table 1 in a periodic cell: some 50 grains in 12 × 12 mm, 96 in 16 × 16 mm.
inline Specimen<2> periodic_specimen(const std::uint64_t seed = 1, const double edge = 0.012,
                                     const FlatJointParameters& joint = {.installation_gap_ratio = std::nullopt,
                                                                         .coordination_number = 4.2})
{
  SpecimenParameters wanted;
  wanted.shape = "periodic";
  wanted.width = edge;
  wanted.height = edge;
  return make_specimen<2>(wanted, joint, {}, seed, [](std::string_view, double) {});
}

inline RepresentativeVolume<2> small_volume(const std::uint64_t seed = 1, const EquilibriumParameters& parameters = {},
                                            const double friction = 0.5)
{
  Specimen<2> specimen = periodic_specimen(seed);
  specimen.joints.friction = friction;
  specimen.particle_contact.friction = friction;
  return {std::make_shared<const Network<2>>(specimen), parameters};
}

/// Leads a volume straight to a strain in so many steps; what broke on the way.
inline std::size_t strain_to(RepresentativeVolume<2>& volume, const Voigt<2>& strain, const unsigned int n_steps)
{
  const Voigt<2> start = volume.state().strain;
  std::size_t n_breaks = 0;
  for (unsigned int k = 1; k <= n_steps; ++k)
    {
      auto trial = volume.trial(Voigt<2>(start + double(k) / n_steps * (strain - start)));
      if (!trial.in_equilibrium)
        throw std::runtime_error("no equilibrium");
      n_breaks += trial.breaks.size();
      volume.accept(std::move(trial));
    }
  return n_breaks;
}

inline Voigt<2> random_direction(Random& random)
{
  Voigt<2> direction;
  do
    direction = Voigt<2>::NullaryExpr([&](Eigen::Index) { return random.uniform(-1.0, 1.0); });
  while (direction.norm() > 1.0 || direction.norm() < 0.1);
  return direction.normalized();
}

/// |found - expected| / |expected|.
template <typename Found, typename Expected>
double relative(const Eigen::MatrixBase<Found>& found, const Eigen::MatrixBase<Expected>& expected)
{
  return (found - expected).norm() / expected.norm();
}

/// Condensation by a dense factor with full pivoting, from the links' stiffnesses alone: shares neither iterations nor
/// preconditioner with what it checks. Where grains float the motions of least norm are taken.
struct DirectSolution
{
  DirectSolution(const Network<2>& of, const std::vector<JointStiffness<2>>& link_stiffnesses)
    : network(of)
  {
    const Eigen::Index n = network.n_unknowns();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index c = 0; c < n; ++c)
      {
        const Unknowns unit = Unknowns::Unit(n, c);
        Unknowns column = Unknowns::Zero(n);
        for (std::size_t k = 0; k < link_stiffnesses.size(); ++k)
          add_forces(network.links()[k], link_stiffnesses[k] * link_motion(network.links()[k], unit), column);
        all.col(c) = column;
      }
    const Eigen::Index n_own = n - 3;
    motions = all.topLeftCorner(n_own, n_own).completeOrthogonalDecomposition().solve(-all.topRightCorner(n_own, 3));
    stiffness = (all.bottomRightCorner(3, 3) + all.bottomLeftCorner(3, n_own) * motions) / network.volume();
    affine_stiffness = all.bottomRightCorner(3, 3) / network.volume();
  }

  /// Grains and strain under a strain.
  Unknowns at(const Voigt<2>& strain) const
  {
    Unknowns unknowns(network.n_unknowns());
    unknowns << motions * strain, strain;
    return unknowns;
  }

  const Network<2>& network;
  Eigen::MatrixXd motions; ///< under unit strains
  Stiffness<2> stiffness;
  Stiffness<2> affine_stiffness;
};

inline std::vector<JointStiffness<2>> intact_stiffnesses(const Network<2>& network)
{
  std::vector<JointStiffness<2>> result;
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    result.push_back(network.bonded_stiffness(j));
  return result;
}
} // namespace feldspar
