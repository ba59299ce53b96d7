#pragma once

#include "base/random.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/draw_bond.h"
#include "dem/laws/face.h"
#include "dem/laws/linear_contact_law.h"
#include "dem/laws/parameters.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

/// The linear parallel bond (Potyondy and Cundall 2004): beside a linear contact with friction a beam of cement that
/// carries tension, shear, bending and twist, and breaks as a whole; docs/theory.md §1.8. Signs as of the flat joint.
namespace feldspar
{
namespace parallel_bond
{
template <int dim, typename Real>
struct State
{
  std::array<Real, dim - 1> shear_stress; ///< of the bond [Pa]
  decltype(Real() < Real()) bonded;
  std::array<Real, dim - 1> more; ///< shear force of the linear contact [N]
};

/// Verdict on a bond in a step: whether it breaks, and in tension or in shear.
template <typename Real>
struct Verdict
{
  decltype(Real() < Real()) tension_break;
  decltype(Real() < Real()) shear_break;
  Real released_energy; ///< [J]
};

/// New state and event of one update.
template <int dim, typename Real>
struct Update : Verdict<Real>
{
  State<dim, Real> state;
};

template <typename Real, std::size_t n>
Real dot(const std::array<Real, n>& a, const std::array<Real, n>& b)
{
  Real sum = a[0] * b[0];
  for (std::size_t c = 1; c < n; ++c)
    sum += a[c] * b[c];
  return sum;
}

/// Rotation about the axes in the plane of the face.
template <typename Real>
std::array<Real, 1> bending(const std::array<Real, 1>& rotation)
{
  return rotation;
}

template <typename Real>
std::array<Real, 2> bending(const std::array<Real, 3>& rotation)
{
  return {rotation[1], rotation[2]};
}

/// Rotation about the normal; a face in the plane does not twist.
template <typename Real>
Real twist(const std::array<Real, 1>&)
{
  return Real(0.0);
}

template <typename Real>
Real twist(const std::array<Real, 3>& rotation)
{
  return rotation[0];
}
} // namespace parallel_bond

/// The parallel bond as a joint law (joint_law.h) with one element, the bond. Its normal force and its moments follow
/// from opening and rotation since rest, which with constant stiffness are the sums of their increments. The linear
/// contact presses from the distance at installation, keeps its shear force and slides with friction whether the bond
/// holds or not. A break removes the force and the moments of the bond and leaves the contact as it was, until the
/// grains are far apart.
template <int dim>
struct ParallelBond : CarriedPlane<dim>
{
  using Parameters = ParallelBondParameters;
  static constexpr std::string_view name = "parallel bond";
  static constexpr std::size_t n_more = dim - 1;
  static constexpr bool face_outlives_bonds = true;
  /// The contact beside the bond presses and slides, and does not pull.
  static constexpr bool linear_while_bonded = false;
  static constexpr bool has_equilibria = true;
  /// Grains whose bond has broken roll and slide about each other as long as they are in contact.
  static constexpr bool face_can_slide_off = false;

  template <typename Real>
  using State = parallel_bond::State<dim, Real>;
  template <typename Real>
  using Update = parallel_bond::Update<dim, Real>;

  ParallelBond() = default;
  ParallelBond(const Parameters& wanted, const ParticleContactParameters& contact)
    : modulus_ratio(contact.modulus / wanted.modulus)
    , contact_stiffness_ratio(contact.stiffness_ratio)
    , radius_multiplier(wanted.radius_multiplier)
    , moment_contribution(wanted.moment_contribution)
  {
  }

  template <typename Archive>
  void transfer(Archive& archive)
  {
    archive.value("contact_modulus_over_bond_modulus", modulus_ratio);
    archive.value("contact_stiffness_ratio", contact_stiffness_ratio);
    archive.value("radius_multiplier", radius_multiplier);
    archive.value("moment_contribution", moment_contribution);
  }

  bool is_possible() const
  {
    const auto is_positive = [](const double value) {
      return value > 0.0 && value <= std::numeric_limits<double>::max();
    };
    return is_positive(modulus_ratio) && is_positive(contact_stiffness_ratio) && is_positive(radius_multiplier) &&
           moment_contribution >= 0.0 && moment_contribution <= 1.0;
  }

  static FaceDivision<dim> division(const Parameters&)
  {
    FaceDivision<dim> whole;
    whole.fill(1);
    return whole;
  }

