#include "dem/lab/strain_gauge.h"

#include <Eigen/LU>

#include <limits>

namespace feldspar
{
template <int dim>
StrainGauge<dim>::StrainGauge(const Vector<dim>& size, const BodyShape shape, const Components<dim>& undeformed,
                              const std::vector<bool>& jointed)
{
  const Vector<dim> centre = 0.5 * size;
  Vector<dim> reach = 0.4 * size;
  reach[dim - 1] = 0.25 * size[dim - 1];
  Vector<dim> mean = Vector<dim>::Zero();
  for (std::uint32_t i = 0; i < undeformed[0].size(); ++i)
    {
      const Vector<dim> x = at<dim>(undeformed, i);
      const Vector<dim> from_centre = x - centre;
      const bool inside = shape != BodyShape::cylinder || from_centre.template head<dim - 1>().norm() < reach[0];
      if (jointed[i] && inside && (from_centre.array().abs() < reach.array()).all())
        {
          members.push_back(i);
          start.push_back(x);
          mean += x;
        }
    }
  mean /= double(members.size());
  Tensor<dim> moment = Tensor<dim>::Zero();
  for (const auto& x : start)
    moment += (x - mean) * (x - mean).transpose();
  mean_start = mean;
  inverse_moment = moment.inverse();
}

template <int dim>
Tensor<dim> StrainGauge<dim>::displacement_gradient(const Components<dim>& position) const
{
  if (members.size() <= dim)
    return Tensor<dim>::Constant(std::numeric_limits<double>::quiet_NaN());
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t k = 0; k < members.size(); ++k)
    sum += (at<dim>(position, members[k]) - start[k]) * (start[k] - mean_start).transpose();
  return sum * inverse_moment;
}

template class StrainGauge<2>;
template class StrainGauge<3>;
} // namespace feldspar
