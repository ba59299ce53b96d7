#include "dem/specimen/rigid_groups.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace feldspar
{
template <int dim>
BodyCentres<dim>::BodyCentres(const Specimen<dim>& specimen, const Components<dim>& positions)
  : centre(&positions)
{
  if (!specimen.groups_are_rigid)
    return;
  const auto& group = specimen.groups;
  const auto& mass = specimen.grains.mass;
  const std::size_t n_groups = std::size_t(*std::ranges::max_element(group)) + 1;
  std::vector<double> sum(n_groups, 0.0);
  Components<dim> moment;
  resize<dim>(moment, n_groups);
  for (std::size_t i = 0; i < group.size(); ++i)
    {
      sum[group[i]] += mass[i];
      for (int c = 0; c < dim; ++c)
        moment[c][group[i]] += mass[i] * positions[c][i];
    }
  resize<dim>(own, group.size());
  for (std::size_t i = 0; i < group.size(); ++i)
    for (int c = 0; c < dim; ++c)
      own[c][i] = moment[c][group[i]] / sum[group[i]];
  centre = &own;
}

template <int dim>
RigidGroups<dim>::RigidGroups(const Specimen<dim>& specimen)
{
  if (!specimen.groups_are_rigid)
    return;
  if constexpr (dim == 3)
    throw std::logic_error("rigid groups are of the plane");
  const auto& grains = specimen.grains;
  of = specimen.groups;
  const std::size_t n_groups = std::size_t(*std::ranges::max_element(of)) + 1;
  first.assign(n_groups + 1, 0);
  for (const auto group : of)
    ++first[group + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  members.resize(of.size());
  auto next = first;
  for (std::uint32_t i = 0; i < of.size(); ++i)
    members[next[of[i]]++] = i;

  const BodyCentres<dim> centres(specimen);
  Components<dim> positions;
  resize<dim>(positions, n_groups);
  resize<dim>(arm, of.size());
  std::vector<double> area(n_groups, 0.0), mass(n_groups, 0.0), inertia(n_groups, 0.0);
  for (std::uint32_t i = 0; i < of.size(); ++i)
    {
      const Vector<dim> from_centre = at<dim>(grains.position, i) - centres.of(i);
      set<dim>(positions, of[i], centres.of(i));
      set<dim>(arm, i, from_centre);
      area[of[i]] += grains.radius[i] * grains.radius[i];
      mass[of[i]] += grains.mass[i];
      inertia[of[i]] += grains.moment_of_inertia[i] + grains.mass[i] * from_centre.squaredNorm();
    }
  for (double& value : area)
    value = std::sqrt(value);
  bodies.place(area, positions);
  bodies.mass = std::move(mass);
  bodies.moment_of_inertia = std::move(inertia);
  angle.assign(n_groups, 0.0);
}

namespace
{
/// r × F about the axis across the plane.
double moment(const Vector<2>& arm, const Vector<2>& force) { return arm[0] * force[1] - arm[1] * force[0]; }
} // namespace

template <int dim>
void RigidGroups<dim>::push(Grains<dim>& grains, const std::uint32_t grain, const Vector<dim>& velocity)
{
  if constexpr (dim == 2)
    {
      const std::uint32_t g = of[grain];
      const Vector<2> impulse = grains.mass[grain] * velocity;
      const Vector<2> from_centre = at<2>(grains.position, grain) - at<2>(bodies.position, g);
      for (int c = 0; c < 2; ++c)
        bodies.velocity[c][g] += impulse[c] / bodies.mass[g];
      bodies.spin[0][g] += moment(from_centre, impulse) / bodies.moment_of_inertia[g];
    }
}

template <int dim>
void RigidGroups<dim>::gather(const Grains<dim>& grains)
{
  if constexpr (dim == 2)
    for_each_block(size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        {
          Vector<2> force = Vector<2>::Zero();
          double couple = 0.0;
          for (auto k = first[g]; k < first[g + 1]; ++k)
            {
              const std::uint32_t i = members[k];
              const Vector<2> on_member = at<2>(grains.force, i);
              force += on_member;
              couple += grains.couple[0][i] + moment(at<2>(grains.position, i) - at<2>(bodies.position, g), on_member);
            }
          set<2>(bodies.force, g, force);
          bodies.couple[0][g] = couple;
        }
    });
}

template <int dim>
void RigidGroups<dim>::carry_members(Grains<dim>& grains, const double dt)
{
  if constexpr (dim == 2)
    for_each_block(size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        {
          // Positions follow from the whole angle, so that a group keeps the shape of its first step for good.
          angle[g] += dt * bodies.spin[0][g];
          const double cosine = std::cos(angle[g]);
          const double sine = std::sin(angle[g]);
          for (auto k = first[g]; k < first[g + 1]; ++k)
            {
              const std::uint32_t i = members[k];
              const Vector<2> turned(cosine * arm[0][i] - sine * arm[1][i], sine * arm[0][i] + cosine * arm[1][i]);
              const Vector<2> now = at<2>(bodies.position, g) + turned;
              set<2>(grains.velocity, i, (now - at<2>(grains.position, i)) / dt);
              set<2>(grains.position, i, now);
              grains.spin[0][i] = bodies.spin[0][g];
            }
        }
    });
}

template class BodyCentres<2>;
template class BodyCentres<3>;
template class RigidGroups<2>;
template class RigidGroups<3>;
} // namespace feldspar
