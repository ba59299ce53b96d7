#include "coupling/network/network.h"

#include "base/parameter_id.h"
#include "coupling/network/conjugate_gradients.h"
#include "coupling/network/open_cell.h"
#include "coupling/network/rigid_motions.h"
#include "dem/laws/contact_motion.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/parameters.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace feldspar
{
namespace
{
constexpr double touch_search_ratio = 0.5; // largest gap of a pair that may come into contact, over the mean radius
constexpr double largest_residual = 1e-8;  // of the intact solutions, over the forces under unit strains
constexpr double regularity = 1e-9;        // of the factor's diagonal: grains may float, the body may shift
// An open body may also turn; its tractions stop that, and what regularises must not drown in the difference.
constexpr double regularity_of_open_cells = 1e-6;

/// Axes n, t (n, t_1, t_2) of a contact as rows; in space t_1 is any vector across n, the same for the same n.
Tensor<2> contact_axes(const Vector<2>& normal)
{
  Tensor<2> axes;
  axes << normal[0], normal[1], -normal[1], normal[0];
  return axes;
}

Tensor<3> contact_axes(const Vector<3>& normal, const Vector<3>& tangent)
{
  Tensor<3> axes;
  axes << normal.transpose(), tangent.transpose(), normal.cross(tangent).transpose();
  return axes;
}

Tensor<3> contact_axes(const Vector<3>& normal)
{
  const auto tangent = space::tangent_to({normal[0], normal[1], normal[2]});
  return contact_axes(normal, Vector<3>(tangent[0], tangent[1], tangent[2]));
}

/// Bond stress that belongs to a normal and shear stress.
template <int dim>
BondStress bond_stress(const Vector<dim>& stress)
{
  return {stress[0], stress[0], stress.template tail<dim - 1>().norm()};
}

/// Axes of a joint; in space the elements of a face lie by its own tangent.
template <int dim>
Tensor<dim> joint_axes(const Joints<dim>& joints, const std::size_t joint)
{
  const Vector<dim> normal = at<dim>(joints.normal, joint);
  if constexpr (dim == 2)
    return contact_axes(normal);
  else
    return contact_axes(normal, at<dim>(joints.tangent, joint));
}

/// The gradients of a link with these axes, arms and branch; docs/theory.md §9.1.
template <int dim>
LinkGradient<dim> link_gradient(const Link<dim>& link)
{
  LinkGradient<dim> gradient = LinkGradient<dim>::Zero();
  auto of_1 = gradient.template leftCols<n_motions<dim>>();
  auto of_2 = gradient.template rightCols<n_motions<dim>>();
  of_1.template topLeftCorner<dim, dim>() = -link.axes;
  of_2.template topLeftCorner<dim, dim>() = link.axes;
  // U of the contact point: a turn φ adds φ × (a_1 n) to the one side and φ × (-a_2 n) to the other.
  if constexpr (dim == 2)
    {
      of_1(1, 2) = -link.arm_1;
      of_2(1, 2) = -link.arm_2;
      of_1(2, 2) = -1.0;
      of_2(2, 2) = 1.0;
    }
  else
    {
      const auto about_t1 = link.axes.row(1);
      const auto about_t2 = link.axes.row(2);
      of_1.template block<1, 3>(1, 3) = -link.arm_1 * about_t2;
      of_1.template block<1, 3>(2, 3) = link.arm_1 * about_t1;
      of_2.template block<1, 3>(1, 3) = -link.arm_2 * about_t2;
      of_2.template block<1, 3>(2, 3) = link.arm_2 * about_t1;
      of_1.template bottomRightCorner<3, 3>() = -link.axes;
      of_2.template bottomRightCorner<3, 3>() = link.axes;
    }
  return gradient;
}

template <int dim>
LinkStrainGradient<dim> link_strain_gradient(const Link<dim>& link)
{
  LinkStrainGradient<dim> gradient = LinkStrainGradient<dim>::Zero();
  for (int k = 0; k < n_voigt<dim>; ++k)
    gradient.template block<dim, 1>(0, k) = link.axes * (strain_tensor<dim>(Voigt<dim>::Unit(k)) * link.branch);
  return gradient;
}
} // namespace

template <int dim>
Network<dim>::Network(const Specimen<dim>& specimen, const Tensor<dim>& rotation, const Boundary& wanted)
  : its_boundary(wanted)
  , number_of_own_grains(specimen.grains.size())
  , number_of_grains(number_of_own_grains)
  , number_of_joints(specimen.joints.size())
  , cell_volume(specimen.volume())
  , plane_thickness(specimen.thickness)
  , joint_law(specimen.joints.law)
  , edges(specimen.cell())
  , face(specimen.joints.elements)
  , grain_radii(specimen.grains.radius)
{
  if (!specimen.is_periodic())
    throw ParameterError(parameter_id<&SpecimenParameters::shape>(),
                         "a representative volume needs a periodic specimen");
  if (!specimen.smooth_joints.empty())
    throw ParameterError(parameter_id<&SpecimenParameters::specimen_file>(),
                         "has smooth joints, which a representative volume cannot have");
  if (specimen.groups_are_rigid)
    throw ParameterError(parameter_id<&SpecimenParameters::specimen_file>(),
                         "has clumps, which a representative volume cannot have");
  if (number_of_joints == 0)
    throw ParameterError(std::visit(
                           []<typename Law>(const Law&) {
                             using Parameters = typename Law::Parameters;
                             return parameter_id<&Parameters::installation_gap_ratio, Parameters>();
                           },
                           joint_law),
                         "joins no two grains of the RVE, so that nothing holds it; make it larger");
  const auto& joints = specimen.joints;
  for (std::size_t i = 0; i < number_of_own_grains; ++i)
    centres.push_back(at<dim>(specimen.grains.position, i));
  const OpenCell<dim> open(specimen, its_boundary);
  for (const auto& image : open.images())
    {
      centres.push_back(centres[image.owner] + shift(image, edges));
      grain_radii.push_back(grain_radii[image.owner]);
    }
  number_of_grains += open.images().size();

  using Pair = std::pair<std::uint32_t, PeriodicImage<dim>>;
  std::set<Pair> jointed;
  mean_branch_length = 0.0;
  mean_stiffness = 0.0;
  for (std::size_t j = 0; j < number_of_joints; ++j)
    {
      const Vector<dim> normal = at<dim>(joints.normal, j);
      const double distance = joints.rest_distance[j] + joints.opening[j];
      const auto second = specimen.second_of(j);
      jointed.insert({joints.grain_1[j], second});
      PeriodicImage<dim> first{joints.grain_1[j], second.boxes}; // as grain 2 sees it
      for (int& boxes_away : first.boxes)
        boxes_away = -boxes_away;
      jointed.insert({joints.grain_2[j], first});
      const auto& ends = open.of_joint(j);
      boxes.push_back(ends.boxes);
      mean_branch_length += distance / double(number_of_joints);
      all_links.push_back({ends.grain_1, ends.grain_2, std::uint32_t(j * face.size()), std::uint32_t(face.size()), true,
                           joint_axes(joints, j), distance * normal, 0.5 * distance + joints.half_radius_difference[j],
                           0.5 * distance - joints.half_radius_difference[j], joints.normal_stiffness[j],
                           joints.shear_stiffness[j], joints.half_length[j], joints.opening[j],
                           joints.friction + joints.further_friction[j]});
      JointStiffness<dim> stiffness = JointStiffness<dim>::Zero();
      for (std::uint32_t i = 0; i < face.size(); ++i)
        {
          const std::size_t k = joints.segment(i, j);
          bonds.push_back({joints.tensile_strength[k], joints.cohesion[k], joints.friction_slope});
          if (joints.bonded[k] < 0.5)
            unbonded_at_rest.push_back(std::uint32_t(bonds.size() - 1));
          const ElementRows<dim> rows = element_rows(face[i], joints.half_length[j]);
          stiffness +=
            std::visit([&](const auto& law) { return law.bonded_stiffness(joints.face(j), face[i], rows); }, joint_law);
        }
      bonded_stiffnesses.push_back(stiffness);
      mean_stiffness += bonded_stiffnesses.back()(0, 0) * distance / double(number_of_joints);
    }

  its_minerals = shares_of_minerals(specimen);
  for (std::size_t j = 0; j < number_of_joints && !its_minerals.empty(); ++j)
    sides.push_back(mineral_sides(specimen, joints.grain_1[j], joints.grain_2[j]));

  boundary_conditions = std::make_shared<const BoundaryConditions<dim>>(open.conditions(specimen).that_bear(
    all_links, number_of_joints, number_of_grains, [](std::uint32_t) { return true; }));

  // Pairs that may come into contact.
  const double reach = touch_search_ratio * specimen.grains.mean_radius();
  const auto images = images_within(specimen.grains, edges, reach);
  const auto all = with_images(specimen.grains, images, edges);
  std::uint32_t next_segment = std::uint32_t(bonds.size());
  for (const auto& [one, two] : pairs_within(all, reach))
    {
      if (one >= number_of_own_grains ||
          (two >= number_of_own_grains && !counts(one, images[two - number_of_own_grains])))
        continue;
      const PeriodicImage<dim> second =
        two < number_of_own_grains ? PeriodicImage<dim>{two, {}} : images[two - number_of_own_grains];
      if (jointed.contains({one, second}))
        continue;
      const auto ends = open.of_pair(one, second);
      if (!ends)
        continue;
      const Vector<dim> branch = at<dim>(all.position, two) - at<dim>(all.position, one);
      const double radius_1 = all.radius[one];
      const double radius_2 = all.radius[two];
      const double k_n = stiffness_per_area(specimen.particle_contact.modulus, radius_1, radius_2);
      const double half_difference = 0.5 * (radius_1 - radius_2);
      boxes.push_back(ends->boxes);
      all_links.push_back({ends->grain_1, ends->grain_2, next_segment++, 1, false,
                           contact_axes(Vector<dim>(branch.normalized())), branch,
                           0.5 * branch.norm() + half_difference, 0.5 * branch.norm() - half_difference, k_n,
                           k_n / specimen.particle_contact.stiffness_ratio, std::min(radius_1, radius_2),
                           std::max(0.0, branch.norm() - radius_1 - radius_2), specimen.particle_contact.friction});
    }

  // Cell and grains turn together; what a link is in its own axes stays.
  edges = rotation * edges;
  for (Vector<dim>& centre : centres)
    centre = rotation * centre;
  for (Link<dim>& link : all_links)
    {
      link.axes = link.axes * rotation.transpose();
      link.branch = rotation * link.branch;
      link.by_grains = link_gradient(link);
      link.by_strain = link_strain_gradient(link);
    }

  factorise_intact();
  solve_unit_strains();
  bound_segments();
}

template <int dim>
double Network<dim>::segment_area(const Link<dim>& link, const std::uint32_t i) const
{
  return link.has_face ? element_area(face[i], link.face(plane_thickness))
                       : face_area<dim>(link.half_length, plane_thickness);
}

template <int dim>
Unknowns Network<dim>::apply_bonded(const Unknowns& unknowns) const
{
  Unknowns result = Unknowns::Zero(n_unknowns());
  for (std::size_t j = 0; j < number_of_joints; ++j)
    add_forces(all_links[j], bonded_stiffnesses[j] * link_motion(all_links[j], unknowns), result);
  return result;
}

template <int dim>
void Network<dim>::factorise_intact()
{
  // Displacements and turns have their own scale each.
  stiffness_scale.setZero();
  for (std::size_t j = 0; j < number_of_joints; ++j)
    {
      const auto& gradient = all_links[j].by_grains;
      const Eigen::Matrix<double, 2 * n_motions<dim>, 1> diagonal =
        (gradient.transpose() * bonded_stiffnesses[j] * gradient).diagonal();
      stiffness_scale += (diagonal.template head<n_motions<dim>>() + diagonal.template tail<n_motions<dim>>()) /
                         double(number_of_grains);
    }
  const double regularising_share = boundary_conditions->pieces().empty() ? regularity : regularity_of_open_cells;
  LinkStiffnesses<dim> stiffnesses(all_links.size(), nullptr);
  for (std::size_t j = 0; j < number_of_joints; ++j)
    stiffnesses[j] = &bonded_stiffnesses[j];
  factorised.emplace(factorise(stiffnesses, regularising_share, boundary_conditions));

  std::vector<JointStiffness<dim>> of_points(all_links.size());
  const FaceElement<dim> point{{}, face_area<dim>(1.0, 1.0), 0.0}; // where a pair without a face is in contact
  for (std::size_t k = number_of_joints; k < all_links.size(); ++k)
    {
      of_points[k] =
        element_stiffness(all_links[k].face(plane_thickness), point, element_rows(point, all_links[k].half_length));
      stiffnesses[k] = &of_points[k];
    }
  factorised_all.emplace(factorise(stiffnesses, regularising_share, boundary_conditions));
}

template <int dim>
void Network<dim>::solve_unit_strains()
{
  constexpr std::array<bool, n_voigt<dim>> no_strain_free{};
  const Eigen::Index n_own = n_unknowns() - n_voigt<dim>;
  unit_motion = Eigen::MatrixXd::Zero(n_own, n_voigt<dim>);
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      Unknowns affine = Unknowns::Zero(n_unknowns());
      affine[n_own + k] = 1.0;
      const auto forces_on_grains = [&](const Unknowns& x) {
        Unknowns y = apply_bonded(x);
        y.tail<n_voigt<dim>>().setZero();
        boundary_conditions->project(y);
        return y;
      };
      const auto apply = forces_on_grains;
      const Unknowns right = -forces_on_grains(affine);
      auto solution = conjugate_gradients(
        apply, [&](const Unknowns& r) { return factorised->solve(r, no_strain_free); }, right, 1e-13, 500);
      // The factor multiplies round-off in the sums of forces on what may float by the inverse of its regularity. Mostly
      // that is harmless; where it is not, the residual shows it, and the rigid motions are kept out.
      if (!((right - apply(solution.x)).norm() <= largest_residual * right.norm()))
        {
          const RigidMotions<dim> rigid(all_links, number_of_joints, number_of_grains, boundary_conditions->grains());
          solution = conjugate_gradients(
            apply,
            [&](const Unknowns& r) {
              return rigid.removed_from(factorised->solve(rigid.removed_from(r), no_strain_free));
            },
            rigid.removed_from(right), 1e-13, 500);
        }
      if (!solution.converged)
        throw std::runtime_error("the intact network has no solution");
      unit_motion.col(k) = solution.x.head(n_own);
      affine.head(n_own) = unit_motion.col(k);
      c_0.col(k) = apply_bonded(affine).template tail<n_voigt<dim>>() / cell_volume;
    }
  c_0 = 0.5 * (c_0 + c_0.transpose()).eval();

  unit_responses.resize(bonds.size());
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const Unknowns unit = intact_unknowns(Voigt<dim>::Unit(k));
      for (std::size_t j = 0; j < number_of_joints; ++j)
        {
          const Link<dim>& link = all_links[j];
          const Motion<dim> motion = link_motion(link, unit);
          for (std::uint32_t i = 0; i < link.n_segments; ++i)
            {
              Vector<dim> stress = element_rows(face[i], link.half_length) * motion;
              stress[0] *= link.normal_stiffness;
              stress.template tail<dim - 1>() *= -link.shear_stiffness;
              unit_responses[link.first_segment + i].col(k) = stress;
            }
        }
    }
}

