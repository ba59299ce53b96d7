#pragma once

#include "coupling/rve/path_run.h"
#include "dem/dynamics/dynamics.h"

namespace feldspar
{
struct ExplicitParameters
{
  double largest_step = 1e-5; ///< of any component of the strain, between two samples
  std::uint64_t steps_per_millistrain = 100000;
  DynamicsParameters dynamics{};
};

/// The path of a PathRun gone by explicit dynamics, a fixed number of steps for each strain: the reference for the RVE
/// that breaks from event to event. Here the grains turn and move apart as far as they do, and what is not in
/// equilibrium shows; docs/theory.md §9.7.
template <int dim>
class ExplicitRun
{
public:
  /// The network is that of the specimen.
  ExplicitRun(const Specimen<dim>& specimen, std::shared_ptr<const Network<dim>> network,
              std::vector<PathLeg<dim>> legs, const ExplicitParameters& parameters);

  bool has_ended() const { return leg == legs.size() || !path_record.failure.empty(); }
  /// Advances to the next sample; where numbers go wrong on the way, the record says so and the path has ended.
  void advance();
  /// Share of the path that is behind, 0 … 1.
  double progress() const;

  /// Settling energy is what was damped and what still moves; the Hill-Mandel residual compares the work of the boundary
  /// with that of the contacts since the sample before.
  const PathRecord<dim>& record() const { return path_record; }
  /// Strain, stress and what has broken; without the grains' motions.
  NetworkState<dim> state() const;

  /// A state from which read_checkpoint() of the same run goes on to the same bits.
  void write_checkpoint(const std::filesystem::path& file, const std::string& identity) const;
  /// Throws InputError where the file is damaged or another run's.
  void read_checkpoint(const std::filesystem::path& file, const std::string& identity);

private:
  void go_an_increment();
  void begin_leg();
  Voigt<dim> served(const Control<dim>& control, const Voigt<dim>& way);
  void step(const Voigt<dim>& way);
  void judge_servo(const Control<dim>& control);
  void add_sample();
  template <typename Archive>
  void transfer(Archive& archive);

  std::vector<PathLeg<dim>> legs;
  ExplicitParameters parameters;
  RepresentativeVolume<dim> intact; ///< never strained: tells how the rock responds at first
  Dynamics<dim> dynamics;
  std::vector<std::uint32_t> joint_of_number; ///< as the network counts joints
  PathRecord<dim> path_record;

  std::uint64_t leg = 0;
  std::uint64_t increment = 0; ///< of the leg
  LegCourse<dim> course;       ///< of the leg
  Voigt<dim> strain = Voigt<dim>::Zero();
  Voigt<dim> lag = Voigt<dim>::Zero(); ///< strain per step that the servo has learnt to add
  double largest_stress = 0.0;         ///< there was or was to be, as a norm [Pa]
  double missing_stress = 0.0;         ///< largest component in the last step [Pa]
  std::uint64_t n_steps_missing = 0;   ///< up to now in which too much of it was
  double work_of_contacts = 0.0;       ///< at the last sample [J]
};
} // namespace feldspar
