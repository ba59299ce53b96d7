#pragma once

#include "dem/laws/face_elements.h"
#include "dem/laws/joint_laws.h"
#include "dem/storage/grains.h"
#include "dem/storage/packed_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// The tables of joints, without the rows by name.
struct BareJointTables
{
  PackedRows state;         ///< what a joint is and stores
  PackedTable<1> response;  ///< its force and couples, those of a joint together: grains gather them
  PackedRows segment_state; ///< what its segments store; all rows of a segment, then all of the next
  PackedRows strength;      ///< of the segments' bonds
  PackedRows more_state;    ///< what else the law has its segments store; in the order of segment_state
};

/// The numbers of joints and of their segments, in tables that a sweep walks through pack by pack.
template <int dim>
struct JointTables : BareJointTables
{
  static constexpr int n_shear = dim - 1;
  static constexpr int n_tangents = dim == 3 ? 3 : 0;

  JointTables() = default;
  // Copies of the tables; the rows below name their own.
  JointTables(const JointTables& other)
    : BareJointTables(other)
  {
  }
  JointTables(JointTables&& other) noexcept
    : BareJointTables(std::move(other))
  {
  }
  JointTables& operator=(JointTables other) noexcept
  {
    BareJointTables::operator=(std::move(other));
    return *this;
  }
  ~JointTables() = default;

  /// Numbers of the rows of `state`.
  struct Row
  {
    static constexpr std::size_t normal_stiffness = 0;
    static constexpr std::size_t shear_stiffness = 1;
    static constexpr std::size_t half_length = 2;
    static constexpr std::size_t half_radius_difference = 3;
    static constexpr std::size_t rest_distance = 4;
    static constexpr std::size_t normal = 5;
    static constexpr std::size_t tangent = normal + dim;
    static constexpr std::size_t opening = tangent + n_tangents;
    static constexpr std::size_t rotation = opening + 1;
    static constexpr std::size_t slip = rotation + n_rotations<dim>;
    static constexpr std::size_t slip_energy = slip + n_shear;
    static constexpr std::size_t further_friction = slip_energy + 1;
    static constexpr std::size_t count = further_friction + 1;
  };

  PackedRow normal_stiffness{state, Row::normal_stiffness};             ///< k_n [Pa/m]
  PackedRow shear_stiffness{state, Row::shear_stiffness};               ///< k_s [Pa/m]
  PackedRow half_length{state, Row::half_length};                       ///< R̄ [m]
  PackedRow half_radius_difference{state, Row::half_radius_difference}; ///< ½(R1 - R2) [m]
  PackedRow rest_distance{state, Row::rest_distance}; ///< centre distance at which the gap is zero [m]

  /// Normal from grain 1 to grain 2.
  PackedComponents<dim> normal = packed_components<dim>(state, Row::normal);
  /// t_1 in space, carried with the contact plane; t_2 = n × t_1.
  PackedComponents<n_tangents> tangent = packed_components<n_tangents>(state, Row::tangent);
  PackedRow opening{state, Row::opening}; ///< g_0 + U_n [m]
  /// θ of grain 2 against grain 1, about k, or n, t_1 and t_2 [rad].
  PackedComponents<n_rotations<dim>> rotation = packed_components<n_rotations<dim>>(state, Row::rotation);
  /// Relative shear since installation [m].
  PackedComponents<n_shear> slip = packed_components<n_shear>(state, Row::slip);
  PackedRow slip_energy{state, Row::slip_energy};           ///< dissipated by friction since installation [J]
  PackedRow further_friction{state, Row::further_friction}; ///< μ of its minerals, less that of all joints

  static constexpr std::size_t n_segment_rows = n_shear + 1;
  static constexpr std::size_t n_strength_rows = 2;

