#pragma once

#include "base/random.h"
#include "dem/laws/bond_strength.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/face.h"
#include "dem/laws/parameters.h"

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

/// A joint law says how the face between two grains responds to a motion of theirs, from its installation to its last
/// piece. The grains' dynamics (dem/dynamics) and the network of a representative volume (coupling/rve) ask the same law.
///
/// To add one:
///   1. Its parameters beside FlatJointParameters (parameters.h), with their entries, joint_entries(), in entries.h.
///   2. One header here: a struct that fulfils the concept JointLaw below, member by member as FlatJoint (flat_joint.h)
///      does. An element is a part of a face with a bond of its own; a face that breaks as a whole is divided into one,
///      {1} in the plane and {1, 1} in space.
///   3. Its name in the list of joint_laws.h, from which the entries of a specimen take its choices.
///   4. Tests as those of the flat joint: closed forms of one face, then tests/unit/joint_law_test.cc as a pattern.
/// Storage, genesis, the sweep by packs, energies, loss of faces, checkpoints and specimen files are written over the
/// concept and made for every law of the list; so are stiffness and overload of intact faces in the network. How a face
/// responds there that has broken, or that is not linear while it holds, stands in coupling/network: a function
/// face_response() for each law.
///
/// Every element of every law has a bond (bond_strength.h), a shear stress and a mark whether the bond holds; `n_more`
/// numbers of the law's own may go with them. A law with numbers of its own that are the same for all faces also has
/// `transfer(archive)`, which names each once for specimen files, and `is_possible()`, which tells whether numbers out of a
/// file can be such. Functions are pure; Real is double or a pack of doubles.
namespace feldspar
{
/// Stands for the elements of one face, as a law meets them: bond and state of each, and where its update goes.
template <typename Law, typename Real>
struct ElementsOfOneFace
{
  using State = typename Law::template State<Real>;

