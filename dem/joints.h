#pragma once

#include "dem/face_elements.h"
#include "dem/grains.h"

#include <cstdint>
#include <string>
#include <vector>

namespace feldspar
{
/// The flat joints of a specimen, structure of arrays, ordered in space. Per segment (in space: element of the disk):
/// [segment * size() + joint].
template <int dim>
struct Joints
{
  static constexpr int n_shear = dim - 1;

  FaceDivision<dim> division{};           ///< set by divide()
  unsigned int n_segments = 0;            ///< of every face
  std::vector<FaceElement<dim>> elements; ///< the same of every face; [n_segments]
  double thickness = 1.0;                 ///< of the plane [m]
  double friction = 0.0;                  ///< μ of broken segments
  double friction_slope = 0.0;            ///< tan φ_b

  std::vector<std::uint32_t> grain_1, grain_2;
  std::vector<std::uint32_t> number;          ///< given at installation, for good
  std::vector<double> normal_stiffness;       ///< k_n [Pa/m]
  std::vector<double> shear_stiffness;        ///< k_s [Pa/m]
  std::vector<double> half_length;            ///< R̄ [m]
  std::vector<double> half_radius_difference; ///< ½(R1 - R2) [m]
  std::vector<double> rest_distance;          ///< centre distance at which the gap is zero [m]

  Components<dim> normal;                ///< from grain 1 to grain 2
  Components<dim == 3 ? 3 : 0> tangent;  ///< t_1 in space, carried with the contact plane; t_2 = n × t_1
  std::vector<double> opening;           ///< g_0 + U_n [m]
  Components<n_rotations<dim>> rotation; ///< θ of grain 2 against grain 1, about k, or n, t_1 and t_2 [rad]
  Components<n_shear> slip;              ///< relative shear since installation [m]
  std::vector<double> slip_energy;       ///< dissipated by friction since installation [J]

  Components<n_shear> shear_stress;     ///< τ of each segment [Pa]
  std::vector<double> bonded;           ///< 1 bonded, 0 not; each segment (a double: it is a mask in the sweep)
  std::vector<double> tensile_strength; ///< σ_b of each segment [Pa]
  std::vector<double> cohesion;         ///< c_b of each segment [Pa]

  Components<dim> force;                 ///< on grain 2 [N]
  Components<n_rotations<dim>> couple_1; ///< on grain 1 [N m]
  Components<n_rotations<dim>> couple_2; ///< on grain 2 [N m]

  std::size_t size() const { return grain_1.size(); }
  std::size_t segment(const unsigned int i, const std::size_t joint) const { return i * size() + joint; }

  void divide(const FaceDivision<dim>& into)
  {
    division = into;
    elements = face_elements<dim>(into);
    n_segments = unsigned(elements.size());
  }

  double face_area(const std::size_t joint) const { return feldspar::face_area<dim>(half_length[joint], thickness); }
  /// Second moment of the face about an axis in it [m⁴].
  double face_second_moment(const std::size_t joint) const
  {
    return feldspar::face_second_moment<dim>(half_length[joint], thickness);
  }
  /// Second moment of the face about its normal [m⁴]; 0 in the plane.
  double face_polar_moment(const std::size_t joint) const
  {
    return feldspar::face_polar_moment<dim>(half_length[joint]);
  }

  bool holds(const std::size_t joint) const
  {
    for (unsigned int i = 0; i < n_segments; ++i)
      if (bonded[segment(i, joint)] > 0.0)
        return true;
    return false;
  }

  /// What each joint is and remembers, but for its grains, its number and its answer; for whoever stores or permutes.
  template <typename Visitor>
  void visit_per_joint(Visitor&& visit)
  {
    visit("normal_stiffness", normal_stiffness);
    visit("shear_stiffness", shear_stiffness);
    visit("half_length", half_length);
    visit("half_radius_difference", half_radius_difference);
    visit("rest_distance", rest_distance);
    for (int c = 0; c < dim; ++c)
      visit(std::string("normal_") + "xyz"[c], normal[c]);
    for (std::size_t c = 0; c < tangent.size(); ++c)
      visit(std::string("tangent_") + "xyz"[c], tangent[c]);
    visit("opening", opening);
    if constexpr (dim == 2)
      {
        visit("slope", rotation[0]);
        visit("slip", slip[0]);
      }
    else
      {
        visit("twist", rotation[0]);
        visit("bend_1", rotation[1]);
        visit("bend_2", rotation[2]);
        visit("slip_1", slip[0]);
        visit("slip_2", slip[1]);
      }
    visit("slip_energy", slip_energy);
  }

  template <typename Visitor>
  void visit_per_segment(Visitor&& visit)
  {
    for (int c = 0; c < n_shear; ++c)
      visit("shear_stress_" + std::to_string(c + 1), shear_stress[c]);
    visit("bonded", bonded);
    visit("tensile_strength", tensile_strength);
    visit("cohesion", cohesion);
  }

  void resize_all(const std::size_t n)
  {
    grain_1.resize(n);
    grain_2.resize(n);
    number.resize(n);
    visit_per_joint([n](const std::string&, std::vector<double>& values) { values.assign(n, 0.0); });
    visit_per_segment([&](const std::string&, std::vector<double>& values) { values.assign(n * n_segments, 0.0); });
    resize<dim>(force, n);
    resize<n_rotations<dim>>(couple_1, n);
    resize<n_rotations<dim>>(couple_2, n);
  }

  /// Drops every joint that is not among `kept` (ascending).
  void keep(const std::vector<std::size_t>& kept)
  {
    const std::size_t n_before = size();
    if (n_before == 0)
      return;
    const auto choose = [&](auto& values) {
      const std::size_t n_rows = values.size() / n_before;
      for (std::size_t row = 0, to = 0; row < n_rows; ++row)
        for (const std::size_t j : kept)
          values[to++] = values[row * n_before + j];
      values.resize(n_rows * kept.size());
    };
    visit_per_joint([&](const std::string&, std::vector<double>& values) { choose(values); });
    visit_per_segment([&](const std::string&, std::vector<double>& values) { choose(values); });
    for (auto* components : {&couple_1, &couple_2})
      for (auto& component : *components)
        choose(component);
    for (auto& component : force)
      choose(component);
    choose(number);
    choose(grain_2);
    choose(grain_1);
  }
};
} // namespace feldspar
