// One body for the programs that stand beside this one, and the time of a step of ours on it:
//
//   own_step make BODY FOLDER              writes FOLDER/BODY.h5, BODY-grains.csv and BODY-joints.csv
//   own_step time BODY FOLDER STEPS THREADS
//
// BODY: plane-flat-joint, plane-parallel-bond, space-flat-joint or space-parallel-bond. Grains and joined pairs depend on
// plane or space alone.

#include "benchmarks/committed_version.h"
#include "dem/dynamics/dynamics.h"
#include "dem/genesis/coring.h"
#include "dem/genesis/genesis.h"
#include "dem/specimen/specimen_file.h"

#include <oneapi/tbb/global_control.h>

#include <chrono>
#include <filesystem>
#include <fmt/os.h>
#include <stdexcept>
#include <string>

namespace
{
using namespace feldspar;

constexpr double rate = -0.01;           // of the axial strain [1/s]; so slow that nothing breaks
constexpr unsigned int first_steps = 20; // not timed: contacts are looked for, pages come to be

JointParameters joint_of(const std::string& body)
{
  if (body.ends_with("parallel-bond"))
    {
      ParallelBondParameters bond;
      bond.installation_gap_ratio = 0.05;
      return bond;
    }
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  return joint;
}

/// 1 950 discs between walls in the plane; in space a cylinder of 53 mm × 106 mm cut out of equal periodic packings.
template <int dim>
Specimen<dim> body_named(const std::string& body)
{
  SpecimenParameters wanted;
  if constexpr (dim == 2)
    return make_specimen<2>(wanted, joint_of(body), {}, 1);
  else
    {
      constexpr unsigned int n_across = 2;
      wanted.dimension = 3;
      wanted.porosity = 0.37;
      wanted.shape = BodyShape::periodic;
      wanted.width = wanted.height = 0.0265;
      return cored<3>(repeated<3>(make_specimen<3>(wanted, joint_of(body), {}, 1), {n_across, n_across, 2 * n_across}),
                      BodyShape::cylinder);
    }
}

template <int dim>
void set_off(Specimen<dim>& specimen)
{
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    specimen.grains.velocity[dim - 1][i] = rate * specimen.grains.position[dim - 1][i];
}

template <int dim>
void make(const std::string& body, const std::filesystem::path& folder)
{
  const std::string version_of_results = committed_version();
  Specimen<dim> specimen = body_named<dim>(body);
  write_specimen(specimen, folder / (body + ".h5"));
  set_off(specimen);
  auto grains = fmt::output_file((folder / (body + "-grains.csv")).string());
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      for (const auto* const row : {&specimen.grains.position, &specimen.grains.velocity})
        for (int c = 0; c < 3; ++c)
          grains.print("{:.17g},", c < dim ? (*row)[std::size_t(c)][i] : 0.0);
      grains.print("{:.17g}\n", specimen.grains.radius[i]);
    }
  auto joints = fmt::output_file((folder / (body + "-joints.csv")).string());
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    joints.print("{},{}\n", specimen.joints.grain_1[j], specimen.joints.grain_2[j]);
  fmt::print("{{\"feldspar_version\": \"{}\", \"grains\": {}, \"joints\": {}, \"segments_of_a_joint\": {}}}\n",
             version_of_results, specimen.grains.size(), specimen.joints.size(), specimen.joints.n_segments);
}

template <int dim>
void time(const std::string& body, const std::filesystem::path& folder, const unsigned int n_steps)
{
  Specimen<dim> specimen = read_specimen<dim>(folder / (body + ".h5"));
  set_off(specimen);
  Dynamics<dim> dynamics(std::move(specimen), {}, ZeroForce::as_placed);
  const auto advance = [&](const unsigned int n) {
    for (unsigned int k = 0; k < n; ++k)
      if (!dynamics.step().empty())
        throw std::runtime_error("a bond broke: this is no step of an intact body");
  };
  advance(first_steps);
  const auto start = std::chrono::steady_clock::now();
  advance(n_steps);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  fmt::print("{{\"seconds_of_a_step\": {:.6g}, \"bonds\": {}}}\n", taken.count() / n_steps,
             dynamics.specimen().joints.size());
}
} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "make")
    words[1].starts_with("space") ? make<3>(words[1], words[2]) : make<2>(words[1], words[2]);
  else if (words.size() == 5 && words[0] == "time")
    {
      const auto n_steps = unsigned(std::stoul(words[3]));
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                              std::stoul(words[4]));
      words[1].starts_with("space") ? time<3>(words[1], words[2], n_steps) : time<2>(words[1], words[2], n_steps);
    }
  else
    {
      fmt::print(stderr, "own_step make BODY FOLDER, or own_step time BODY FOLDER STEPS THREADS\n");
      return 2;
    }
}
