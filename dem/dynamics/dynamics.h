#pragma once

#include "dem/dynamics/contact_watch.h"
#include "dem/dynamics/energy_ledger.h"
#include "dem/dynamics/force_sum.h"
#include "dem/dynamics/grips.h"
#include "dem/dynamics/images.h"
#include "dem/dynamics/incidence.h"
#include "dem/dynamics/parameters.h"
#include "dem/dynamics/runaway.h"
#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/dynamics/sweeps/motion.h"
#include "dem/dynamics/touches.h"
#include "dem/dynamics/walls.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/rigid_groups.h"
#include "dem/specimen/specimen.h"
#include "laboratory/energies.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// The joint of a break, of the law or smooth.
struct BrokenJoint
{
  std::uint32_t number;
  GrainPair ends;
  bool is_smooth;
};

/// Explicit dynamics of a specimen: central differences with velocities at half steps, local non-viscous damping
/// (Cundall 1987) and contacts that come and go; docs/theory.md §2. One step costs two sweeps, over contacts, with
/// the sums of their forces, and over grains; sums run in a fixed order, so that results do not depend on the number of
/// threads. The integrator owns the contacts without a face, the walls, the grips, the images and the energy ledger and
/// says when each has its turn; how they do it stands with them.
template <int dim>
class Dynamics
{
public:
  Dynamics(Specimen<dim> specimen, const DynamicsParameters& parameters, ZeroForce zero_force);

  /// Both before the first step; the number identifies the wall or grip.
  std::size_t add_wall(const Wall& wall) { return wall_set.add(wall); }
  /// A set of grains that moves as one, without turning; of a rigid group it holds all or none, as most of its grains do.
  std::size_t add_grip(std::vector<std::uint32_t> members, const Vector<dim>& velocity);
  /// Body acceleration from the next step on [m/s²]; its work counts as boundary work.
  void set_gravity(const Vector<dim>& acceleration) { gravity = acceleration; }

  /// Called within a step too where contacts are looked for, which takes seconds for millions of grains. After what it throws
  /// nothing can be done with this object any more.
  void set_check(std::function<void()> within_a_step) { check = std::move(within_a_step); }

  /// Sets the rate at which the cell of a periodic body, and with it every image, moves away from the origin [1/s]. The
  /// work of this motion counts as boundary work.
  void deform_cell(const Tensor<dim>& rate) { images.deform(rate); }
  /// The same, and the grains start with the motion of the cell about its middle, so that no wave has to bring it to
  /// them.
  void deform_body(const Tensor<dim>& rate);

  /// Adds to the velocity of a grain from outside [m/s]; the energy this gives counts as there from the start.
  void push(std::uint32_t grain, const Vector<dim>& velocity);

  /// Forces on the grains from outside [N], from the next step on until they are set anew; their work counts as boundary
  /// work.
  void apply_forces(const Components<dim>& forces);

  /// Before the first step: keeps the joints of the own grains alone, to compute the body together with partners, which all have it
  /// as it stands. Once all have done so, every function that is not const, and every measure, is called by all of them at once.
  /// Results are the same to the bit for any number of partners. Throws InputError for a body that cannot be shared.
  void share(Partners& with);
  void meet();
  const BodyShare<dim>& sharing() const { return part; }
  /// Brings the motions, or the positions alone, of all grains of a shared body up to date, which otherwise are those of the
  /// own ones and their neighbours.
  void know_all_motions();
  void know_all_positions() { part.bring_all(body.grains.position); }
  /// The same of all numbers of the grains, for transfer().
  void know_all();
  /// The largest work of a process over the largest after a new division.
  double unevenness() const { return part.unevenness(body); }

  /// Advances by one step and returns what broke in it, of a shared body that which this process counts. Throws Runaway where numbers
  /// have gone wrong, which it looks for whenever it looks for contacts that may be missed.
  std::vector<Break> step();
  /// Number of all breaks in the last step.
  std::size_t n_breaks() const { return released.size(); }
  /// Throws Runaway where a grain moves as none can.
  void check_motion() const;
  /// The error for trouble with the whole body: it names the fastest grain, the step and the likely reason.
  Runaway runaway(const std::string& trouble) const;

  /// After a change of radii, positions or velocities from outside: looks for contacts anew; overlaps count.
  void restart();

  /// Images of a periodic body stand behind its own grains.
  const Specimen<dim>& specimen() const { return body; }
  /// Finds the joint of this number by its first grain; none once it has lost its face.
  std::optional<std::size_t> joint_of(std::uint32_t grain_1, std::uint32_t number) const;
  /// The joint of a break of the last step.
  BrokenJoint joint_of(const Break& event) const;
  Specimen<dim>& specimen() { return body; }
  const std::vector<Wall>& walls() const { return wall_set.list(); }

  double time() const { return current_time; }
  double time_step() const { return dt; }
  std::uint64_t n_steps() const { return steps; }

  Wall& wall(const std::size_t i) { return wall_set[i]; }
  /// Sum of the normal stiffnesses of a wall's pressing contacts [N/m].
  double wall_stiffness_in_touch(const std::size_t wall) const { return wall_set.stiffness_in_touch(body, wall); }