  /// μ_c of the linear contact.
  static double friction(const Parameters&, const ParticleContactParameters& contact) { return contact.friction; }

  static std::vector<Bond<double>> draw_bonds(const Parameters& wanted, const std::size_t n_elements, Random& random)
  {
    return std::vector<Bond<double>>(n_elements, draw_bond(wanted, random));
  }

  template <typename Real, typename Elements>
  FaceResultants<dim, Real> update(const Face<Real>& face, const std::vector<FaceElement<dim>>&,
                                   const FaceMotion<dim, Real>& motion, Elements&& elements) const
  {
    const State<Real> old = elements.state(0);
    std::array<Real, dim - 1> tau;
    for (int c = 0; c < dim - 1; ++c)
      tau[c] = old.shear_stress[c] - face.shear_stiffness * motion.slip_increment[c];
    Update<Real> result{verdict(face, motion, elements.bond(0), old, tau), old};
    auto& state = result.state;
    state.bonded = old.bonded && !(result.tension_break || result.shear_break);
    const auto if_bonded = [&](const Real& value) { return simd::select(state.bonded, value, Real(0.0)); };

    const Real contact_normal = contact_stiffness(face);
    const auto contact =
      linear_contact::update<dim, Real>({contact_normal, contact_normal * (1.0 / contact_stiffness_ratio)},
                                        face.friction, old.more, -motion.opening, motion.slip_increment);
    const Real area = face_area<dim>(face.half_length, face.thickness);
    const Real bending_stiffness = face.normal_stiffness * face_second_moment<dim>(face.half_length, face.thickness);
    FaceResultants<dim, Real> sum;
    sum.normal_force = contact.normal_force - if_bonded(face.normal_stiffness * area * motion.opening);
    for (int c = 0; c < dim - 1; ++c)
      {
        state.shear_stress[c] = if_bonded(tau[c]);
        state.more[c] = contact.shear_force[c];
        sum.shear_force[c] = contact.shear_force[c] + state.shear_stress[c] * area;
      }
    for (int c = 0; c < n_rotations<dim>; ++c)
      sum.moment[c] = if_bonded(-bending_stiffness * motion.rotation[c]);
    if constexpr (dim == 3)
      sum.moment[0] = if_bonded(-face.shear_stiffness * face_polar_moment<3>(face.half_length) * motion.rotation[0]);
    sum.slip_energy = contact.slip_energy;
    elements.set(0, result);
    return sum;
  }

  template <typename StateOf>
  double stored_energy(const Face<double>& face, const std::vector<FaceElement<dim>>&, const double opening,
                       const std::array<double, n_rotations<dim>>& rotation, StateOf&& state_of) const
  {
    const State<double> state = state_of(0);
    const FaceSprings contact = contact_springs(face);
    const double overlap = std::max(0.0, -opening);
    double energy = 0.5 * contact.normal * overlap * overlap;
    energy += 0.5 * parallel_bond::dot(state.more, state.more) / contact.shear;
    if (state.bonded)
      energy +=
        0.5 * bond_work<double>(face, {opening, rotation, state.shear_stress}, {opening, rotation, state.shear_stress});
    return energy;
  }

  /// The contact, pressed and sticking: of a face as wide as the smaller grain, as of pairs without one.
  FaceSprings contact_springs(const Face<double>& face) const
  {
    const double normal = contact_stiffness(face);
    return {normal, normal / contact_stiffness_ratio, 0.0, 0.0};
  }

  /// Normal stress of the bond [Pa].
  static double normal_stress(const Face<double>& face, const FaceElement<dim>& /*element*/,
                              const FaceMotion<dim, double>& motion, const Update<double>& update)
  {
    return update.state.bonded ? face.normal_stiffness * motion.opening : 0.0;
  }

  /// Bond and contact.
  FaceSprings stiffest(const Face<double>& face) const
  {
    FaceSprings springs = face_springs<dim>(face);
    const FaceSprings contact = contact_springs(face);
    springs.normal += contact.normal;
    springs.shear += contact.shear;
    return springs;
  }

  /// The stiffness of the bond alone.
  static JointStiffness<dim> bond_stiffness(const Face<double>& face) { return of_springs(face_springs<dim>(face)); }
  /// The stiffness of a face that is pressed and does not slide: none is stiffer.
  JointStiffness<dim> bonded_stiffness(const Face<double>& face, const FaceElement<dim>&, const ElementRows<dim>&) const
  {
    return of_springs(stiffest(face));
  }

