#include "coupling/network.h"

#include "coupling/conjugate_gradients.h"
#include "dem/input_error.h"
#include "dem/neighbours.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace feldspar
{
namespace
{
constexpr double touch_search_ratio = 0.5; // largest gap of a pair that may come to touch, over the mean radius
constexpr double regularity = 1e-9;        // of the factor's diagonal: grains may float, the body may shift

/// Axes n, t (n, t_1, t_2) of a contact as rows.
template <int dim>
Tensor<dim> contact_axes(const Vector<dim>& normal) requires(dim == 2)
{
  Tensor<2> axes;
  axes << normal[0], normal[1], -normal[1], normal[0];
  return axes;
}
} // namespace

template <int dim>
ElementRows<dim> element_rows(const FaceElement<dim>& element, const double half_length)
{
  ElementRows<dim> rows = ElementRows<dim>::Zero();
  rows.template leftCols<dim>().setIdentity();
  if constexpr (dim == 2)
    rows(0, 2) = -half_length * element.offset[0]; // g = g_0 + U_n - θρ (6)
  else
    {
      const double r_1 = half_length * element.offset[0];
      const double r_2 = half_length * element.offset[1];
      rows(0, 4) = r_2; // g = g_0 + U_n + n·(θ × r)
      rows(0, 5) = -r_1;
      rows(1, 3) = -r_2;
      rows(2, 3) = r_1;
    }
  return rows;
}

template <int dim>
JointStiffness<dim> bonded_element_stiffness(const Link<dim>& link, const ElementRows<dim>& rows, const double area,
                                             const double second_moment)
{
  JointStiffness<dim> stiffness = link.normal_stiffness * area * rows.row(0).transpose() * rows.row(0);
  stiffness += link.shear_stiffness * area * rows.bottomRows(dim - 1).transpose() * rows.bottomRows(dim - 1);
  if constexpr (dim == 2)
    stiffness(2, 2) += link.normal_stiffness * second_moment;
  else
    static_cast<void>(second_moment); // elements of a disk are lumped
  return stiffness;
}

template <int dim>
Network<dim>::Network(const Specimen<dim>& specimen, const Tensor<dim>& rotation)
  : number_of_grains(specimen.grains.size())
  , number_of_joints(specimen.joints.size())
  , cell_volume(specimen.volume())
  , plane_thickness(specimen.thickness)
  , tan_bond_friction(specimen.joints.friction_slope)
  , edges(specimen.cell())
  , face(specimen.joints.elements)
  , grain_radii(specimen.grains.radius)
{
  if (!specimen.periodic)
    throw InputError("Specimen/Shape: a representative volume needs a periodic specimen");
  const auto& joints = specimen.joints;
  for (std::size_t i = 0; i < number_of_grains; ++i)
    centres.push_back(at<dim>(specimen.grains.position, i));

  using Pair = std::pair<std::uint32_t, PeriodicImage<dim>>;
  std::set<Pair> jointed;
  mean_branch_length = 0.0;
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
      boxes.push_back(second.boxes);
      mean_branch_length += distance / double(number_of_joints);
      all_links.push_back({joints.grain_1[j], joints.grain_2[j], std::uint32_t(j * face.size()),
                           std::uint32_t(face.size()), true, contact_axes<dim>(normal), distance * normal,
                           0.5 * distance + joints.half_radius_difference[j],
                           0.5 * distance - joints.half_radius_difference[j], joints.normal_stiffness[j],
                           joints.shear_stiffness[j], joints.half_length[j], joints.opening[j], joints.friction});
      JointStiffness<dim> stiffness = JointStiffness<dim>::Zero();
      for (std::uint32_t i = 0; i < face.size(); ++i)
        {
          const std::size_t k = joints.segment(i, j);
          strengths.push_back({joints.tensile_strength[k], joints.cohesion[k]});
          if (joints.bonded[k] < 0.5)
            unbonded_at_rest.push_back(std::uint32_t(strengths.size() - 1));
          const double r = joints.half_length[j];
          const double width = dim == 2 ? plane_thickness : r;
          stiffness += bonded_element_stiffness(all_links.back(), element_rows(face[i], r), face[i].area * r * width,
                                                face[i].second_moment * r * r * r * plane_thickness);
        }
      bonded_stiffnesses.push_back(stiffness);
    }

  // Pairs that may come to touch.
  const double reach = touch_search_ratio * specimen.grains.mean_radius();
  const auto images = images_within(specimen.grains, edges, reach);
  const auto all = with_images(specimen.grains, images, edges);
  std::uint32_t next_segment = std::uint32_t(strengths.size());
  for (const auto& [one, two] : pairs_within(all, reach))
    {
      if (one >= number_of_grains || (two >= number_of_grains && !counts(one, images[two - number_of_grains])))
        continue;
      const PeriodicImage<dim> second =
        two < number_of_grains ? PeriodicImage<dim>{two, {}} : images[two - number_of_grains];
      if (jointed.contains({one, second}))
        continue;
      const Vector<dim> branch = at<dim>(all.position, two) - at<dim>(all.position, one);
      const double radius_1 = all.radius[one];
      const double radius_2 = all.radius[two];
      const double k_n = stiffness_per_area(specimen.particle_contact.modulus, radius_1, radius_2);
      const double half_difference = 0.5 * (radius_1 - radius_2);
      boxes.push_back(second.boxes);
      all_links.push_back({one, second.owner, next_segment++, 1, false, contact_axes<dim>(branch.normalized()), branch,
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
    }

  factorise();
  solve_unit_strains();
  bound_segments();
}

template <int dim>
double Network<dim>::segment_area(const Link<dim>& link, const std::uint32_t i) const
{
  const double r = link.half_length;
  if (!link.has_face)
    return face_area<dim>(r, plane_thickness);
  return face[i].area * r * (dim == 2 ? plane_thickness : r);
}

template <int dim>
Motion<dim> Network<dim>::link_motion(const Link<dim>& link, const Unknowns& unknowns) const
{
  const auto q_1 = unknowns.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(link.grain_1));
  const auto q_2 = unknowns.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(link.grain_2));
  const Voigt<dim> strain = unknowns.tail<n_voigt<dim>>();
  Motion<dim> motion;
  const Vector<dim> jump =
    q_2.template head<dim>() - q_1.template head<dim>() + strain_tensor<dim>(strain) * link.branch;
  motion.template head<dim>() = link.axes * jump;
  if constexpr (dim == 2)
    {
      motion[1] -= link.arm_1 * q_1[2] + link.arm_2 * q_2[2];
      motion[2] = q_2[2] - q_1[2];
    }
  else
    {
      const Vector<3> turn_1 = link.axes * q_1.template tail<3>();
      const Vector<3> turn_2 = link.axes * q_2.template tail<3>();
      motion[1] -= link.arm_1 * turn_1[2] + link.arm_2 * turn_2[2];
      motion[2] += link.arm_1 * turn_1[1] + link.arm_2 * turn_2[1];
      motion.template tail<3>() = turn_2 - turn_1;
    }
  return motion;
}

