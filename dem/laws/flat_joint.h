#pragma once

#include "base/random.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/draw_bond.h"
#include "dem/laws/face.h"
#include "dem/laws/flat_joint_law.h"
#include "dem/laws/parameters.h"

#include <algorithm>
#include <string_view>
#include <vector>

/// The flat joint at the level of the face: its segments, updated one by one by the law of a segment
/// (flat_joint_law.h), and their resultants (7), (9).
namespace feldspar
{
/// Segment of a face, and where its centroid lies.
template <int dim, typename Real>
struct PlacedSegment
{
  flat_joint::Segment<dim, Real> segment;
  std::array<Real, dim - 1> offset; ///< ρ along t, or r along t_1 and t_2 [m]
};

template <int dim, typename Real>
PlacedSegment<dim, Real> place_segment(const Face<Real>& face, const FaceElement<dim>& element)
{
  const Real r = face.half_length;
  if constexpr (dim == 2)
    return {{face.normal_stiffness, face.shear_stiffness, r * element.area, face.thickness, face.friction},
            {r * element.offset[0]}};
  else
    return {{face.normal_stiffness, face.shear_stiffness, r * r * element.area, face.friction},
            {r * element.offset[0], r * element.offset[1]}};
}

/// Adds a segment's forces and, about the contact point, their moment: (9), in three dimensions r × F.
template <typename Real, typename Update>
void add_segment(FaceResultants<2, Real>& sum, const std::array<Real, 1>& offset, const Real& area,
                 const Update& update)
{
  sum.normal_force += update.normal.force;
  sum.shear_force[0] += update.state.shear_stress[0] * area;
  sum.moment[0] += update.normal.moment - offset[0] * update.normal.force; // (9)
  sum.slip_energy += update.slip_energy;
}

template <typename Real, typename Update>
void add_segment(FaceResultants<3, Real>& sum, const std::array<Real, 2>& offset, const Real& area,
                 const Update& update)
{
  const Real shear_1 = update.state.shear_stress[0] * area;
  const Real shear_2 = update.state.shear_stress[1] * area;
  sum.normal_force += update.normal.force;
  sum.shear_force[0] += shear_1;
  sum.shear_force[1] += shear_2;
  sum.moment[0] += offset[0] * shear_2 - offset[1] * shear_1;
  sum.moment[1] += offset[1] * update.normal.force;
  sum.moment[2] -= offset[0] * update.normal.force;
  sum.slip_energy += update.slip_energy;
}

/// Updates all segments of a face, each by update_segment(segment, bond, old state, motion). `segments` gives each one's
/// bond and old state and takes its update:
///   Bond<Real> bond(i);  State state(i);  void set(i, Update)
template <int dim, typename Real, typename Segments, typename UpdateSegment>
FaceResultants<dim, Real> update_face_by(UpdateSegment&& update_segment, const Face<Real>& face,
                                         const std::vector<FaceElement<dim>>& elements,
                                         const FaceMotion<dim, Real>& motion, Segments&& segments)
{
  FaceResultants<dim, Real> sum{Real(0.0), {}, {}, Real(0.0)};
  sum.shear_force.fill(Real(0.0));
  sum.moment.fill(Real(0.0));
  const Real slope = dim == 2 ? motion.rotation[0] : Real(0.0);
  const Real twist = motion.rotation[0] - motion.rotation_before[0];
  for (unsigned int i = 0; i < elements.size(); ++i)
    {
      const auto [segment, offset] = place_segment(face, elements[i]);
      const flat_joint::SegmentMotion<dim, Real> moves{
        flat_joint::gap_at(motion.opening_before, motion.rotation_before, offset),
        flat_joint::gap_at(motion.opening, motion.rotation, offset), slope,
        flat_joint::slip_at(motion.slip_increment, twist, offset)};
      const auto update = update_segment(segment, segments.bond(i), segments.state(i), moves);
      segments.set(i, update);
      add_segment(sum, offset, segment.area(), update);
    }
  return sum;
}

/// Updates a face by the law of flat_joint_law.h and returns its resultants.
template <int dim, typename Real, typename Segments>
FaceResultants<dim, Real> update_face(const Face<Real>& face, const std::vector<FaceElement<dim>>& elements,
                                      const FaceMotion<dim, Real>& motion, Segments&& segments)
{
  return update_face_by<dim, Real>(
    [](const auto& segment, const auto& bond, const auto& old, const auto& moves) {
      return flat_joint::update<dim, Real>(segment, bond, old, moves);
    },
    face, elements, motion, segments);
}

/// Stored in the segments of a face [J]; a segment's shear stress and bond by its number.
template <int dim, typename ShearStressOf, typename BondedOf>
double face_energy(const Face<double>& face, const std::vector<FaceElement<dim>>& elements, const double opening,
                   const std::array<double, n_rotations<dim>>& rotation, ShearStressOf&& shear_stress_of,
                   BondedOf&& bonded_of)
{
  double sum = 0.0;
  for (unsigned int i = 0; i < elements.size(); ++i)
    {
      const auto [segment, offset] = place_segment(face, elements[i]);
      const std::array<double, dim - 1> tau = shear_stress_of(i);
      double squared = 0.0;
      for (const double component : tau)
        squared += component * component;
      sum += normal_energy(segment, flat_joint::gap_at(opening, rotation, offset), rotation[0], bonded_of(i));
      sum += 0.5 * squared * segment.area() / segment.shear_stiffness;
    }
  return sum;
}

/// Forces of a face whose segments are all bonded, from its motion since installation. Sums over the segments of (7), (10)
/// and (13): F_n = -k_n A U_n, F_s = -k_s A U_s, M = -k_n I θ; in three dimensions with the lumped sums of its elements, and
/// a twist M_n = -k_s (I_1 + I_2) θ_n.
template <typename Real>
FaceResultants<2, Real> whole_face_response(const Face<Real>& face, const WholeFace<2>& whole, const Real& opening,
                                            const std::array<Real, 1>& rotation, const std::array<Real, 1>& slip)
{
  const Real r = face.half_length;
  const Real area = r * (whole.area * face.thickness);
  const Real second_moment = r * r * r * (whole.second_moment[0] * face.thickness);
  return {-face.normal_stiffness * area * opening,
          {-face.shear_stiffness * area * slip[0]},
          {-face.normal_stiffness * second_moment * rotation[0]},
          Real(0.0)};
}

template <typename Real>
FaceResultants<3, Real> whole_face_response(const Face<Real>& face, const WholeFace<3>& whole, const Real& opening,
                                            const std::array<Real, 3>& rotation, const std::array<Real, 2>& slip)
{
  const Real r_squared = face.half_length * face.half_length;
  const Real normal = face.normal_stiffness * r_squared;
  const Real shear = face.shear_stiffness * r_squared;
  return {-whole.area * normal * opening,
          {-whole.area * shear * slip[0], -whole.area * shear * slip[1]},
          {-(whole.second_moment[0] + whole.second_moment[1]) * (shear * r_squared) * rotation[0],
           -whole.second_moment[1] * (normal * r_squared) * rotation[1],
           -whole.second_moment[0] * (normal * r_squared) * rotation[2]},
          Real(0.0)};
}

/// Upper bound of the difference between the gap at the centroid of a segment and the gap in the middle of the face
/// [m].
template <typename Real>
Real largest_rise(const Face<Real>& face, const WholeFace<2>& whole, const std::array<Real, 1>& rotation)
{
  return flat_joint::absolute(rotation[0]) * (face.half_length * whole.farthest_offset[0]);
}

template <typename Real>
Real largest_rise(const Face<Real>& face, const WholeFace<3>& whole, const std::array<Real, 3>& rotation)
{
  return face.half_length * (flat_joint::absolute(rotation[1]) * whole.farthest_offset[1] +
                             flat_joint::absolute(rotation[2]) * whole.farthest_offset[0]);
}

/// Upper bound of the square of the shear displacement of any segment [m²].
template <typename Real>
Real farthest_slip_squared(const Face<Real>& /*face*/, const WholeFace<2>& /*whole*/,
                           const std::array<Real, 1>& /*rotation*/, const std::array<Real, 1>& slip)
{
  return slip[0] * slip[0];
}

template <typename Real>
Real farthest_slip_squared(const Face<Real>& face, const WholeFace<3>& whole, const std::array<Real, 3>& rotation,
                           const std::array<Real, 2>& slip)
{
  const Real twist = flat_joint::absolute(rotation[0]) * face.half_length;
  const Real along_1 = flat_joint::absolute(slip[0]) + twist * whole.farthest_offset[1];
  const Real along_2 = flat_joint::absolute(slip[1]) + twist * whole.farthest_offset[0];
  return along_1 * along_1 + along_2 * along_2;
}

/// The flat joint as a joint law (joint_law.h). All that the law needs of a face is common to the faces of every law,
/// so that it has no numbers of its own.
template <int dim>
struct FlatJoint : CarriedPlane<dim>
{
  using Parameters = FlatJointParameters;
  static constexpr std::string_view name = "flat joint";
  static constexpr std::size_t n_more = 0;
  /// A broken face closes, opens, slides with friction and resists rotation.
  static constexpr bool face_outlives_bonds = true;
  static constexpr bool face_can_slide_off = true;
  static constexpr bool linear_while_bonded = true;
  static constexpr bool has_equilibria = true;