  /// The load of the bond follows from the motion of the whole face.
  static Motion<dim> strain(const ElementRows<dim>&, const Motion<dim>& motion) { return motion; }
  BondStress bond_stress(const Face<double>& face, const Motion<dim>& strain) const
  {
    const double normal = face.normal_stiffness * strain[0];
    const double shear = face.shear_stiffness * strain.template segment<dim - 1>(1).norm();
    const double lever = moment_contribution * face.half_length;
    if constexpr (dim == 2)
      return {normal + face.normal_stiffness * lever * std::abs(strain[2]), normal, shear};
    else
      return {normal + face.normal_stiffness * lever * strain.template tail<2>().norm(), normal,
              shear + face.shear_stiffness * lever * std::abs(strain[3])};
  }

private:
  static JointStiffness<dim> of_springs(const FaceSprings& springs)
  {
    Motion<dim> diagonal;
    if constexpr (dim == 2)
      diagonal << springs.normal, springs.shear, springs.bending;
    else
      diagonal << springs.normal, springs.shear, springs.shear, springs.twist, springs.bending, springs.bending;
    return diagonal.asDiagonal();
  }

  /// The motion from which the force and the moments of a bond follow.
  template <typename Real>
  struct Strain
  {
    Real opening;
    std::array<Real, n_rotations<dim>> rotation;
    std::array<Real, dim - 1> shear_stress;
  };

  /// K_n of the linear contact [N/m].
  template <typename Real>
  Real contact_stiffness(const Face<Real>& face) const
  {
    return modulus_ratio * face.normal_stiffness *
           face_area<dim, Real>(face.half_length * (1.0 / radius_multiplier), face.thickness);
  }

  /// Work of the bond's force and moments in one state on the motion that led to another [J].
  template <typename Real>
  static Real bond_work(const Face<Real>& face, const Strain<Real>& force, const Strain<Real>& way)
  {
    using namespace parallel_bond;
    Real sum = face_area<dim>(face.half_length, face.thickness) *
               (face.normal_stiffness * force.opening * way.opening +
                dot(force.shear_stress, way.shear_stress) / face.shear_stiffness);
    sum += face.normal_stiffness * face_second_moment<dim>(face.half_length, face.thickness) *
           dot(bending(force.rotation), bending(way.rotation));
    if constexpr (dim == 3)
      sum +=
        face.shear_stiffness * face_polar_moment<3>(face.half_length) * twist(force.rotation) * twist(way.rotation);
    return sum;
  }

  /// `tau`: the shear stress if the bond holds. M_b R̄/I = k_n R̄ θ_b and M_t R̄/J = k_s R̄ θ_n.
  template <typename Real>
  parallel_bond::Verdict<Real> verdict(const Face<Real>& face, const FaceMotion<dim, Real>& motion,
                                       const Bond<Real>& bond, const State<Real>& old,
                                       const std::array<Real, dim - 1>& tau) const
  {
    using namespace parallel_bond;
    const Real lever = moment_contribution * face.half_length;
    const Real normal_stress = face.normal_stiffness * motion.opening;
    const Real tension = normal_stress + face.normal_stiffness * lever * simd::magnitude(bending(motion.rotation));
    const Real shear = simd::magnitude(tau) + face.shear_stiffness * lever * simd::absolute(twist(motion.rotation));
    Verdict<Real> result;
    result.tension_break = old.bonded && tension > bond.tensile_strength;
    result.shear_break = old.bonded && !result.tension_break && shear > shear_strength(bond, normal_stress);
    result.released_energy = Real(0.0);
    // Energy by the trapezoidal rule for the work of the bond, whose force vanishes at the end of the step: the energy
    // stored at the beginning, and half of the work of its old force in the step.
    if (const auto broke = result.tension_break || result.shear_break; simd::any(broke))
      result.released_energy =
        simd::select(broke,
                     0.5 * bond_work<Real>(face, {motion.opening_before, motion.rotation_before, old.shear_stress},
                                           {motion.opening, motion.rotation, tau}),
                     Real(0.0));
    return result;
  }

  double modulus_ratio = 1.0;           ///< E_c/E_b
  double contact_stiffness_ratio = 1.0; ///< κ_c
  double radius_multiplier = 1.0;       ///< λ
  double moment_contribution = 1.0;     ///< β
};
} // namespace feldspar
