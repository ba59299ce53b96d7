#pragma once

#include "base/page_allocator.h"
#include "base/vector.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

namespace feldspar
{
/// One array per component; [n] each.
template <int n_components>
using Components = std::array<LargeVector<double>, n_components>;

template <int n_components>
void resize(Components<n_components>& components, const std::size_t n)
{
  for (auto& component : components)
    component.assign(n, 0.0);
}

/// Transfers each component under the name of its axis.
template <typename Archive, std::size_t n_components>
void transfer_components(Archive& archive, const std::string& name,
                         std::array<LargeVector<double>, n_components>& components)
{
  for (std::size_t c = 0; c < n_components; ++c)
    archive.array(name + "_" + "xyz"[c], components[c]);
}

/// One component an array, of whatever kind.
template <int n_components, typename Values>
Eigen::Matrix<double, n_components, 1> at(const std::array<Values, n_components>& components, const std::size_t i)
{
  Eigen::Matrix<double, n_components, 1> value;
  for (int c = 0; c < n_components; ++c)
    value[c] = components[c][i];
  return value;
}

template <int n_components, typename Values>
double squared_norm(const std::array<Values, n_components>& components, const std::size_t i)
{
  double sum = 0.0;
  for (int c = 0; c < n_components; ++c)
    sum += components[c][i] * components[c][i];
  return sum;
}

template <int n_components>
void set(Components<n_components>& components, const std::size_t i, const Eigen::Matrix<double, n_components, 1>& value)
{
  for (int c = 0; c < n_components; ++c)
    components[c][i] = value[c];
}

/// Grains that follow each other by number.
struct GrainRange
{
  std::uint32_t first, end;

  std::size_t size() const { return end - first; }
  bool has(const std::uint32_t grain) const { return grain >= first && grain < end; }
};

/// Area of a disc of unit thickness, volume of a sphere; radius in m, result in m³.
template <int dim>
double grain_volume(const double radius, const double thickness)
{
  if constexpr (dim == 2)
    return std::numbers::pi * radius * radius * thickness;
  else
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Moment of inertia over mass of a disc (½R²) or a sphere (⅖R²) [m²].
template <int dim>
double gyration_squared(const double radius)
{
  return (dim == 2 ? 1.0 / 2.0 : 2.0 / 5.0) * radius * radius;
}

/// Rigid discs (2D) or spheres (3D), structure of arrays. Velocities and spins live at half steps.
template <int dim>
struct Grains
{
  std::vector<double> radius;            ///< [m]
  std::vector<double> mass;              ///< [kg]
  std::vector<double> moment_of_inertia; ///< [kg m²]
  Components<dim> position;              ///< [m]
  Components<dim> velocity;              ///< [m/s]
  Components<n_rotations<dim>> spin;     ///< [rad/s]
  Components<dim> force;                 ///< sum over contacts and walls [N]
  Components<n_rotations<dim>> couple;   ///< [N m]

  std::size_t size() const { return radius.size(); }

  /// Takes radii and positions; at rest, without mass.
  void place(const std::vector<double>& radii, const Components<dim>& positions)
  {
    radius = radii;
    position = positions;
    mass.assign(size(), 0.0);
    moment_of_inertia.assign(size(), 0.0);
    stop();
    resize<dim>(force, size());
    resize<n_rotations<dim>>(couple, size());
  }

  void stop()
  {
    resize<dim>(velocity, size());
    resize<n_rotations<dim>>(spin, size());
  }

  /// These grains at rest, with their masses.
  Grains chosen(const std::vector<std::uint32_t>& which) const
  {
    const auto of = [&](const auto& values) {
      std::remove_cvref_t<decltype(values)> result;
      for (const std::uint32_t i : which)
        result.push_back(values[i]);
      return result;
    };
    Components<dim> positions;
    std::ranges::transform(position, positions.begin(), of);
    Grains all;
    all.place(of(radius), positions);
    all.mass = of(mass);
    all.moment_of_inertia = of(moment_of_inertia);
    return all;
  }

  /// grain_density in kg/m³, thickness of discs in m.
  void set_density(const double grain_density, const double thickness)
  {
    for (std::size_t i = 0; i < size(); ++i)
      {
        mass[i] = grain_density * grain_volume<dim>(radius[i], thickness);
        moment_of_inertia[i] = mass[i] * gyration_squared<dim>(radius[i]);
      }
  }

  double volume(const double thickness) const
  {
    double sum = 0.0;
    for (const double r : radius)
      sum += grain_volume<dim>(r, thickness);
    return sum;
  }

  double mean_radius() const
  {
    double sum = 0.0;
    for (const double r : radius)
      sum += r;
    return sum / double(size());
  }
};
} // namespace feldspar