  FlatJoint() = default;
  FlatJoint(const Parameters&, const ParticleContactParameters&) {}

  template <typename Real>
  using State = flat_joint::SegmentState<dim, Real>;
  template <typename Real>
  using Update = flat_joint::SegmentUpdate<dim, Real>;

  static FaceDivision<dim> division(const Parameters& wanted)
  {
    if constexpr (dim == 2)
      return {wanted.n_segments};
    else
      return {wanted.n_rings, wanted.n_sectors};
  }
  /// μ of broken segments.
  static double friction(const Parameters& wanted, const ParticleContactParameters&) { return wanted.friction; }

  /// The bonds of one face.
  static std::vector<Bond<double>> draw_bonds(const Parameters& wanted, const std::size_t n_elements, Random& random)
  {
    if (wanted.strength_draw == StrengthDraw::per_contact)
      return std::vector<Bond<double>>(n_elements, draw_bond(wanted, random));
    std::vector<Bond<double>> bonds(n_elements);
    std::generate(bonds.begin(), bonds.end(), [&] { return draw_bond(wanted, random); });
    return bonds;
  }

  template <typename Real, typename Elements>
  FaceResultants<dim, Real> update(const Face<Real>& face, const std::vector<FaceElement<dim>>& elements,
                                   const FaceMotion<dim, Real>& motion, Elements&& states) const
  {
    return update_face<dim, Real>(face, elements, motion, std::forward<Elements>(states));
  }

