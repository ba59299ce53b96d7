#include "app/volume_extract.h"

#include "app/field_output.h"
#include "app/multiscale_run.h"
#include "app/run_record.h"
#include "coupling/volume_file.h"
#include "dem/fragments.h"
#include "dem/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
struct Place
{
  unsigned int cell;
  unsigned int point;
};

Place place_of(const std::string& text)
{
  const auto number = [&](const std::string_view part) {
    unsigned int value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size())
      throw InputError(
        fmt::format("--extract {}: must be CELL:POINT, the number of a cell as ParaView shows it and of a "
                    "point in it, both from 0, e.g. 3:0",
                    text));
    return value;
  };
  const std::string_view all = text;
  const std::size_t colon = std::min(all.find(':'), all.size());
  return {number(all.substr(0, colon)), number(all.substr(std::min(colon + 1, all.size())))};
}

/// At rest and as it is, turned and moved to where it stands in the sample.
FinishedTest as_seen(const Specimen<2>& specimen, const SampleVolume& volume, const TestRecord& of_sample,
                     const std::string& name)
{
  Specimen<2> broken = specimen;
  Joints<2>& joints = broken.joints;
  const std::size_t n_grains = specimen.grains.size();
  std::vector<std::uint32_t> n_broken(n_grains, 0);
  for (const auto& unbonded : volume.state.unbonded)
    if (const std::size_t joint = unbonded.segment / joints.n_segments; joint < joints.size())
      {
        joints.bonded[joints.segment(unbonded.segment % joints.n_segments, joint)] = 0.0;
        ++n_broken[joints.grain_1[joint]];
        ++n_broken[joints.grain_2[joint]];
      }
  const auto placed = [&](const Vector<2>& position) -> Vector<2> {
    return volume.position + volume.orientation * (position - 0.5 * specimen.size);
  };
  const Tensor<2> strain = strain_tensor<2>(volume.state.strain);
  const Unknowns unknowns = unknowns_of(*volume.network, volume.state);
  const auto moved = [&](const Vector<2>& rest, const std::size_t grain) -> Vector<2> {
    const Vector<2> fluctuation = unknowns.segment<2>(n_motions<2> * Eigen::Index(grain));
    return rest + strain * (rest - 0.5 * specimen.size) + fluctuation;
  };

  FinishedTest seen;
  seen.name = name;
  seen.record.kind = of_sample.kind;
  const auto fragment = fragments(joints, n_grains);
  for (const bool now : {false, true})
    {
      Snapshot snapshot;
      if (now)
        {
          snapshot.step = of_sample.curve.back().step;
          snapshot.axial_strain = of_sample.curve.back().axial_strain;
          snapshot.axial_stress = of_sample.curve.back().axial_stress;
        }
      for (std::size_t i = 0; i < n_grains; ++i)
        {
          const Vector<2> rest = at<2>(specimen.grains.position, i);
          const Vector<2> position = placed(now ? moved(rest, i) : rest);
          for (std::size_t c = 0; c < 2; ++c)
            snapshot.position[c].push_back(position[Eigen::Index(c)]);
          if (now)
            seen.record.grains_at_end.push_back(
              {in_space<2>(placed(rest)), in_space<2>(position), specimen.grains.radius[i], fragment[i]});
        }
      snapshot.fragment = now ? fragment : std::vector<std::uint32_t>(n_grains, 0);
      snapshot.n_broken_segments = now ? n_broken : std::vector<std::uint32_t>(n_grains, 0);
      seen.record.snapshots.push_back(std::move(snapshot));
    }
  for (Crack crack : of_sample.cracks)
    if (crack.joint == volume.number)
      {
        const std::size_t joint = crack.segment / joints.n_segments;
        const std::size_t i = crack.segment % joints.n_segments;
        const Vector<2> normal = at<2>(joints.normal, joint);
        const Vector<2> along(-normal[1], normal[0]);
        const double arm =
          0.5 * (joints.rest_distance[joint] + joints.opening[joint]) + joints.half_radius_difference[joint];
        crack.centroid = in_space<2>(placed(at<2>(specimen.grains.position, joints.grain_1[joint]) + arm * normal +
                                            joints.half_length[joint] * joints.elements[i].offset[0] * along));
        crack.joint = joint;
        crack.segment = std::uint32_t(i);
        seen.record.cracks.push_back(crack);
      }
  return seen;
}
} // namespace

int extract_volume(const std::filesystem::path& folder, const std::string& cell_and_point, const bool quiet)
{
  const Place place = place_of(cell_and_point);
  const RunRecord record = read_run_record("multiscale", folder);
  Progress progress(true);
  const auto rocks = make_rocks(record.input, record.input_file, folder, progress);
  const auto planned = plan(record.input, rocks);
  std::size_t n_extracted = 0;
  for (const PlannedSample& one : planned)
    {
      if (!std::filesystem::exists(state_file(folder, one)))
        continue;
      const SampleTest test = open(one, record.input, folder);
      const TestRecord of_sample = test.finish(true);
      if (of_sample.curve.empty())
        continue;
      const SampleVolume volume = test.volume_at(place.cell, place.point);
      const auto found = std::find_if(one.rock->realisations.begin(), one.rock->realisations.end(),
                                      [&](const auto& network) { return network.get() == volume.network; });
      const Specimen<2>& specimen = one.rock->specimens[std::size_t(found - one.rock->realisations.begin())];
      std::filesystem::create_directories(folder / "extracted");
      const std::string name = fmt::format("{}_cell_{}_point_{}", one.name, place.cell, place.point);
      const auto file = folder / "extracted" / (name + ".h5");
      write_volume(specimen, volume.state, file);
      write_fields(as_seen(specimen, volume, of_sample, name + "_fields"), folder / "extracted");
      ++n_extracted;
      if (!quiet)
        fmt::print(
          "{}\n  at ({:.2f}, {:.2f}) mm, its axes turned by {:.1f} deg; strain of the sample {:.4g} %; {} broken "
          "segments\n",
          file.string(), volume.position[0] * 1e3, volume.position[1] * 1e3,
          std::atan2(volume.orientation(1, 0), volume.orientation(0, 0)) * 180.0 / std::numbers::pi,
          100.0 * laboratory_sign(one.test.kind) * of_sample.curve.back().axial_strain,
          volume.state.n_tension_breaks + volume.state.n_shear_breaks);
    }
  if (n_extracted == 0)
    throw InputError(fmt::format("--extract {}: no test in {} has a state yet", cell_and_point, folder.string()));
  return 0;
}
} // namespace feldspar