template <int dim>
void Network<dim>::bound_segments()
{
  for (std::uint32_t k = 0; k < bonds.size(); ++k)
    {
      const double normal = unit_responses[k].row(0).norm();
      const double shear = unit_responses[k].bottomRows(dim - 1).norm();
      bounds.push_back({largest_overload(bonds[k], {normal, normal, shear}), k});
    }
  std::ranges::stable_sort(bounds, std::greater<>(), &Bound::overload);

  touching_strain = std::numeric_limits<double>::infinity();
  std::vector<Unknowns> unit;
  for (int c = 0; c < n_voigt<dim>; ++c)
    unit.push_back(intact_unknowns(Voigt<dim>::Unit(c)));
  for (std::size_t k = number_of_joints; k < all_links.size(); ++k)
    {
      opening_rates.emplace_back();
      for (int c = 0; c < n_voigt<dim>; ++c)
        opening_rates.back()[c] = link_motion(all_links[k], unit[c])[0];
      touching_strain = std::min(touching_strain, all_links[k].opening / opening_rates.back().norm());
    }
}

template <int dim>
Unknowns Network<dim>::regularising_forces(const Unknowns& unknowns) const
{
  Unknowns result = Unknowns::Zero(n_unknowns());
  for (std::size_t i = 0; i < number_of_grains; ++i)
    {
      const Eigen::Index first = n_motions<dim> * Eigen::Index(i);
      result.segment<n_motions<dim>>(first) = stiffness_scale.cwiseProduct(unknowns.segment<n_motions<dim>>(first));
    }
  return result;
}