template <int dim>
void Network<dim>::add_forces(const Link<dim>& link, const Motion<dim>& forces, Unknowns& sum) const
{
  auto f_1 = sum.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(link.grain_1));
  auto f_2 = sum.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(link.grain_2));
  const Vector<dim> force = link.axes.transpose() * forces.template head<dim>();
  f_1.template head<dim>() -= force;
  f_2.template head<dim>() += force;
  if constexpr (dim == 2)
    {
      f_1[2] -= link.arm_1 * forces[1] + forces[2];
      f_2[2] -= link.arm_2 * forces[1] - forces[2];
    }
  else
    {
      const Vector<3> lever(0.0, forces[2], -forces[1]);
      const Vector<3> couple = forces.template tail<3>();
      f_1.template tail<3>() += link.axes.transpose() * (link.arm_1 * lever - couple);
      f_2.template tail<3>() += link.axes.transpose() * (link.arm_2 * lever + couple);
    }
  sum.tail<n_voigt<dim>>() += stress_voigt<dim>(force * link.branch.transpose());
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
void Network<dim>::factorise()
{
  constexpr int n = n_motions<dim>;
  std::vector<Eigen::Triplet<double>> entries;
  Unknowns unit = Unknowns::Zero(n_unknowns());
  Unknowns answer = Unknowns::Zero(n_unknowns());
  for (std::size_t j = 0; j < number_of_joints; ++j)
    {
      // Column by column, so that the kinematics stay written once.
      const Link<dim>& link = all_links[j];
      std::array<Eigen::Index, 2> first{n * Eigen::Index(link.grain_1), n * Eigen::Index(link.grain_2)};
      for (const Eigen::Index column_of : first)
        {
          for (int c = 0; c < n; ++c)
            {
              unit[column_of + c] = 1.0;
              add_forces(link, bonded_stiffnesses[j] * link_motion(link, unit), answer);
              unit[column_of + c] = 0.0;
              for (const Eigen::Index row_of : first)
                {
                  for (int r = 0; r < n; ++r)
                    {
                      entries.emplace_back(row_of + r, column_of + c, answer[row_of + r]);
                      answer[row_of + r] = 0.0;
                    }
                  if (first[0] == first[1])
                    break;
                }
            }
          if (first[0] == first[1])
            break;
        }
    }
  const Eigen::Index size = n * Eigen::Index(number_of_grains);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd diagonal = matrix.diagonal();
  // Displacements and turns have their own scale each.
  stiffness_scale.setZero();
  for (Eigen::Index i = 0; i < size; ++i)
    stiffness_scale[i % n] += diagonal[i] / double(number_of_grains);
  Eigen::SparseMatrix<double> regular(size, size);
  std::vector<Eigen::Triplet<double>> shift;
  for (Eigen::Index i = 0; i < size; ++i)
    shift.emplace_back(i, i, (diagonal[i] > 0.0 ? regularity : 1.0) * stiffness_scale[i % n]);
  regular.setFromTriplets(shift.begin(), shift.end());
  factor.compute(matrix + regular);
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
      Unknowns right = -apply_bonded(affine);
      right.tail<n_voigt<dim>>().setZero();
      const auto apply = [&](const Unknowns& x) {
        Unknowns y = apply_bonded(x);
        y.tail<n_voigt<dim>>().setZero();
        return y;
      };
      const auto solution = conjugate_gradients(
        apply, [&](const Unknowns& r) { return precondition(r, no_strain_free); }, right, 1e-13, 500);
      if (!solution.converged)
        throw std::runtime_error("the intact network has no solution");
      unit_motion.col(k) = solution.x.head(n_own);
      affine.head(n_own) = unit_motion.col(k);
      c_0.col(k) = apply_bonded(affine).template tail<n_voigt<dim>>() / cell_volume;
    }
  c_0 = 0.5 * (c_0 + c_0.transpose()).eval();

  unit_responses.resize(strengths.size());
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
  for (std::uint32_t k = 0; k < strengths.size(); ++k)
    {
      const double normal = unit_responses[k].row(0).norm();
      const double shear = unit_responses[k].bottomRows(dim - 1).norm();
      const double overload =
        std::max(normal / strengths[k].tensile, (shear + tan_bond_friction * normal) / strengths[k].cohesion);
      bounds.push_back({overload, k});
    }
  std::sort(bounds.begin(), bounds.end(), [](const Bound& a, const Bound& b) {
    return a.overload != b.overload ? a.overload > b.overload : a.segment < b.segment;
  });

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
Unknowns Network<dim>::precondition(const Unknowns& residual,
                                    const std::array<bool, n_voigt<dim>>& strain_is_free) const
{
  const Eigen::Index n_own = n_unknowns() - n_voigt<dim>;
  Unknowns result = Unknowns::Zero(n_unknowns());
  // Forces in balance have no sum; what round-off leaves of it would shift the whole body far.
  Motion<dim> mean = Motion<dim>::Zero();
  for (std::size_t i = 0; i < number_of_grains; ++i)
    mean += residual.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(i)) / double(number_of_grains);
  mean.template tail<n_rotations<dim>>().setZero();
  Eigen::VectorXd balanced = residual.head(n_own);
  for (std::size_t i = 0; i < number_of_grains; ++i)
    balanced.segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(i)) -= mean;
  result.head(n_own) = factor.solve(balanced);
  // Block elimination of the free strains; their Schur complement is V C_0.
  int n_free = 0;
  std::array<int, n_voigt<dim>> free{};
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (strain_is_free[k])
      free[n_free++] = k;
  if (n_free == 0)
    return result;
  const Voigt<dim> right = residual.tail<n_voigt<dim>>() + unit_motion.transpose() * residual.head(n_own);
  Eigen::MatrixXd schur(n_free, n_free);
  Eigen::VectorXd right_free(n_free);
  for (int a = 0; a < n_free; ++a)
    {
      right_free[a] = right[free[a]];
      for (int b = 0; b < n_free; ++b)
        schur(a, b) = cell_volume * c_0(free[a], free[b]);
    }
  const Eigen::VectorXd strain = schur.ldlt().solve(right_free);
  for (int a = 0; a < n_free; ++a)
    {
      result[n_own + free[a]] = strain[a];
      result.head(n_own) += strain[a] * unit_motion.col(free[a]);
    }
  return result;
}

