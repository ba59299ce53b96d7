#pragma once

#include "coupling/rve/path_sample.h"
#include "coupling/rve/representative_volume.h"

#include <filesystem>
#include <string>
#include <vector>

/// A representative volume that follows a path of strains and stresses.
namespace feldspar
{
class Hdf5Reader;
class Hdf5Writer;

/// A straight stretch of a path: what is given moves in proportion from where it stands to the target.
template <int dim>
struct PathLeg
{
  Control<dim> target;
  bool counts_from_here = false; ///< given strains are added to those at which the leg begins
};

/// A leg from where it begins.
template <int dim>
struct LegCourse
{
  LegCourse() = default;
  /// `start`: strain and stress at which it begins; `rve`: whose path it is.
  LegCourse(const PathLeg<dim>& leg, const NetworkState<dim>& start, const RepresentativeVolume<dim>& rve);

  /// The given strains and stresses where a share of the leg is behind.
  Control<dim> at(double share) const;
  /// Largest change of a component of the intact RVE's strain, tensor shear.
  double size() const { return strain_tensor<dim>(way).cwiseAbs().maxCoeff(); }
  /// Number of increments of which none changes a strain by more than `largest_step`.
  std::uint64_t n_increments(double largest_step) const;

  Control<dim> start;                  ///< what the target gives, where it begins
  Control<dim> target;                 ///< with strains counted from rest
  Voigt<dim> way = Voigt<dim>::Zero(); ///< strain from start to target of the intact RVE
};

/// "strain_xx = 1e-4, stress_yy = …", each strain or stress that is given.
template <int dim>
std::string describe(const Control<dim>& control);

struct PathParameters
{
  double largest_step = 1e-5; ///< of any component of the strain, per increment
  unsigned int most_cuts = 8; ///< halvings of an increment that finds no equilibrium
  EquilibriumParameters equilibrium{};
};

/// A broken segment.
template <int dim>
struct PathCrack
{
  std::uint64_t increment; ///< number of the sample in which it shows
  std::uint32_t joint;
  std::uint32_t segment; ///< of the joint
  bool in_tension;
  double released_energy; ///< [J]
};

template <int dim>
struct PathRecord
{
  std::vector<PathSample<dim>> samples; ///< the first where the path begins
  std::vector<PathCrack<dim>> cracks;
  std::string failure; ///< why the path was not gone to its end; empty if it was
};

/// Checkpoints of a path, whichever solver goes it. Reading throws InputError where the file is damaged or has another
/// identity.
void write_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                           const std::function<void(Hdf5Writer&)>& transfer);
void read_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                          const std::function<void(Hdf5Reader&)>& transfer);

/// Goes along a path, increment by increment. An increment that finds no equilibrium is cut in half; one that finds none
/// however small ends the path there, with the state before it kept.
template <int dim>
class PathRun
{
public:
  /// Begins from rest, or from a state of this network.
  PathRun(std::shared_ptr<const Network<dim>> network, std::vector<PathLeg<dim>> legs, const PathParameters& parameters,
          const std::optional<NetworkState<dim>>& begin = std::nullopt);

  bool has_ended() const { return leg == legs.size() || !path_record.failure.empty(); }
  /// One increment, or one more cut of it. One in which segments break goes no farther than to the first break, within
  /// the smallest cut. gives_up: asked in every iteration; where it says so, GivenUp is thrown and nothing has happened.
  void advance(const std::function<bool()>& gives_up = {});
  /// Share of the path that is behind, 0 … 1.
  double progress() const;

  const PathRecord<dim>& record() const { return path_record; }
  const RepresentativeVolume<dim>& rve() const { return body; }
  const NetworkState<dim>& state() const { return body.state(); }

  /// A state from which read_checkpoint() of the same run goes on to the same bits.
  void write_checkpoint(const std::filesystem::path& file, const std::string& identity) const;
  /// Throws InputError where the file is damaged or another run's.
  void read_checkpoint(const std::filesystem::path& file, const std::string& identity);

private:
  void go_an_increment(const std::function<bool()>& gives_up);
  void begin_leg();
  Control<dim> control_at(const std::uint64_t place) const { return course.at(double(place) / double(length)); }
  struct Evaluation
  {
    PathSample<dim> sample;
    BorneForces<dim> forces;
  };
  Evaluation evaluate(const NetworkState<dim>& state, const NetworkState<dim>& before, double unbalanced_ratio,
                      double least_work = 0.0) const;
  void add(Evaluation&& evaluated);
  template <typename Archive>
  void transfer(Archive& archive);

  std::vector<PathLeg<dim>> legs;
  PathParameters parameters;
  RepresentativeVolume<dim> body;
  PathRecord<dim> path_record;
  BorneForces<dim> forces; ///< at the last sample

  std::uint64_t leg = 0;
  NetworkState<dim> start;    ///< strain and stress at which the leg began
  LegCourse<dim> course;      ///< of the leg
  std::uint64_t position = 0; ///< on the leg, in the smallest increments
  std::uint64_t length = 1;   ///< of the leg, in the same
  std::uint32_t cuts = 0;     ///< of the increment
  bool next_is_short = false; ///< a break is near
};
} // namespace feldspar