  /// Sum of the grains' pressure on a wall [N], compression positive.
  double wall_force(std::size_t wall) const { return wall_set.force(wall); }
  /// Sum of contact forces on a grip's grains [N].
  Vector<dim> grip_force(const std::size_t grip) const
  {
    return shared_grip_forces.empty() ? grips.force(grip, bodies()) : shared_grip_forces[grip];
  }

  /// Energies since the start; kinetic energy and works centred at the current time, so that they balance (theory.md
  /// §2.3).
  Energies energies() const;
  /// Mean unbalanced force of the free grains over the mean contact force; 0 without contacts.
  double unbalanced_force_ratio() const;
  /// The largest over the mean; of a body without grips.
  double largest_unbalanced_force_ratio() const;
  /// -(1/V) Σ f ⊗ l over all contacts and walls [Pa], tension positive.
  Tensor<dim> mean_stress() const;
  /// Stress of each grain, a pull > 0: Σ f ⊗ (x_c - x) over contacts at x_c, over its share of the body's volume, its own
  /// over the solid share [Pa]; symmetric where its couples balance. Members of a rigid group have that of their group.
  /// The stress of one grain scatters by the size of the stress; the mean over some tens of grains is that of the body
  /// there. [n_grains]
  std::vector<Tensor<dim>> grain_stresses() const;
  /// Mean stress of a periodic body from the contacts across the sides of the cell alone: the mean of the tractions. It
  /// equals the other mean where forces balance.
  Tensor<dim> boundary_stress() const;
  /// Sum of the forces on all grains along an axis [N].
  double sum_of_forces(int axis) const;
  /// Force that the grains above a plane across the last axis receive from those below [N], along that axis.
  double force_across(double height) const;
  /// The fragment of each grain, as fragments() of specimen/fragments.h; [n_grains].
  std::vector<std::uint32_t> fragments() const;
  /// Contacts without a face that press, twice their number over that of grains.
  double faceless_coordination_number() const;

  /// All that the next step depends on, for an archive with value(), array() and bytes(); the specimen's sizes, the
  /// walls and the grips are those of the same test set up anew. The first process of a shared body writes, after know_all(), what
  /// all have, and others give theirs to an archive that writes nothing; it may give up, as BodyShare::gathered_by_first() says.
  /// Each reads its own part, by a new division; meet() before the next step.
  template <typename Archive>
  void transfer(Archive& archive);

private:
  void start();
  /// The moving bodies: the rigid groups, or else the grains (and the images of these behind them).
  const Grains<dim>& bodies() const { return groups.empty() ? body.grains : groups.bodies; }
  Grains<dim>& bodies() { return groups.empty() ? body.grains : groups.bodies; }
  /// The bodies that this process moves.
  GrainRange moved() const { return groups.empty() ? part.grains() : GrainRange{0, std::uint32_t(groups.size())}; }
  double kinetic_energy(std::uint32_t one_body) const;
  double squared_unbalanced_force(std::size_t one_body) const;
  double mean_contact_force() const;
  bool watch_is_over();
  bool remove_lost_contacts();
  bool regroup_joints();
  void index_joints();
  void find_contacts();
  void choose_time_step();
  Circumstances circumstances() const;
  double integrate();
  double work_of_gravity() const;
  std::vector<Break> update_contacts(double dt, double farthest_way);
  std::vector<std::vector<double>> works_of_applied_forces(double dt) const;
  std::vector<Break> agree(std::vector<Break> breaks, double dt);
  double largest_stiffness_ratio() const;
  void agree_on_copies();
  void know_copies();
  void keep_own();
  void add_boundary_work(double dt, double share);

  Specimen<dim> body;
  DynamicsParameters parameters;
  ZeroForce zero_force;
  Vector<dim> gravity = Vector<dim>::Zero();
  Components<dim> applied_force; ///< [N]; empty where none is
  std::function<void()> check = [] {};

  Images<dim> images;
  BodyShare<dim> part;
  std::vector<Vector<dim>> shared_grip_forces; ///< of a shared body; else empty [N]
  std::vector<std::size_t> term_counts; ///< of the terms that each process tells in a step; empty: to be asked for
  std::vector<double> released;         ///< by each break of the last step, by the numbers of joint and segment [J]
  RigidGroups<dim> groups;
  Touches<dim> touches;
  Walls<dim> wall_set;
  Grips<dim> grips;
  Incidence joints_of; ///< each grain
  SumOrder sum_order;
  InverseInertia inverse_inertia; ///< of the bodies
  SweepMemory<dim> sweep_memory;
  ContactWatch<dim> watch;
  EnergyLedger ledger;

  bool started = false;
  bool contact_made = false;    ///< since the time step was chosen
  bool faces_have_gone = false; ///< in the last step, with their bonds
  double dt = 0.0;              ///< [s]
  double previous_dt = 0.0;     ///< [s]
  double current_time = 0.0;
  std::uint64_t steps = 0;
};
} // namespace feldspar
