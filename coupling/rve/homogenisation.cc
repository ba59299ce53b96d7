#include "coupling/rve/homogenisation.h"

#include "dem/specimen/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace feldspar
{
template <int dim>
Tensor<dim> branch_stress(const Network<dim>& network, const LinkForces<dim>& forces)
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t k = 0; k < forces.values.size(); ++k)
    {
      const Link<dim>& link = network.links()[k];
      sum += forces.force(link, k) * link.branch.transpose();
    }
  return sum / network.volume();
}

namespace
{
/// Forces of the links on the grains.
template <int dim>
Eigen::VectorXd on_grains(const Network<dim>& network, const LinkForces<dim>& forces)
{
  Unknowns sum = Unknowns::Zero(network.n_unknowns());
  for (std::size_t k = 0; k < forces.values.size(); ++k)
    if (forces.turns.empty())
      add_forces(network.links()[k], forces.values[k], sum);
    else
      add_forces(network.links()[k], forces.turns[k].gradient, forces.values[k], sum);
  return sum.head(network.n_unknowns() - n_voigt<dim>);
}
} // namespace

template <int dim>
Tensor<dim> boundary_stress(const Network<dim>& network, const BoundaryConditions<dim>& conditions,
                            const LinkForces<dim>& forces)
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t k = 0; k < forces.values.size(); ++k)
    {
      const Link<dim>& link = network.links()[k];
      const Vector<dim> way = shift(PeriodicImage<dim>{link.grain_2, network.boxes_crossed()[k]}, network.cell());
      sum += forces.force(link, k) * way.transpose();
    }
  if (conditions.are_none())
    return sum / network.volume();
  const Eigen::VectorXd held = on_grains(network, forces);
  for (const std::uint32_t grain : conditions.held())
    sum += held.segment<dim>(n_motions<dim> * Eigen::Index(grain)) * network.positions()[grain].transpose();
  const Eigen::VectorXd multipliers = conditions.multipliers(held);
  for (std::size_t p = 0; p < conditions.pieces().size(); ++p)
    for (const auto& pair : conditions.pieces()[p])
      sum += pair.share * multipliers.segment<dim>(dim * Eigen::Index(p)) *
             (network.positions()[pair.image] - network.positions()[pair.owner]).transpose();
  return sum / network.volume();
}

template <int dim>
BorneForces<dim> borne_forces(const Network<dim>& network, const Equilibrium<dim>& at)
{
  BorneForces<dim> forces{at.link_forces(), {}};
  if (const auto& conditions = at.conditions(); conditions.n_multipliers() > 0)
    {
      const Eigen::VectorXd multipliers = conditions.multipliers(on_grains(network, forces.of_links));
      forces.of_boundary = Eigen::VectorXd::Zero(network.n_unknowns() - n_voigt<dim>);
      conditions.add_reactions(multipliers, 1.0, forces.of_boundary);
    }
  return forces;
}

template <int dim>
double hill_mandel_residual(const Network<dim>& network, const NetworkState<dim>& before,
                            const BorneForces<dim>& forces_before, const NetworkState<dim>& after,
                            const BorneForces<dim>& forces_after, const double least_work)
{
  const Unknowns from = unknowns_of(network, before);
  const Unknowns to = unknowns_of(network, after);
  double of_links = 0.0;
  for (const LinkForces<dim>* const forces : {&forces_before.of_links, &forces_after.of_links})
    for (std::size_t k = 0; k < forces->values.size(); ++k)
      {
        const Link<dim>& link = network.links()[k];
        const Motion<dim> motion = forces->turns.empty()
                                     ? Motion<dim>(link_motion(link, to) - link_motion(link, from))
                                     : link_motion(link, forces->turns[k].gradient, Unknowns(to - from));
        of_links += 0.5 * forces->values[k].dot(motion);
      }
  const double of_body = 0.5 * network.volume() * (before.stress + after.stress).dot(after.strain - before.strain);
  double of_boundary = 0.0;
  for (const Eigen::VectorXd* const forces : {&forces_before.of_boundary, &forces_after.of_boundary})
    if (forces->size() > 0)
      of_boundary += 0.5 * forces->dot((to - from).head(forces->size()));
  const double size = std::max(std::abs(of_links) + std::abs(of_body) + std::abs(of_boundary), least_work);
  return size > 0.0 ? std::abs(of_body + of_boundary - of_links) / size : 0.0;
}

template <int dim>
Tensor<dim> fabric(const Network<dim>& network)
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    {
      const Vector<dim> normal = network.links()[j].axes.row(0);
      sum += normal * normal.transpose();
    }
  return sum / double(network.n_joints());
}

