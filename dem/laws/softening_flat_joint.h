#pragma once

#include "dem/laws/flat_joint.h"
#include "dem/laws/softening_segment.h"

#include <limits>
#include <string_view>
#include <vector>

namespace feldspar
{
/// The flat joint with segments that soften (softening_segment.h), as a joint law (joint_law.h).
template <int dim>
struct SofteningFlatJoint : CarriedPlane<dim>
{
  using Parameters = SofteningFlatJointParameters;
  static constexpr std::string_view name = "softening flat joint";
  static constexpr std::size_t n_more = 3;
  static constexpr bool face_outlives_bonds = true;
  static constexpr bool face_can_slide_off = true;
  static constexpr bool linear_while_bonded = true;
  static constexpr bool has_equilibria = true;

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

  static FaceDivision<dim> division(const Parameters& wanted) { return FlatJoint<dim>::division(wanted); }
  static double friction(const Parameters& wanted, const ParticleContactParameters& contact)
  {
    return FlatJoint<dim>::friction(wanted, contact);
  }
  static std::vector<Bond<double>> draw_bonds(const Parameters& wanted, const std::size_t n_elements, Random& random)
  {
    return FlatJoint<dim>::draw_bonds(wanted, n_elements, random);
  }

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

  /// Test of the flat joint, valid as long as no segment has softened.
  template <typename Real>
  static auto surely_holds(const Face<Real>& face, const WholeFace<dim>& whole, const Bond<Real>& least,
                           const Real& opening, const std::array<Real, n_rotations<dim>>& rotation,
                           const std::array<Real, dim - 1>& slip)
  {
    return FlatJoint<dim>::surely_holds(face, whole, least, opening, rotation, slip);
  }
  template <typename Real>
  static auto surely_open(const Face<Real>& face, const WholeFace<dim>& whole, const Real& opening,
                          const std::array<Real, n_rotations<dim>>& rotation)
  {
    return FlatJoint<dim>::surely_open(face, whole, opening, rotation);
  }
  template <typename Real>
  static FaceResultants<dim, Real> whole_response(const Face<Real>& face, const WholeFace<dim>& whole,
                                                  const Real& opening,
                                                  const std::array<Real, n_rotations<dim>>& rotation,
                                                  const std::array<Real, dim - 1>& slip)
  {
    return FlatJoint<dim>::whole_response(face, whole, opening, rotation, slip);
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

  static FaceSprings stiffest(const Face<double>& face) { return FlatJoint<dim>::stiffest(face); }

  /// Stiffness of the flat joint, valid as long as no segment has softened.
  JointStiffness<dim> bonded_stiffness(const Face<double>& face, const FaceElement<dim>& element,
                                       const ElementRows<dim>& rows) const
  {
    return FlatJoint<dim>().bonded_stiffness(face, element, rows);
  }
  static Vector<dim> strain(const ElementRows<dim>& rows, const Motion<dim>& motion)
  {
    return FlatJoint<dim>::strain(rows, motion);
  }
  static BondStress bond_stress(const Face<double>& face, const Vector<dim>& strain)
  {
    return FlatJoint<dim>::bond_stress(face, strain);
  }

private:
  double over_opening = 0.0; ///< w [m]
};
} // namespace feldspar
