#pragma once

#include "dem/dynamics/energies.h"
#include "dem/dynamics/joint_sweep.h"
#include "dem/dynamics/parameters.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/linear_contact_law.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <map>
#include <vector>

namespace feldspar
{
/// A rigid plane across one axis, on which grains lie from one side; or a smooth cylinder about the last axis through
/// the middle of the specimen, whose coordinate is the distance from that axis.
struct Wall
{
  int axis = 0;
  double side = 1.0;     ///< +1: grains lie towards larger coordinates, -1: towards smaller ones
  double position = 0.0; ///< [m]
  double velocity = 0.0; ///< along its coordinate [m/s]
  double friction = 0.0;
  double servo_integral = 0.0; ///< inwards, of whoever holds its pressure [m/s]
  bool round = false;          ///< the cylinder
};

/// The side of a cylinder.
template <int dim>
Wall round_wall(const Specimen<dim>& specimen)
{
  return {.side = -1.0, .position = 0.5 * specimen.size[0], .round = true};
}

/// Where a contact without a face begins to press.
enum class ZeroForce
{
  at_touch, ///< where the surfaces touch
  as_placed ///< overlaps that are there at the start count as zero force
};

/// Explicit dynamics of a specimen: central differences with velocities at half steps, local non-viscous damping
/// (Cundall 1987) and contacts that come and go; docs/theory.md §2. One step costs two sweeps, over contacts and over
/// grains; sums run in a fixed order, so that results do not depend on the number of threads.
template <int dim>
class Dynamics
{
public:
  Dynamics(Specimen<dim> specimen, const DynamicsParameters& parameters, ZeroForce zero_force);

  /// Both before the first step; the number identifies the wall or grip.
  std::size_t add_wall(const Wall& wall);
  /// A set of grains that moves as one, without turning.
  std::size_t add_grip(std::vector<std::uint32_t> members, const Vector<dim>& velocity);
  /// Body acceleration [m/s²]; its work counts as boundary work.
  void set_gravity(const Vector<dim>& acceleration) { gravity = acceleration; }

  /// Of a periodic body: the rate at which the cell, and with it every image, moves away from the origin [1/s]. Its work
  /// counts as boundary work.
  void deform_cell(const Tensor<dim>& rate) { cell_rate = rate; }
  /// The same, and the grains are set off with the motion of the cell about its middle, so that no wave has to tell them.
  void deform_body(const Tensor<dim>& rate);

  /// Adds to the velocity of a grain from outside [m/s]; the energy this gives counts as there from the start.
  void push(std::uint32_t grain, const Vector<dim>& velocity);

  /// Forces on the grains from outside [N], from the next step on until they are set anew; their work counts as boundary
  /// work.
  void apply_forces(const Components<dim>& forces);

  /// Advances by one step and returns what broke in it.
  std::vector<Break> step();

  /// After a change of radii, positions or velocities from outside: looks for contacts anew; overlaps count.
  void restart();

  /// Images of a periodic body stand behind its own grains.
  const Specimen<dim>& specimen() const { return body; }
  Specimen<dim>& specimen() { return body; }
  const std::vector<Wall>& walls() const { return wall_list; }

  double time() const { return current_time; }
  double time_step() const { return dt; }
  std::uint64_t n_steps() const { return steps; }

  Wall& wall(const std::size_t i) { return wall_list[i]; }
  /// Sum of the normal stiffnesses of a wall's pressing contacts [N/m].
  double wall_stiffness_in_touch(std::size_t wall) const;

  /// Sum of the grains' pressure on a wall [N], compression positive.
  double wall_force(std::size_t wall) const { return wall_forces[wall]; }
  /// Sum of contact forces on a grip's grains [N].
  Vector<dim> grip_force(std::size_t grip) const;

  /// Since the start; kinetic energy and works centred at the current time, so that they balance (theory.md §2.3).
  Energies energies() const;
  /// Mean unbalanced force of the free grains over the mean contact force; 0 without contacts.
  double unbalanced_force_ratio() const;
  /// The largest over the mean; of a body without grips.
  double largest_unbalanced_force_ratio() const;
  /// -(1/V) Σ f ⊗ l over all contacts and walls [Pa], tension positive.
  Tensor<dim> mean_stress() const;
  /// Of a periodic body, the same from the contacts across the sides of the cell alone: the mean of the tractions. Equal
  /// where forces balance.
  Tensor<dim> boundary_stress() const;
  /// Force that the grains above a plane across the last axis receive from those below [N], along that axis.
  double force_across(double height) const;
  /// Contacts without a face that press, twice their number over that of grains.
  double faceless_coordination_number() const;

