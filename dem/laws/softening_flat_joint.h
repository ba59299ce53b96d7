#pragma once

#include "dem/laws/flat_joint.h"
#include "dem/laws/softening_segment.h"

#include <limits>
#include <string_view>
#include <vector>

namespace feldspar
{
/// The flat joint with segments that soften (softening_segment.h), as a joint law (joint_law.h). What the flat joint says of
/// whole faces holds as long as no segment has softened.
template <int dim>
struct SofteningFlatJoint : FlatJoint<dim>
{
  using Parameters = SofteningFlatJointParameters;
  static constexpr std::string_view name = "softening flat joint";
  static constexpr std::size_t n_more = 3;

  SofteningFlatJoint() = default;
  SofteningFlatJoint(const Parameters& wanted, const ParticleContactParameters&)
    : over_opening(wanted.softening_opening)
  {
  }

  double softening_opening() const { return over_opening; } ///< w [m]

  template <typename Archive>
  void transfer(Archive& archive)
  {
    archive.value("softening_opening", over_opening);
  }

  bool is_possible() const { return over_opening >= 0.0 && over_opening <= std::numeric_limits<double>::max(); }

  template <typename Real>
  using State = softening::State<dim, Real>;
  template <typename Real>
  using Update = softening::Update<dim, Real>;

  template <typename Real, typename Elements>
  FaceResultants<dim, Real> update(const Face<Real>& face, const std::vector<FaceElement<dim>>& elements,
                                   const FaceMotion<dim, Real>& motion, Elements&& states) const
  {
    return update_face_by<dim, Real>(
      [this](const auto& segment, const auto& bond, const auto& old, const auto& moves) {
        return softening::update<dim, Real>(segment, bond, over_opening, old, moves);
      },
      face, elements, motion, states);
  }

  template <typename Real>
  static State<Real> whole_state(const Face<Real>& face, const FaceElement<dim>& element,
                                 const std::array<Real, n_rotations<dim>>& rotation,
                                 const std::array<Real, dim - 1>& slip)
  {
    const auto state = FlatJoint<dim>::whole_state(face, element, rotation, slip);
    return {state.shear_stress, state.bonded, {Real(0.0), Real(0.0), Real(0.0)}};
  }
  template <typename Real>
  static auto remembers(const State<Real>& state)
  {
    return state.more[0] > 0.0;
  }

  template <typename StateOf>
  double stored_energy(const Face<double>& face, const std::vector<FaceElement<dim>>& elements, const double opening,
                       const std::array<double, n_rotations<dim>>& rotation, StateOf&& state_of) const
  {
    double sum = face_energy<dim>(
      face, elements, opening, rotation, [&](const unsigned int i) { return state_of(i).shear_stress; },
      [](unsigned int) { return false; });
    for (unsigned int i = 0; i < elements.size(); ++i)
      if (const State<double> state = state_of(i); state.bonded)
        {
          const auto [segment, offset] = place_segment(face, elements[i]);
          sum += (1.0 - state.more[0]) *
                 softening::energy_of_bond(segment, flat_joint::gap_at(opening, rotation, offset), rotation[0]);
        }
    return sum;
  }

  /// The energy that a bond has dissipated while it holds [J].
  static double dissipated_so_far(const State<double>& state) { return state.bonded ? state.more[2] : 0.0; }

private:
  double over_opening = 0.0; ///< w [m]
};
} // namespace feldspar
