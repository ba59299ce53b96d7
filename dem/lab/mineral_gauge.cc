#include "dem/lab/mineral_gauge.h"

#include "dem/specimen/rigid_groups.h"

#include <Eigen/LU>

#include <limits>

namespace feldspar
{
template <int dim>
MineralGauge<dim>::MineralGauge(const Specimen<dim>& specimen, const Components<dim>& undeformed,
                                const std::vector<bool>& is_part)
{
  if (specimen.minerals.empty())
    return;
  start = BodyCentres<dim>(specimen, undeformed).all();
  Grains<dim> grains = specimen.grains;
  grains.position = undeformed;
  std::vector<Tensor<dim>> moment(specimen.minerals.size(), Tensor<dim>::Zero());
  std::vector<std::size_t> n_ends(moment.size(), 0);
  for (const auto& [one, two] : pairs_within(grains, grains.mean_radius()))
    {
      const Vector<dim> branch = at<dim>(start, two) - at<dim>(start, one);
      if (!is_part[one] || !is_part[two] || branch.isZero(0.0))
        continue;
      neighbours.emplace_back(one, two);
      for (const std::uint32_t end : {one, two})
        {
          moment[specimen.mineral[end]] += 0.5 * branch * branch.transpose();
          ++n_ends[specimen.mineral[end]];
        }
    }
  for (std::size_t k = 0; k < moment.size(); ++k)
    inverse_moment.push_back(n_ends[k] > dim ? Tensor<dim>(moment[k].inverse())
                                             : Tensor<dim>::Constant(std::numeric_limits<double>::quiet_NaN()));
}

template <int dim>
std::array<std::vector<double>, 6> MineralGauge<dim>::strains(const Specimen<dim>& specimen) const
{
  std::vector<Tensor<dim>> sum(inverse_moment.size(), Tensor<dim>::Zero());
  const BodyCentres<dim> bodies(specimen);
  const Components<dim>& now = bodies.all();
  for (const auto& [one, two] : neighbours)
    {
      const Vector<dim> branch = at<dim>(start, two) - at<dim>(start, one);
      const Vector<dim> motion = at<dim>(now, two) - at<dim>(now, one) - branch;
      for (const std::uint32_t end : {one, two})
        sum[specimen.mineral[end]] += 0.5 * motion * branch.transpose();
    }
  std::array<std::vector<double>, 6> strains;
  for (std::size_t k = 0; k < sum.size(); ++k)
    {
      const Tensor<dim> gradient = sum[k] * inverse_moment[k];
      const Tensor<dim> strain = 0.5 * (gradient + gradient.transpose());
      std::size_t c = 0;
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b)
          strains[c++].push_back(b < dim ? strain(a, b) : 0.0);
    }
  return strains;
}

template class MineralGauge<2>;
template class MineralGauge<3>;
} // namespace feldspar