  /// All that the next step depends on, for an archive with value(), array() and bytes(); the specimen's sizes, the
  /// walls and the grips are those of the same test set up anew.
  template <typename Archive>
  void transfer(Archive& archive);

private:
  /// Two grains near each other and without a face.
  struct Touch
  {
    std::uint32_t grain_1, grain_2;
    linear_contact::Stiffness stiffness;
    double zero_distance;          ///< centre distance below which they press [m]
    double half_radius_difference; ///< [m]
    bool touching = false;
    ContactFrame<dim, double> frame{}; ///< at the last step in which they touched
    std::array<double, dim - 1> shear_force{};
    double normal_force = 0.0;
    double slip_energy = 0.0;
    std::array<double, dim> force{};                 ///< on grain 2 [N]
    std::array<double, n_rotations<dim>> couple_1{}; ///< [N m]
    std::array<double, n_rotations<dim>> couple_2{}; ///< [N m]

    GrainPair ends() const { return {grain_1, grain_2}; }
  };

  /// What a step has to know of a pair that does not press, as most do not: kept together and small, while a Touch takes
  /// lines of the cache.
  struct TouchLook
  {
    std::uint32_t grain_1, grain_2;
    double zero_distance;
    bool touching;
  };

  /// A grain near a wall.
  struct WallTouch
  {
    std::uint32_t grain;
    double zero_distance; ///< distance from the wall below which it presses [m]
    double overlap = 0.0; ///< [m]
    std::array<double, dim - 1> shear_force{};
    double slip_energy = 0.0;
  };

  /// For each grain the contacts it takes part in: 2 × contact + (0: as grain 1, 1: as grain 2).
  struct Incidence
  {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> entries;
  };

  struct Grip
  {
    std::vector<std::uint32_t> members;
    Vector<dim> velocity;
  };

  std::uint32_t owner(const std::uint32_t grain) const { return grain < n_own ? grain : images[grain - n_own].owner; }
  std::uint32_t image_number(const PeriodicImage<dim>& image);
  void add_images();
  void move_images();

  template <typename EndsOf>
  Incidence incidence(std::size_t n_contacts, EndsOf&& ends_of) const;
  void start();
  Touch new_touch(std::uint32_t grain_1, std::uint32_t grain_2) const;
  auto find_touch(const GrainPair& pair);
  double kinetic_energy(std::uint32_t grain) const;
  double joint_energy(std::size_t joint) const;
  double mean_contact_force() const;
  void remove_torn_faces();
  void find_contacts();
  void choose_time_step();
  void integrate();
  std::vector<Break> update_contacts(double dt);
  void update_touches(double dt);
  void press_walls(double dt);
  Vector<dim> wall_direction(const Wall& wall, std::uint32_t grain) const;
  double wall_coordinate(const Wall& wall, std::uint32_t grain) const;
  std::array<double, dim - 1> slip_on_wall(const Wall& wall, std::uint32_t grain, double distance, double dt) const;
  void add_wall_shear(const Wall& wall, std::uint32_t grain, double distance,
                      const std::array<double, dim - 1>& shear_force);
  void number_contacts();
  void sum_forces();
  void add_boundary_work(double dt, double share);
  double smallest_gap_not_listed(std::size_t wall) const;
  bool contacts_may_be_missed();
  double touch_stiffness(double radius_1, double radius_2) const;
  double wall_stiffness(double radius) const;

  Specimen<dim> body;
  DynamicsParameters parameters;
  ZeroForce zero_force;
  Vector<dim> gravity = Vector<dim>::Zero();
  std::size_t n_own; ///< grains that are not images
  std::vector<PeriodicImage<dim>> images;
  std::map<PeriodicImage<dim>, std::uint32_t> number_of_image; ///< among all grains
  Tensor<dim> cell;                                            ///< edges of a periodic body's box, as columns [m]
  Tensor<dim> cell_rate = Tensor<dim>::Zero();
  std::vector<Wall> wall_list;
  Components<dim> applied_force; ///< [N]; empty where none is
  std::vector<Grip> grips;
  std::vector<std::uint8_t> held; ///< grains that belong to a grip

  std::vector<Touch> touches;
  std::vector<TouchLook> looks;                     ///< of each touch
  std::vector<std::vector<WallTouch>> wall_touches; ///< of each wall
  std::vector<double> wall_forces;
  Incidence joint_incidence, touch_incidence;
  Components<dim> position_at_search;
  std::vector<double> wall_position_at_search; ///< of each wall [m]
  Components<dim> position_at_start;
  double skin = 0.0; ///< gap up to which contacts are kept in mind [m]

  bool started = false;
  std::uint64_t next_look = 0; ///< step before which no contact can have been missed
  bool contact_made = false;   ///< since the time step was chosen
  double dt = 0.0;             ///< [s]
  double previous_dt = 0.0;    ///< [s]
  double current_time = 0.0;
  std::uint64_t steps = 0;

  std::vector<double> damping_work; ///< of each grain [J]
  double boundary_work = 0.0;
  double released_energy = 0.0;
  double strain_energy_at_start = 0.0;
  double kinetic_energy_at_start = 0.0;
  double slip_energy_of_lost_contacts = 0.0;
};
} // namespace feldspar
