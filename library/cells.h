#pragma once

#include "app/programme/checks.h"
#include "coupling/network/network.h"
#include "coupling/rve/parameters.h"
#include "library/states.h"

#include <span>

/// Cells of representative volumes, as one and as many of them use them.
namespace feldspar::v1
{
template <int dim>
using Network = std::shared_ptr<const feldspar::Network<dim>>;

template <int dim>
using Cell = RepresentativeVolume<dim>;

/// The input of representative volumes.
inline feldspar::Input input_of_rve(const Input& input, const Specimen& specimen)
{
  feldspar::Input wanted = input.state().read();
  wanted.specimen.dimension = unsigned(specimen.dimension());
  check_equilibria(wanted.specimen, "take another law");
  check_boundary(wanted);
  return wanted;
}

template <int dim>
Network<dim> network_of(const feldspar::Specimen<dim>& specimen, const feldspar::Input& input)
{
  if (!specimen.is_periodic())
    throw InputError("the specimen stands between walls; a representative volume needs Specimen/Shape = periodic");
  return std::make_shared<const feldspar::Network<dim>>(specimen, Tensor<dim>::Identity(), input.boundary);
}

template <typename Vector>
std::vector<double> values_of(const Vector& vector)
{
  return {vector.data(), vector.data() + vector.size()};
}

/// A symmetric or not, rows first.
template <typename Matrix>
std::vector<double> rows_of(const Matrix& matrix)
{
  std::vector<double> values;
  values.reserve(std::size_t(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      values.push_back(matrix(i, j));
  return values;
}

template <int dim>
Voigt<dim> strain_of(const std::span<const double> values)
{
  if (values.size() != n_voigt<dim>)
    throw InputError("a strain has {} components; in {} dimensions there must be {}: {}", values.size(), dim,
                     n_voigt<dim>, dim == 2 ? "xx, yy, xy" : "xx, yy, zz, yz, xz, xy");
  const Voigt<dim> strain = Eigen::Map<const Voigt<dim>>(values.data());
  if (!(strain.array().abs() <= largest_strain).all()) // nor is what is not a number
    throw InputError("a strain has a component that is not in [-{0}, {0}]", largest_strain);
  return strain;
}

template <int dim>
feldspar::Trial<dim> answer(const Cell<dim>& cell, const Voigt<dim>& strain, const Bonds bonds, const bool with_tangent,
                            const Check& check)
{
  TrialOptions<dim> options;
  options.bonds = bonds;
  options.with_tangent = with_tangent;
  options.gives_up = check;
  return cell.trial(strain_control<dim>(strain), options);
}

template <int dim>
std::size_t broken(const NetworkState<dim>& state)
{
  return state.n_tension_breaks + state.n_shear_breaks;
}
} // namespace feldspar::v1