  /// τ of each segment [Pa]. It is not updated on a face whose segments are all bonded: its law may know it from the
  /// motion of the face (RespondsAsOne in dem/laws/joint_law.h).
  PackedComponents<n_shear> shear_stress = packed_components<n_shear>(segment_state, 0, n_segment_rows);
  PackedRow bonded{segment_state, n_shear, n_segment_rows}; ///< 1 bonded, 0 not (a double: it is a mask in the sweep)
  PackedRow tensile_strength{strength, 0, n_strength_rows}; ///< σ_b of each segment [Pa]
  PackedRow cohesion{strength, 1, n_strength_rows};         ///< c_b of each segment [Pa]

  static constexpr std::size_t n_response_rows = dim + 2 * n_rotations<dim>;

  static constexpr std::size_t first_couple_1 = dim;
  static constexpr std::size_t first_couple_2 = first_couple_1 + n_rotations<dim>;

  /// Force on grain 2 [N].
  PackedComponents<dim, 1> force = packed_components<dim>(response, 0);
  /// Couple on grain 1 [N m].
  PackedComponents<n_rotations<dim>, 1> couple_1 = packed_components<n_rotations<dim>>(response, first_couple_1);
  /// Couple on grain 2 [N m].
  PackedComponents<n_rotations<dim>, 1> couple_2 = packed_components<n_rotations<dim>>(response, first_couple_2);
};

/// The joints of a specimen and their law. Their numbers follow each other in space; where they stand among their neighbours is a
/// matter of the sweep (dem/dynamics/sweeps/joint_groups.h). Per segment (in space: element of the disk): [segment * size()
/// + joint].
template <int dim>
struct Joints : JointTables<dim> // NOLINT(cppcoreguidelines-slicing): assigning takes its base, too
{
  using JointTables<dim>::n_shear;

  AnyJointLaw<dim> law;
  std::size_t n_more = 0;                 ///< rows of each segment in `more_state`; set by divide()
  FaceDivision<dim> division{};           ///< set by divide()
  unsigned int n_segments = 0;            ///< of every face
  std::vector<FaceElement<dim>> elements; ///< the same of every face; [n_segments]
  WholeFace<dim> whole{};                 ///< the same of every face; set by divide()
  double thickness = 1.0;                 ///< of the plane [m]
  double friction = 0.0;                  ///< μ of broken segments; `further_friction` is added
  double friction_slope = 0.0;            ///< tan φ_b

  LargeVector<std::uint32_t> grain_1, grain_2;
  std::vector<std::uint32_t> number; ///< given at installation, for good

  std::size_t size() const { return grain_1.size(); }
  std::size_t segment(const unsigned int i, const std::size_t joint) const { return i * size() + joint; }

  /// Sets how the law divides every face, and how many numbers of its own are stored for a segment.
  void divide(const FaceDivision<dim>& into, const std::size_t numbers_of_the_law)
  {
    division = into;
    n_more = numbers_of_the_law;
    elements = face_elements<dim>(into);
    n_segments = unsigned(elements.size());
    whole = whole_face<dim>(elements);
  }

  /// The k-th value of the law's own, for each segment.
  PackedRow more(const std::size_t k) { return {this->more_state, k, n_more}; }

  Face<double> face(const std::size_t joint) const
  {
    return {this->normal_stiffness[joint], this->shear_stiffness[joint], this->half_length[joint], thickness,
            friction + this->further_friction[joint]};
  }

  double face_area(const std::size_t joint) const
  {
    return feldspar::face_area<dim>(this->half_length[joint], thickness);
  }

  /// The places of the joints in the order of their numbers.
  std::vector<std::size_t> by_number() const
  {
    std::vector<std::size_t> places(number.size());
    std::iota(places.begin(), places.end(), std::size_t(0));
    std::ranges::sort(places, {}, [&](const std::size_t j) { return number[j]; });
    return places;
  }

  bool holds(const std::size_t joint) const
  {
    for (unsigned int i = 0; i < n_segments; ++i)
      if (this->bonded[segment(i, joint)] > 0.0)
        return true;
    return false;
  }