template <int dim>
Unknowns Network<dim>::intact_unknowns(const Voigt<dim>& strain) const
{
  Unknowns unknowns(n_unknowns());
  unknowns << unit_motion * strain, strain;
  return unknowns;
}

template <int dim>
bool Network<dim>::stays_linear(const Voigt<dim>& strain) const
{
  const double size = strain.norm();
  if (!is_linear_while_bonded() || !unbonded_at_rest.empty() || !std::isfinite(size))
    return false;
  if (size >= touching_strain)
    for (std::size_t k = 0; k < opening_rates.size(); ++k)
      if (all_links[number_of_joints + k].opening + opening_rates[k].dot(strain) < 0.0)
        return false;
  return true;
}

template <int dim>
bool Network<dim>::stays_intact(const Voigt<dim>& strain) const
{
  if (!stays_linear(strain))
    return false;
  const double size = strain.norm();
  for (const Bound& bound : bounds)
    {
      if (bound.overload * size < 1.0)
        return true; // and so are all behind it
      const BondStress stress = bond_stress<dim>(unit_responses[bound.segment] * strain);
      const Bond<double>& bond = bonds[bound.segment];
      if (breaks_in_tension(bond, stress) || cohesion_needed(bond, stress) > bond.cohesion)
        return false;
    }
  return true;
}

template <int dim>
FirstBreak Network<dim>::first_break(const Voigt<dim>& direction) const
{
  FirstBreak first{std::numeric_limits<double>::infinity(), 0, true, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < opening_rates.size(); ++k)
    if (const double rate = opening_rates[k].dot(direction); rate < 0.0)
      first.touch = std::min(first.touch, -all_links[number_of_joints + k].opening / rate);
  for (std::uint32_t k = 0; k < bonds.size(); ++k)
    {
      const PathToBreak path = path_to_break(bonds[k], bond_stress<dim>(unit_responses[k] * direction));
      if (path.factor < first.factor)
        first = {path.factor, k, path.in_tension, first.touch};
    }
  return first;
}

template class Network<2>;
template class Network<3>;
} // namespace feldspar
