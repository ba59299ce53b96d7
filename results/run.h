#pragma once

#include "results/evaluation.h"
#include "results/sample_fields.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace feldspar
{
/// An entry of the input as it was understood, defaults included.
struct InputEntry
{
  std::string section;
  std::string entry;
  std::string value; ///< with its unit
};

/// What made the results: saved with them.
struct Provenance
{
  std::string version;
  std::string commit;
  std::string input_file;
  std::vector<InputEntry> input;
  std::string processor;
  unsigned int n_threads = 1;
};

/// The volume of grains at a point of a sample, as it was when the test ended.
struct PointVolume
{
  std::string which; ///< most damaged, median, intact
  unsigned int cell; ///< as in the fields, from 0
  unsigned int point;
  std::array<double, 3> position{}; ///< as the nodes of the mesh are given; in r-z r, θ and z [m]
  std::uint64_t n_segments;
  std::vector<GrainPicture> grains; ///< along the axes of the sample [m]
  std::vector<Crack> cracks;        ///< where they are at rest

  std::string place() const { return std::to_string(cell) + ":" + std::to_string(point); }
};

/// A finished test with its results.
struct FinishedTest
{
  TestRecord record;
  TestResults results;
  std::string group;   ///< what it is averaged with over the seeds: triaxial_compression_5_MPa
  std::string name;    ///< of its files and figures: triaxial_compression_5_MPa_seed_1
  std::string variant; ///< Section/Entry = value; empty where there are none

  // Of a sample of finite elements.
  SampleFields fields;              ///< read back from the folder; never written by who writes a result folder
  std::vector<PointVolume> volumes; ///< of a few points
};
} // namespace feldspar