  bool holds_wholly(const std::size_t joint) const
  {
    for (unsigned int i = 0; i < n_segments; ++i)
      if (!(this->bonded[segment(i, joint)] > 0.0))
        return false;
    return true;
  }

  /// Visits all properties and states of the joints except their grains, numbers, further friction and responses; for code that stores or
  /// permutes joints.
  template <typename Visitor>
  void visit_per_joint(Visitor&& visit)
  {
    visit("normal_stiffness", this->normal_stiffness);
    visit("shear_stiffness", this->shear_stiffness);
    visit("half_length", this->half_length);
    visit("half_radius_difference", this->half_radius_difference);
    visit("rest_distance", this->rest_distance);
    for (int c = 0; c < dim; ++c)
      visit(std::string("normal_") + "xyz"[c], this->normal[c]);
    for (std::size_t c = 0; c < this->tangent.size(); ++c)
      visit(std::string("tangent_") + "xyz"[c], this->tangent[c]);
    visit("opening", this->opening);
    if constexpr (dim == 2)
      {
        visit("slope", this->rotation[0]);
        visit("slip", this->slip[0]);
      }
    else
      {
        visit("twist", this->rotation[0]);
        visit("bend_1", this->rotation[1]);
        visit("bend_2", this->rotation[2]);
        visit("slip_1", this->slip[0]);
        visit("slip_2", this->slip[1]);
      }
    visit("slip_energy", this->slip_energy);
  }

  template <typename Visitor>
  void visit_per_segment(Visitor&& visit)
  {
    for (int c = 0; c < n_shear; ++c)
      visit("shear_stress_" + std::to_string(c + 1), this->shear_stress[c]);
    visit("bonded", this->bonded);
    visit("tensile_strength", this->tensile_strength);
    visit("cohesion", this->cohesion);
    for (std::size_t k = 0; k < n_more; ++k)
      {
        PackedRow row = more(k);
        visit("more_" + std::to_string(k + 1), row);
      }
  }

  /// All at rest, nothing bonded.
  void resize_all(const std::size_t n)
  {
    grain_1.resize(n);
    grain_2.resize(n);
    number.resize(n);
    this->state.resize(JointTables<dim>::Row::count, n);
    this->response.resize(this->n_response_rows, n);
    this->segment_state.resize(n_segments * this->n_segment_rows, n);
    this->strength.resize(n_segments * this->n_strength_rows, n);
    this->more_state.resize(n_segments * n_more, n);
  }

  /// Drops every joint that is not among `kept` (ascending).
  void keep(const std::vector<std::size_t>& kept)
  {
    for_each_table([&](auto& table) { table.keep(kept); });
    for_each_list([&](auto& values) {
      for (std::size_t to = 0; to < kept.size(); ++to)
        values[to] = values[kept[to]];
      values.resize(kept.size());
      give_back_room(values);
    });
  }

  /// The same of every joint that does not fulfil a condition.
  template <typename Condition>
  void keep_if(const Condition& condition)
  {
    std::vector<std::size_t> kept(size());
    std::iota(kept.begin(), kept.end(), std::size_t(0));
    std::erase_if(kept, [&](const std::size_t j) { return !condition(j); });
    keep(kept);
  }

  /// Makes joint k what joint order[k] was; a permutation of all.
  void reorder(const std::vector<std::size_t>& order)
  {
    for_each_table([&](auto& table) { table.reorder(order); });
    for_each_list([&](auto& values) {
      const auto before = values;
      std::ranges::transform(order, values.begin(), [&](const std::size_t j) { return before[j]; });
    });
  }

private:
  template <typename Visitor>
  void for_each_table(Visitor&& visit)
  {
    for (auto* table : {&this->state, &this->segment_state, &this->strength, &this->more_state})
      visit(*table);
    visit(this->response);
  }
  template <typename Visitor>
  void for_each_list(Visitor&& visit)
  {
    visit(grain_1);
    visit(grain_2);
    visit(number);
  }
};
} // namespace feldspar
