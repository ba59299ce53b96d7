// The step of one body that all processes compute together, with what of it goes to partners:
//
//   mpirun -n RANKS shared_body plane|space BRICKS STEPS THREADS
//
// BRICKS: equal periodic packings along each axis that the body is put together from: of some 970 discs or 6 300 spheres each.

#include "base/ranks/communicator.h"
#include "base/ranks/ranks.h"
#include "dem/dynamics/dynamics.h"
#include "dem/genesis/coring.h"
#include "dem/genesis/genesis.h"
#include "runs/process_partners.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
using namespace feldspar;
using Clock = std::chrono::steady_clock;

constexpr double rate = -0.01;           // of the axial strain [1/s]; so slow that nothing breaks
constexpr unsigned int first_steps = 20; // not timed: contacts are looked for, pages come to be

double seconds_since(const Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Tells how long the partners are waited for.
class TimedPartners : public ProcessesAsPartners
{
public:
  std::vector<std::byte> gathered(const std::span<const std::byte> own, std::vector<std::size_t>& sizes) override
  {
    const auto begin = Clock::now();
    auto all = ProcessesAsPartners::gathered(own, sizes);
    in_gathers += seconds_since(begin);
    return all;
  }
  void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
                std::vector<double>& received, const std::vector<std::size_t>& first_received) override
  {
    const auto begin = Clock::now();
    ProcessesAsPartners::exchange(sent, first_sent, received, first_received);
    in_exchanges += seconds_since(begin);
    bytes_received = sizeof(double) * received.size();
  }

  double in_gathers = 0.0, in_exchanges = 0.0; ///< [s]
  std::size_t bytes_received = 0;              ///< in a step
};

template <int dim>
Specimen<dim> body_of(const unsigned int n_bricks)
{
  SpecimenParameters wanted;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  std::array<unsigned int, dim> n;
  n.fill(n_bricks);
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = 0.05;
  if constexpr (dim == 3)
    {
      wanted.dimension = 3;
      wanted.porosity = 0.37;
      wanted.width = wanted.height = 0.0292;
    }
  return cored<dim>(repeated<dim>(make_specimen<dim>(wanted, joint, {}, 1), n), BodyShape::box);
}

template <int dim>
void time_steps(const unsigned int n_bricks, const unsigned int n_steps)
{
  Specimen<dim> body = body_of<dim>(n_bricks);
  const double height = body.size[dim - 1];
  const std::size_t n_grains = body.grains.size(), n_joints = body.joints.size();
  Dynamics<dim> dynamics(std::move(body), {}, ZeroForce::as_placed);
  for (std::uint32_t i = 0; i < n_grains; ++i)
    dynamics.push(i, rate * dynamics.specimen().grains.position[dim - 1][i] * Vector<dim>::Unit(dim - 1));
  dynamics.add_wall({.axis = dim - 1});
  dynamics.add_wall({.axis = dim - 1, .side = -1.0, .position = height, .velocity = rate * height});
  TimedPartners partners;
  if (ranks::number() > 1)
    dynamics.share(partners);
  for (unsigned int step = 0; step < first_steps; ++step)
    dynamics.step();
  // The least of blocks of steps: other work on the machine lasts longer than a block, and seldom as long as all.
  constexpr unsigned int block = 10;
  double total = std::numeric_limits<double>::infinity(), in_exchanges = 0.0, in_gathers = 0.0; // of a step [s]
  for (unsigned int from = 0; from < n_steps; from += block)
    {
      partners.in_gathers = partners.in_exchanges = 0.0;
      const auto begin = Clock::now();
      for (unsigned int step = 0; step < block; ++step)
        dynamics.step();
      if (const double one = seconds_since(begin) / block; one < total)
        {
          total = one;
          in_exchanges = partners.in_exchanges / block;
          in_gathers = partners.in_gathers / block;
        }
    }
  const double work = dynamics.energies().boundary_work;
  const auto all = ranks::sums(
    {total, in_exchanges, in_gathers, double(dynamics.specimen().joints.size()), double(partners.bytes_received)});
  const double n = ranks::number();
  if (ranks::is_first())
    fmt::print("{{\"ranks\": {}, \"grains\": {}, \"joints\": {}, \"joints_computed\": {}, \"step_s\": {:.6g}, "
               "\"exchange_s\": {:.6g}, \"gather_s\": {:.6g}, \"bytes_exchanged\": {:.6g}, \"boundary_work_J\": {}}}\n",
               ranks::number(), n_grains, n_joints, all[3], all[0] / n, all[1] / n, all[2] / n, all[4], work);
}
} // namespace

int main(int n_arguments, char** arguments)
{
  const std::vector<std::string> words(arguments + 1, arguments + n_arguments);
  if (words.size() != 4 || (words[0] != "plane" && words[0] != "space"))
    {
      std::fputs("shared_body plane|space BRICKS STEPS THREADS\n", stderr);
      return 2;
    }
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  {
    const ranks::Group all(MPI_COMM_WORLD);
    const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                              std::stoul(words[3]));
    const auto n_bricks = unsigned(std::stoul(words[1])), n_steps = unsigned(std::stoul(words[2]));
    words[0] == "plane" ? time_steps<2>(n_bricks, n_steps) : time_steps<3>(n_bricks, n_steps);
  }
  MPI_Finalize();
}