  /// Returns whether certainly no bond of a face breaks; `least` holds the least strength of each kind. The test is
  /// sufficient and cheap.
  template <typename Real>
  static auto surely_holds(const Face<Real>& face, const WholeFace<dim>& whole, const Bond<Real>& least,
                           const Real& opening, const std::array<Real, n_rotations<dim>>& rotation,
                           const std::array<Real, dim - 1>& slip)
  {
    const Real highest_stress = face.normal_stiffness * (opening + largest_rise(face, whole, rotation)); // (10)
    const Real strength = shear_strength(least, highest_stress);                                         // (15)
    const Real k_s = face.shear_stiffness;
    return highest_stress <= least.tensile_strength &&
           k_s * k_s * farthest_slip_squared(face, whole, rotation, slip) <= strength * strength;
  }

  /// Returns whether certainly no segment of a face without bonds is closed: in the plane at any of its points, in
  /// space at its centroid. The test is sufficient, by a margin for round-off, and cheap.
  template <typename Real>
  static auto surely_open(const Face<Real>& face, const WholeFace<dim>& whole, const Real& opening,
                          const std::array<Real, n_rotations<dim>>& rotation)
  {
    constexpr double margin = 1.001;
    if constexpr (dim == 2)
      return opening > margin * flat_joint::absolute(rotation[0]) * face.half_length;
    else
      return opening > margin * largest_rise(face, whole, rotation);
  }

  template <typename Real>
  static FaceResultants<dim, Real> whole_response(const Face<Real>& face, const WholeFace<dim>& whole,
                                                  const Real& opening,
                                                  const std::array<Real, n_rotations<dim>>& rotation,
                                                  const std::array<Real, dim - 1>& slip)
  {
    return whole_face_response(face, whole, opening, rotation, slip);
  }

  /// τ of a segment of a face whose segments are all bonded: (13) over the whole way.
  template <typename Real>
  static State<Real> whole_state(const Face<Real>& face, const FaceElement<dim>& element,
                                 const std::array<Real, n_rotations<dim>>& rotation,
                                 const std::array<Real, dim - 1>& slip)
  {
    auto shear = flat_joint::slip_at(slip, rotation[0], place_segment(face, element).offset);
    for (Real& component : shear)
      component = -face.shear_stiffness * component;
    return {shear, decltype(Real() < Real())(true)};
  }

  template <typename Real>
  static auto remembers(const State<Real>&)
  {
    return decltype(Real() < Real())(false);
  }

  template <typename StateOf>
  double stored_energy(const Face<double>& face, const std::vector<FaceElement<dim>>& elements, const double opening,
                       const std::array<double, n_rotations<dim>>& rotation, StateOf&& state_of) const
  {
    return face_energy<dim>(
      face, elements, opening, rotation, [&](const unsigned int i) { return state_of(i).shear_stress; },
      [&](const unsigned int i) { return state_of(i).bonded; });
  }

  template <typename AnyUpdate>
  static double normal_stress(const Face<double>& face, const FaceElement<dim>& element,
                              const FaceMotion<dim, double>& /*motion*/, const AnyUpdate& update)
  {
    return mean_stress(place_segment(face, element).segment, update.normal);
  }

  /// No state of a face is stiffer.
  static FaceSprings stiffest(const Face<double>& face) { return face_springs<dim>(face); }

  /// Share of a bonded element.
  JointStiffness<dim> bonded_stiffness(const Face<double>& face, const FaceElement<dim>& element,
                                       const ElementRows<dim>& rows) const
  {
    return element_stiffness(face, element, rows);
  }

  /// Change of gap and shear of an element since rest [m].
  static Vector<dim> strain(const ElementRows<dim>& rows, const Motion<dim>& motion) { return rows * motion; }
  /// (10), (13), of a bonded element.
  static BondStress bond_stress(const Face<double>& face, const Vector<dim>& strain)
  {
    const double normal = face.normal_stiffness * strain[0];
    return {normal, normal, face.shear_stiffness * strain.template tail<dim - 1>().norm()};
  }
};
} // namespace feldspar