template <int dim>
SegmentPlace<dim> segment_place(const Network<dim>& network, const std::size_t joint, const std::size_t segment)
{
  const Link<dim>& link = network.links()[joint];
  return segment_place<dim>(network.positions()[link.grain_1], link.arm_1, link.axes, link.half_length,
                            network.elements()[segment]);
}

template <int dim>
CrackMeasures<dim> crack_measures(const Network<dim>& network, const NetworkState<dim>& state)
{
  double all = 0.0;
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    for (std::uint32_t i = 0; i < network.links()[j].n_segments; ++i)
      all += network.segment_area(network.links()[j], i);
  double area = 0.0;
  CrackMeasures<dim> result{0.0, 0.0, Tensor<dim>::Zero()};
  for (const auto& [segment, shear_stress] : state.unbonded)
    {
      if (segment >= network.n_segments() || std::ranges::binary_search(network.unbonded(), segment))
        continue; // in contact without a face, or unbonded from the start
      const Link<dim>& link = network.links()[network.link_of_segment(segment)];
      const double of_segment = network.segment_area(link, segment - link.first_segment);
      const Vector<dim> normal = link.axes.row(0);
      area += of_segment;
      result.orientation += of_segment / network.volume() * normal * normal.transpose();
    }
  result.area_share = area / all;
  result.density = area / network.volume();
  return result;
}

template <int dim>
std::size_t n_fragments(const Network<dim>& network, const NetworkState<dim>& state)
{
  std::vector<std::uint32_t> n_unbonded(network.n_joints(), 0);
  for (const auto& unbonded : state.unbonded)
    if (const auto link = network.link_of_segment(unbonded.segment); link < network.n_joints())
      ++n_unbonded[link];

  DisjointSets sets(network.n_grains());
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    if (const Link<dim>& link = network.links()[j]; n_unbonded[j] < link.n_segments)
      sets.merge(link.grain_1, link.grain_2);
  const std::vector<std::uint32_t> n_members = sets.sizes();
  return std::size_t(std::ranges::count_if(n_members, [](const auto n) { return n > 1; }));
}

template <int dim>
IsotropicConstants isotropic_constants(const Stiffness<dim>& stiffness)
{
  // Projections on the spherical and the deviatoric part; in Mandel's components the norm is that of the tensor.
  Stiffness<dim> mandel = stiffness;
  for (int k = dim; k < n_voigt<dim>; ++k)
    {
      mandel.row(k) *= std::numbers::sqrt2;
      mandel.col(k) *= std::numbers::sqrt2;
    }
  Stiffness<dim> spherical = Stiffness<dim>::Zero();
  spherical.template topLeftCorner<dim, dim>().setConstant(1.0 / dim);
  const Stiffness<dim> deviatoric = Stiffness<dim>::Identity() - spherical;
  IsotropicConstants result{};
  result.bulk_modulus = mandel.cwiseProduct(spherical).sum() / dim;
  result.shear_modulus = mandel.cwiseProduct(deviatoric).sum() / (2.0 * (n_voigt<dim> - 1));
  const double K = result.bulk_modulus;
  const double G = result.shear_modulus;
  result.youngs_modulus = dim == 2 ? 4.0 * K * G / (K + G) : 9.0 * K * G / (3.0 * K + G);
  result.poissons_ratio = dim == 2 ? (K - G) / (K + G) : (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G));
  result.anisotropy = (mandel - dim * K * spherical - 2.0 * G * deviatoric).norm() / mandel.norm();
  return result;
}

template decltype(branch_stress<2>) branch_stress<2>;
template decltype(boundary_stress<2>) boundary_stress<2>;
template decltype(borne_forces<2>) borne_forces<2>;
template decltype(hill_mandel_residual<2>) hill_mandel_residual<2>;
template decltype(fabric<2>) fabric<2>;
template SegmentPlace<2> segment_place<2>(const Network<2>&, std::size_t, std::size_t);
template decltype(crack_measures<2>) crack_measures<2>;
template decltype(n_fragments<2>) n_fragments<2>;
template decltype(isotropic_constants<2>) isotropic_constants<2>;
template decltype(branch_stress<3>) branch_stress<3>;
template decltype(boundary_stress<3>) boundary_stress<3>;
template decltype(borne_forces<3>) borne_forces<3>;
template decltype(hill_mandel_residual<3>) hill_mandel_residual<3>;
template decltype(fabric<3>) fabric<3>;
template SegmentPlace<3> segment_place<3>(const Network<3>&, std::size_t, std::size_t);
template decltype(crack_measures<3>) crack_measures<3>;
template decltype(n_fragments<3>) n_fragments<3>;
template decltype(isotropic_constants<3>) isotropic_constants<3>;
} // namespace feldspar
