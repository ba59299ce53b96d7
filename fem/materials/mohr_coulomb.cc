#include "fem/materials/mohr_coulomb.h"

#include "base/byte_archive.h"
#include "fem/materials/linear_elasticity.h"

#include <Eigen/Dense>

#include <cmath>
#include <memory>
#include <optional>

namespace feldspar::fem
{
template <typename Archive>
void transfer(Archive& archive, MohrCoulombState& state)
{
  for (double& component : state.plastic_strain)
    archive.value("plastic_strain", component);
  archive.value("dissipated", state.dissipated);
  archive.value("stored", state.stored);
}

namespace
{
using Principal = Eigen::Vector3d; ///< σ_1 ≥ σ_2 ≥ σ_3, or strains along the same axes

struct PrincipalUpdate
{
  Principal stress;
  Eigen::Matrix3d tangent; ///< dσ_i/dε_j
  int n_active;            ///< planes of the yield surface that the stress lies on; 3 at the apex
};

/// The plane k σ_i - σ_j = q_u, as its normal and that of the plastic potential.
struct YieldPlane
{
  Principal normal;
  Principal flow;
};

struct YieldSurface
{
  double k;   ///< (1 + sin φ)/(1 - sin φ)
  double m;   ///< the same with ψ
  double q_u; ///< uniaxial compressive strength [Pa]

  explicit YieldSurface(const MohrCoulombParameters& parameters)
    : k(ratio(parameters.friction_angle))
    , m(ratio(parameters.dilation_angle))
    , q_u(2.0 * parameters.cohesion * std::sqrt(k))
  {
  }

  static double ratio(const double angle) { return (1.0 + std::sin(angle)) / (1.0 - std::sin(angle)); }

  YieldPlane plane(const int greatest, const int least) const
  {
    YieldPlane plane{Principal::Zero(), Principal::Zero()};
    plane.normal[greatest] = k;
    plane.flow[greatest] = m;
    plane.normal[least] = plane.flow[least] = -1.0;
    return plane;
  }
};

bool in_order(const Principal& stress, const double round_off)
{
  return stress[0] >= stress[1] - round_off && stress[1] >= stress[2] - round_off;
}

/// Koiter's return to the planes given: σ = σ' - D B (Aᵀ D B)⁻¹ f. Nothing where a multiplier comes out negative.
template <int n>
std::optional<PrincipalUpdate> return_to(const std::array<YieldPlane, n>& planes, const double q_u,
                                         const Eigen::Matrix3d& D, const Principal& trial)
{
  Eigen::Matrix<double, 3, n> A, B;
  for (int i = 0; i < n; ++i)
    {
      A.col(i) = planes[i].normal;
      B.col(i) = planes[i].flow;
    }
  const Eigen::Matrix<double, n, 1> excess = (A.transpose() * trial).array() - q_u;
  const Eigen::Matrix<double, n, n> inverse = (A.transpose() * D * B).inverse();
  if (((inverse * excess).array() < 0.0).any())
    return std::nullopt;
  const Eigen::Matrix<double, 3, n> towards = D * B * inverse;
  return PrincipalUpdate{trial - towards * excess, D - towards * A.transpose() * D, n};
}

PrincipalUpdate principal_update(const YieldSurface& yield, const Eigen::Matrix3d& D, const Principal& trial)
{
  const double round_off = 1e-12 * (trial.cwiseAbs().maxCoeff() + yield.q_u);
  const YieldPlane main = yield.plane(0, 2);
  if (main.normal.dot(trial) <= yield.q_u)
    return {trial, D, 0};
  if (const auto onto_plane = return_to<1>({main}, yield.q_u, D, trial);
      onto_plane && in_order(onto_plane->stress, round_off))
    return *onto_plane;
  // Beyond an edge, where σ_1 = σ_2 or σ_2 = σ_3, the neighbouring plane is active too.
  for (const YieldPlane& neighbour : {yield.plane(1, 2), yield.plane(0, 1)})
    if (const auto onto_edge = return_to<2>({main, neighbour}, yield.q_u, D, trial);
        onto_edge && in_order(onto_edge->stress, round_off))
      return *onto_edge;
  return {Principal::Constant(yield.q_u / (yield.k - 1.0)), Eigen::Matrix3d::Zero(), 3};
}

/// Voigt stress in the sample's axes from Voigt stress in the axes given as columns; its transpose takes strains the
/// other way.
Eigen::Matrix<double, 6, 6> stress_rotation(const Eigen::Matrix3d& axes)
{
  Eigen::Matrix<double, 6, 6> rotation;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
      {
        const auto [i, j] = voigt_pair<3>(a);
        const auto [k, l] = voigt_pair<3>(b);
        const double once = axes(i, k) * axes(j, l);
        const double crossed = axes(i, l) * axes(j, k);
        rotation(a, b) = b < 3 ? once : once + crossed;
      }
  return rotation;
}

/// The derivative of an isotropic tensor function, in its principal axes (Voigt): between two axes shear turns the
/// principal axes of the stress, by (σ_i - σ_j) over the difference of the trial strains.
Eigen::Matrix<double, 6, 6> tangent_in_principal_axes(const PrincipalUpdate& update, const Principal& trial, double G)
{
  Eigen::Matrix<double, 6, 6> tangent = Eigen::Matrix<double, 6, 6>::Zero();
  tangent.topLeftCorner<3, 3>() = update.tangent;
  for (int shear = 0; shear < 3; ++shear)
    {
      const auto [i, j] = voigt_pair<3>(3 + shear);
      const double trial_difference = trial[i] - trial[j];
      const double round_off = 1e-9 * trial.cwiseAbs().maxCoeff();
      const double share = std::abs(trial_difference) > round_off
                             ? (update.stress[i] - update.stress[j]) / trial_difference
                             : (update.tangent(i, i) - update.tangent(j, i)) / (2.0 * G);
      tangent(3 + shear, 3 + shear) = G * share;
    }
  return tangent;
}

class MohrCoulombPoint : public MaterialPoint<3>
{
public:
  explicit MohrCoulombPoint(const MohrCoulombParameters& its_parameters)
    : parameters(its_parameters)
  {
  }