  Bond<Real> bond(unsigned int element) const;
  State state(unsigned int element) const;
  /// Takes the new state, and the event: update.state, update.tension_break, update.shear_break and, of a break,
  /// update.released_energy [J].
  template <typename Update>
  void set(unsigned int element, const Update& update);
};

/// The state of an element, to which the law may add `std::array<Real, n_more> more`.
template <typename State, int dim, typename Real>
concept ElementState = requires(State state)
{
  requires std::convertible_to<decltype(state.shear_stress), std::array<Real, dim - 1>>; // τ [Pa]
  requires std::convertible_to<decltype(state.bonded), decltype(Real() < Real())>;
};

/// Functions by which a joint's plane follows its grains and its forces reach them; CarriedPlane of contact_motion.h is
/// one.
template <typename Law, int dim, typename Real>
concept MovesWithItsGrains = requires(const ContactFrame<dim, Real> frame, const std::array<Real, dim> centre,
                                      const Real length, const std::array<Real, dim - 1> shear_force,
                                      const std::array<Real, n_rotations<dim>> turn)
{
  requires std::same_as<decltype(Law::motion(frame, centre, centre, length, turn, turn)), ContactMotion<dim, Real>>;
  requires std::same_as<decltype(Law::force(frame, length, length, shear_force, turn)), ContactForce<dim, Real>>;
};

/// Forces of a face after a step, and the new states of its elements.
template <typename Law, int dim, typename Real>
concept UpdatesFaces = ElementState<typename Law::template State<Real>, dim, Real> &&
  MovesWithItsGrains<Law, dim, Real> &&
  requires(const Law law, const Face<Real> face, const std::vector<FaceElement<dim>> elements,
           const FaceMotion<dim, Real> motion, ElementsOfOneFace<Law, Real> states)
{
  requires std::same_as<decltype(law.update(face, elements, motion, states)), FaceResultants<dim, Real>>;
};

/// A law may know the response of a face whose elements are all bonded, and store nothing else, from its motion since
/// installation. Such a law also knows when a face without bonds is open and carries nothing. The sweep then computes
/// elements one by one only where a bond may break or a broken face may press, and the shear stress of bonded faces
/// need not be stored.
template <typename Law, int dim, typename Real>
concept RespondsAsOne = requires(const Face<Real> face, const WholeFace<dim> whole, const Bond<Real> least,
                                 const FaceElement<dim> element, const Real opening,
                                 const std::array<Real, n_rotations<dim>> rotation,
                                 const std::array<Real, dim - 1> slip, const typename Law::template State<Real> state)
{
  // True if certainly no bond breaks; the bond has the least strengths of the face.
  requires std::same_as<decltype(Law::surely_holds(face, whole, least, opening, rotation, slip)),
                        decltype(Real() < Real())>;
  // True if a face without bonds is certainly open. If it was open before and had no shear stress, it carries nothing
  // and its elements stay as they are.
  requires std::same_as<decltype(Law::surely_open(face, whole, opening, rotation)), decltype(Real() < Real())>;
  requires std::same_as<decltype(Law::whole_response(face, whole, opening, rotation, slip)), FaceResultants<dim, Real>>;
  requires std::same_as<decltype(Law::whole_state(face, element, rotation, slip)), typename Law::template State<Real>>;
  // True if a bonded element has stored more than whole_state() tells: its face no longer responds as one.
  requires std::same_as<decltype(Law::remembers(state)), decltype(Real() < Real())>;
};

/// A law may have bonds that dissipate before they break; the energy of a break is then all that its bond has dissipated.
template <typename Law, int dim>
concept DissipatesBeforeBreaks = requires(const typename Law::template State<double> state)
{
  requires std::same_as<decltype(Law::dissipated_so_far(state)), double>; // of a bond that holds [J]
};

template <typename Law, int dim>
concept JointLaw = std::copyable<Law> && std::default_initializable<Law> && UpdatesFaces<Law, dim, double> &&
  UpdatesFaces<Law, dim, simd::Pack> &&
  std::constructible_from<Law, const typename Law::Parameters&, const ParticleContactParameters&> &&
  requires(const Law law, const typename Law::Parameters wanted, const ParticleContactParameters contact, Random random,
           const Face<double> face, const std::vector<FaceElement<dim>> elements,
           const std::array<double, n_rotations<dim>> rotation,
           typename Law::template State<double> (*state_of)(unsigned int), const ElementRows<dim> rows,
           const Motion<dim> motion, const FaceMotion<dim, double> motion_of_face,
           const typename Law::template Update<double> update)
{
  // The name, by which the input chooses it.
  requires std::convertible_to<decltype(Law::name), std::string_view>;
  // Numbers of the law's own in the state of an element.
  requires std::convertible_to<decltype(Law::n_more), std::size_t>;
  // True if a face persists when it has lost its last bond; otherwise its grains are then in contact without a face.
  requires std::convertible_to<decltype(Law::face_outlives_bonds), bool>;
  // True if such a face is removed once its sides have slid past each other; otherwise only once they are far apart.
  requires std::convertible_to<decltype(Law::face_can_slide_off), bool>;

  // Installation.
  requires std::same_as<decltype(Law::division(wanted)), FaceDivision<dim>>;
  requires std::same_as<decltype(Law::draw_bonds(wanted, std::size_t(1), random)), std::vector<Bond<double>>>;
  // μ of a face, from the law's parameters or those of pairs without a face.
  requires std::same_as<decltype(Law::friction(wanted, contact)), double>;

  // Stored in a face, from its opening, its rotation and the states of its elements [J].
  requires std::same_as<decltype(law.stored_energy(face, elements, 0.0, rotation, state_of)), double>;

  // Mean normal stress of an element after its update [Pa].
  requires std::same_as<decltype(Law::normal_stress(face, elements.front(), motion_of_face, update)), double>;

  // Springs for the time step: no state of the face is stiffer.
  requires std::same_as<decltype(law.stiffest(face)), FaceSprings>;

  // In small strains: whether a face responds linearly as long as all its bonds hold and none has stored anything, with
  // the stiffness below, and none of its elements has a shear stress to store.
  requires std::convertible_to<decltype(Law::linear_while_bonded), bool>;
  // True if representative volumes find equilibria of its faces event by event: coupling/network has its
  // face_response().
  requires std::convertible_to<decltype(Law::has_equilibria), bool>;
  // In small strains: share of a bonded element in the stiffness of its face, and the stress its bond carries.
  requires std::same_as<decltype(law.bonded_stiffness(face, elements.front(), rows)), JointStiffness<dim>>;
  requires std::same_as<decltype(law.bond_stress(face, law.strain(rows, motion))), BondStress>;
};
} // namespace feldspar
