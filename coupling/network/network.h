#pragma once

#include "coupling/network/boundary.h"
#include "coupling/network/factorised_network.h"
#include "coupling/network/link.h"
#include "dem/laws/joint_laws.h"
#include "dem/specimen/mineral_sides.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

/// A periodic specimen as a network in its reference configuration, under one of the boundaries that a cell may have: what all
/// copies of a representative volume share.
/// Normals, branch vectors, volume and pairs are those of the reference; links that turn with their grains are in
/// kinematics.h; docs/theory.md §9.
namespace feldspar
{
/// Normal and shear stress of a segment under unit strains, per Voigt component.
template <int dim>
using UnitResponse = Eigen::Matrix<double, dim, n_voigt<dim>>;

/// Point of a straight strain path at which the first segment breaks.
struct FirstBreak
{
  double factor; ///< of the direction; infinity if nothing breaks along it
  std::uint32_t segment;
  bool in_tension;
  double touch; ///< factor at which a pair without a face comes into contact; no response is linear beyond it
};

template <int dim>
class Network
{
public:
  /// The specimen turned by a rotation. Throws InputError where it is not periodic.
  explicit Network(const Specimen<dim>& specimen, const Tensor<dim>& rotation = Tensor<dim>::Identity(),
                   const Boundary& boundary = {});

  /// Number of grains of the cell and, behind them, of the images behind open sides.
  std::size_t n_grains() const { return number_of_grains; }
  std::size_t n_own_grains() const { return number_of_own_grains; }
  std::size_t n_joints() const { return number_of_joints; }
  std::size_t n_segments() const { return bonds.size(); }
  Eigen::Index n_unknowns() const { return n_motions<dim> * Eigen::Index(number_of_grains) + n_voigt<dim>; }
  double volume() const { return cell_volume; }
  double mean_branch() const { return mean_branch_length; }
  /// The mean over the joints of normal stiffness times length of the branch [N].
  double mean_normal_stiffness() const { return mean_stiffness; }

  /// Joints first, then pairs that may come into contact.
  const std::vector<Link<dim>>& links() const { return all_links; }
  const std::vector<FaceElement<dim>>& elements() const { return face; }
  /// Boxes over which a link crosses sides that are not open, axis by axis; [n_links].
  const std::vector<std::array<int, dim>>& boxes_crossed() const { return boxes; }
  const std::vector<Vector<dim>>& positions() const { return centres; }
  const std::vector<double>& radii() const { return grain_radii; }
  const Tensor<dim>& cell() const { return edges; }
  const Boundary& boundary() const { return its_boundary; }
  /// Conditions on the motions of the grains beside the affine ones.
  const std::shared_ptr<const BoundaryConditions<dim>>& conditions() const { return boundary_conditions; }

  const AnyJointLaw<dim>& law() const { return joint_law; }
  /// Else joints respond by their law (link_response.h) from the beginning.
  bool is_linear_while_bonded() const
  {
    return std::visit([](const auto& of_joints) { return of_joints.linear_while_bonded; }, joint_law);
  }
  /// Opening at the end of softening, of a law whose bonds soften before they break [m].
  std::optional<double> softening_opening() const
  {
    return std::visit(
      [](const auto& of_joints) -> std::optional<double> {
        if constexpr (requires { of_joints.softening_opening(); })
          return of_joints.softening_opening();
        else
          return std::nullopt;
      },
      joint_law);
  }
  const Bond<double>& bond(const std::uint32_t segment) const { return bonds[segment]; }
  double thickness() const { return plane_thickness; }
  /// The area of a link's segment i [m²].
  double segment_area(const Link<dim>& link, std::uint32_t i) const;
  std::uint32_t link_of_segment(const std::uint32_t segment) const
  {
    const auto n = std::uint32_t(bonds.size());
    return segment < n ? segment / std::uint32_t(face.size()) : std::uint32_t(number_of_joints) + segment - n;
  }
  /// Minerals of the cell; none where its grains are of none.
  const std::vector<MineralShare>& minerals() const { return its_minerals; }
  /// Minerals on both sides of a joint.
  MineralSides sides_of(const std::size_t joint) const { return its_minerals.empty() ? MineralSides() : sides[joint]; }
  /// Segments without a bond from the start.
  const std::vector<std::uint32_t>& unbonded() const { return unbonded_at_rest; }

  /// The stiffness of a link whose segments are all bonded.
  const JointStiffness<dim>& bonded_stiffness(const std::size_t joint) const { return bonded_stiffnesses[joint]; }