template <int dim>
Unknowns Network<dim>::lent(const Unknowns& unknowns) const
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
bool Network<dim>::stays_intact(const Voigt<dim>& strain) const
{
  const double size = strain.norm();
  if (!unbonded_at_rest.empty() || !std::isfinite(size))
    return false;
  if (size >= touching_strain)
    for (std::size_t k = 0; k < opening_rates.size(); ++k)
      if (all_links[number_of_joints + k].opening + opening_rates[k].dot(strain) < 0.0)
        return false;
  for (const Bound& bound : bounds)
    {
      if (bound.overload * size < 1.0)
        return true; // and so are all behind it
      const Vector<dim> stress = unit_responses[bound.segment] * strain;
      const Strength& bond = strengths[bound.segment];
      if (stress[0] > bond.tensile ||
          stress.template tail<dim - 1>().norm() + tan_bond_friction * stress[0] > bond.cohesion)
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
  for (std::uint32_t k = 0; k < strengths.size(); ++k)
    {
      const Vector<dim> stress = unit_responses[k] * direction;
      if (stress[0] > 0.0 && strengths[k].tensile / stress[0] < first.factor)
        first = {strengths[k].tensile / stress[0], k, true, first.touch};
      const double shear = stress.template tail<dim - 1>().norm() + tan_bond_friction * stress[0]; // (15)
      if (shear > 0.0 && strengths[k].cohesion / shear < first.factor)
        first = {strengths[k].cohesion / shear, k, false, first.touch};
    }
  return first;
}

template class Network<2>;
template ElementRows<2> element_rows<2>(const FaceElement<2>&, double);
template JointStiffness<2> bonded_element_stiffness<2>(const Link<2>&, const ElementRows<2>&, double, double);
} // namespace feldspar