  MaterialResponse<3> trial(const StrainVector<3>& strain) const override
  {
    return update(parameters, state, strain).response;
  }
  void accept(const StrainVector<3>& strain) override { state = update(parameters, state, strain).state; }
  std::string stored() const override { return to_bytes(state); }
  void restore(const std::string& stored) override { state = from_bytes<MohrCoulombState>(stored); }
  std::optional<PointEnergies> energies() const override
  {
    return PointEnergies{.stored = state.stored, .slip = state.dissipated};
  }
  std::vector<double> fields() const override
  {
    // √(2/3 ε:ε), equal to the axial one in uniaxial flow that keeps the volume.
    const auto& strain = state.plastic_strain;
    const double squared = strain.head<3>().squaredNorm() + 0.5 * strain.tail<3>().squaredNorm();
    return {std::sqrt(2.0 / 3.0 * squared), state.dissipated};
  }

private:
  MohrCoulombParameters parameters;
  MohrCoulombState state;
};
} // namespace

MohrCoulombUpdate update(const MohrCoulombParameters& parameters, const MohrCoulombState& old,
                         const StrainVector<3>& strain)
{
  if (!strain.allFinite())
    throw PointFailure("the strain is not finite");
  const StiffnessMatrix<3> C = isotropic_stiffness<3>(parameters.youngs_modulus, parameters.poissons_ratio);
  const StressVector<3> s = C * (strain - old.plastic_strain);
  const YieldSurface yield(parameters);
  Eigen::Matrix3d stress;
  stress << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(stress);
  const Principal trial = principal.eigenvalues().reverse();
  const Eigen::Matrix3d axes = principal.eigenvectors().rowwise().reverse();

  const PrincipalUpdate updated = principal_update(yield, C.topLeftCorner<3, 3>(), trial);
  if (updated.stress == trial)
    return {{s, C}, {old.plastic_strain, old.dissipated, 0.5 * s.dot(strain - old.plastic_strain)}};
  const Eigen::Matrix<double, 6, 6> rotation = stress_rotation(axes);
  MohrCoulombUpdate result;
  result.response.stress = rotation.leftCols<3>() * updated.stress;
  result.response.tangent = rotation * tangent_in_principal_axes(updated, trial, C(3, 3)) * rotation.transpose();
  if (updated.n_active > 1)
    result.response.tangent += elastic_share * (C - result.response.tangent);
  const StrainVector<3> flow = C.ldlt().solve(s - result.response.stress);
  result.state.plastic_strain = old.plastic_strain + flow;
  result.state.dissipated = old.dissipated + result.response.stress.dot(flow);
  result.state.stored = 0.5 * result.response.stress.dot(strain - result.state.plastic_strain);
  return result;
}

Material<3> mohr_coulomb(const MohrCoulombParameters& parameters)
{
  const auto& [E, nu, c, phi, psi] = parameters;
  if (!(E > 0.0 && nu > -1.0 && nu < 0.5 && c >= 0.0 && phi >= 0.0 && phi < 0.5 * EIGEN_PI && psi >= 0.0 && psi <= phi))
    throw std::invalid_argument("Mohr-Coulomb: a parameter is out of its range");
  if (c == 0.0 && phi == 0.0)
    throw std::invalid_argument("Mohr-Coulomb: a rock needs cohesion or friction");
  return {[parameters](const PointPlace&) { return std::make_unique<MohrCoulombPoint>(parameters); },
          {"equivalent_plastic_strain", "dissipation_J_per_m3"}};
}
} // namespace feldspar::fem
