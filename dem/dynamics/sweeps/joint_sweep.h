#pragma once

#include "base/page_allocator.h"
#include "base/parallel.h"
#include "dem/storage/joints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace feldspar
{
/// A segment that broke in a sweep.
struct Break
{
  std::uint32_t joint;
  std::uint32_t segment;
  bool in_tension;        ///< else in shear
  double released_energy; ///< [J]
};

/// The working arrays of a sweep, kept for the next.
template <int dim>
struct SweepMemory
{
  SweepMemory() = default;
  /// Anew after joints have gone or bonds were changed from outside.
  explicit SweepMemory(const Joints<dim>& joints);

  static constexpr std::size_t tensile_strength = 0, cohesion = 1, n_weakest = 2;
  /// The least strengths of each joint's bonds [Pa]. Where not all of them hold, the tensile one is below every stress, and
  /// the cohesion is one of two marks.
  PackedRows weakest;
  /// No bond holds, no element has a shear stress, and the face is open: it carries nothing until it closes.
  static constexpr double stands_open = std::numeric_limits<double>::infinity();
  static constexpr double in_pieces = -stands_open;

  /// Centre of each grain [m] and its turn over the step [rad], each followed by nothing up to the next four numbers;
  /// in the plane both in one four: x, y, φ.
  static constexpr std::size_t record_size = dim == 2 ? 4 : 8;
  LargeVector<double> grain_records;
  std::optional<GrainRange> known;   ///< the grains whose motions are known; none: all
  std::vector<std::uint32_t> copied; ///< others whose motions are known
};

/// Work behind a sweep, while the processor still has the responses of the joints at hand.
struct BehindSweep
{
  /// Number of blocks of joints (base/parallel.h) that the same thread sweeps one after the other.
  std::size_t blocks_in_a_row = fewest_blocks_in_a_row;
  /// Called when a block of joints has its responses.
  std::function<void(std::size_t block)> work = [](std::size_t) {};
};

/// Carries every joint over one step of dt [s]: reads the grains' positions (at its end) and spins (at its middle),
/// updates the segments and leaves forces and couples in the joints. Breaks come by the numbers of joint and segment,
/// whatever the number of threads.
template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, double dt, SweepMemory<dim>& memory,
                                const BehindSweep& behind = {});

/// The same with nothing kept from step to step.
template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, const double dt)
{
  SweepMemory<dim> memory(joints);
  return sweep_joints(joints, grains, dt, memory);
}

/// τ of a segment, stored or known by the law [Pa].
template <int dim>
std::array<double, dim - 1> shear_stress(const Joints<dim>& joints, unsigned int segment, std::size_t joint);

/// Returns whether a joint still has a face. A face is removed once all its bonds are broken and its two sides have
/// slid or opened past each other. If the faces of a law cannot slide off, only the opening counts; if they go with
/// their bonds, the last break removes them.
template <int dim>
bool has_face(const Joints<dim>& joints, std::size_t joint);

/// Stored in the segments of a joint [J].
template <int dim>
double joint_energy(const Joints<dim>& joints, std::size_t joint);

/// Dissipated by the bonds of a joint while they hold; nothing by a law whose bonds dissipate in breaking only [J].
template <int dim>
double dissipated_by_bonds(const Joints<dim>& joints, std::size_t joint);
} // namespace feldspar