  /// The network with all bonds intact, K x.
  Unknowns apply_bonded(const Unknowns& unknowns) const;
  /// Factor that is nearly the inverse of this network.
  const FactorisedNetwork<dim>& factorised_intact() const { return *factorised; }
  /// The same with every pair that may come into contact closed: no state is stiffer.
  const FactorisedNetwork<dim>& factorised_stiffest() const { return *factorised_all; }
  /// Factor with other stiffnesses of the links, and a small stiffness of loose grains.
  FactorisedNetwork<dim> factorise(const LinkStiffnesses<dim>& stiffnesses, double regularising_share,
                                   std::shared_ptr<const BoundaryConditions<dim>> conditions) const
  {
    return {all_links, number_of_grains, std::move(conditions), stiffnesses, regularising_share * stiffness_scale};
  }
  /// Forces of each motion times the mean stiffness of its kind; strains give none. They are a scale for motions that
  /// have no stiffness of their own.
  Unknowns regularising_forces(const Unknowns& unknowns) const;

  // The intact response: while all segments hold and no pair comes into contact, everything is linear in the strain.
  // For a law whose faces are not linear it is the response of the stiffest state: a scale and a first guess.

  /// C_0 [Pa].
  const Stiffness<dim>& intact_stiffness() const { return c_0; }
  /// Grain motions under unit strains; [n_motions * n_grains × n_voigt].
  const Eigen::MatrixXd& unit_motions() const { return unit_motion; }
  /// Response to unit strains, for a law whose bonds carry the normal and shear stress of their segment, as all do now.
  const UnitResponse<dim>& unit_response(const std::uint32_t segment) const { return unit_responses[segment]; }
  Unknowns intact_unknowns(const Voigt<dim>& strain) const;
  /// Returns whether under a linear law no pair without a face can come into contact at this strain: with all bonds
  /// kept the network is then linear.
  bool stays_linear(const Voigt<dim>& strain) const;
  /// Returns whether no segment is overloaded and no pair is in contact at this strain.
  bool stays_intact(const Voigt<dim>& strain) const;
  /// First break along the ray `factor * direction`, in closed form.
  FirstBreak first_break(const Voigt<dim>& direction) const;

private:
  void factorise_intact();
  void solve_unit_strains();
  void bound_segments();

  Boundary its_boundary;
  std::shared_ptr<const BoundaryConditions<dim>> boundary_conditions;
  std::size_t number_of_own_grains;
  std::size_t number_of_grains;
  std::size_t number_of_joints;
  double cell_volume;
  double plane_thickness;
  AnyJointLaw<dim> joint_law;
  double mean_branch_length;
  double mean_stiffness;
  Tensor<dim> edges;
  std::vector<FaceElement<dim>> face;
  std::vector<Link<dim>> all_links;
  std::vector<std::array<int, dim>> boxes;
  std::vector<Vector<dim>> centres;
  std::vector<double> grain_radii;
  std::vector<Bond<double>> bonds;
  std::vector<std::uint32_t> unbonded_at_rest;
  std::vector<MineralShare> its_minerals;
  std::vector<MineralSides> sides; ///< [n_joints] in a rock of minerals
  std::vector<JointStiffness<dim>> bonded_stiffnesses;

  std::optional<FactorisedNetwork<dim>> factorised;
  std::optional<FactorisedNetwork<dim>> factorised_all;
  Motion<dim> stiffness_scale; ///< mean of the diagonal, of each motion of a grain
  Stiffness<dim> c_0;
  Eigen::MatrixXd unit_motion;
  std::vector<UnitResponse<dim>> unit_responses;

  /// Segments with the largest overload that a strain of unit norm could give them, largest first.
  struct Bound
  {
    double overload;
    std::uint32_t segment;
  };
  std::vector<Bound> bounds;
  std::vector<Voigt<dim>> opening_rates; ///< of pairs without a face, per unit strain [m]
  double touching_strain;                ///< norm below which no such pair can come into contact
};

/// Influence of the boundary of an RVE on its elasticity: the same grains and joints under the weakest and the
/// strictest hold on their boundary. All other boundaries lie between them; docs/theory.md §9.6.
template <int dim>
struct StiffnessBounds
{
  Stiffness<dim> minimal_kinematic; ///< [Pa], Voigt with engineering shear; zero where no joint leads over a side
  Stiffness<dim> affine;            ///< [Pa]
};

/// Bounds with all bonds intact, of the specimen turned by a rotation.
template <int dim>
StiffnessBounds<dim> stiffness_bounds(const Specimen<dim>& specimen,
                                      const Tensor<dim>& rotation = Tensor<dim>::Identity())
{
  const auto stiffness = [&](const BoundaryKind kind) {
    return Network<dim>(specimen, rotation, {.kind = kind}).intact_stiffness();
  };
  return {stiffness(BoundaryKind::minimal_kinematic), stiffness(BoundaryKind::affine)};
}
} // namespace feldspar
