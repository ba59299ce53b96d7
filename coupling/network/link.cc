#include "coupling/network/link.h"

namespace feldspar
{
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

template LinkGradient<2> link_gradient<2>(const Link<2>&);
template LinkGradient<3> link_gradient<3>(const Link<3>&);
template LinkStrainGradient<2> link_strain_gradient<2>(const Link<2>&);
template LinkStrainGradient<3> link_strain_gradient<3>(const Link<3>&);
} // namespace feldspar
