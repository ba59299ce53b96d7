#include "app/volume_extract.h"

#include "app/field_output.h"
#include "app/multiscale_run.h"
#include "app/run_record.h"
#include "coupling/volume_file.h"
#include "dem/fragments.h"
#include "dem/input_error.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

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
template <int dim>
FinishedTest as_seen(const Specimen<dim>& specimen, const SampleVolume<dim>& volume, const TestRecord& of_sample,
                     const std::string& name)
{
  Specimen<dim> broken = specimen;
  Joints<dim>& joints = broken.joints;
  const std::size_t n_grains = specimen.grains.size();
  std::vector<std::uint32_t> n_broken(n_grains, 0);
  for (const auto& unbonded : volume.state.unbonded)
    if (const std::size_t joint = unbonded.segment / joints.n_segments; joint < joints.size())
      {
        joints.bonded[joints.segment(unbonded.segment % joints.n_segments, joint)] = 0.0;
        ++n_broken[joints.grain_1[joint]];
        ++n_broken[joints.grain_2[joint]];
      }
  const auto placed = [&](const Vector<dim>& position) -> Vector<dim> {
    return volume.position + volume.orientation * (position - 0.5 * specimen.size);
  };
  const Tensor<dim> strain = strain_tensor<dim>(volume.state.strain);
  const Unknowns unknowns = unknowns_of(*volume.network, volume.state);
  const auto moved = [&](const Vector<dim>& rest, const std::size_t grain) -> Vector<dim> {
    const Vector<dim> fluctuation = unknowns.segment<dim>(n_motions<dim> * Eigen::Index(grain));
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
          const Vector<dim> rest = at<dim>(specimen.grains.position, i);
          const Vector<dim> position = placed(now ? moved(rest, i) : rest);
          for (std::size_t c = 0; c < dim; ++c)
            snapshot.position[c].push_back(position[Eigen::Index(c)]);
          if (now)
            seen.record.grains_at_end.push_back(
              {in_space<dim>(placed(rest)), in_space<dim>(position), specimen.grains.radius[i], fragment[i]});
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
        const Vector<dim> normal = at<dim>(joints.normal, joint);
        const auto& element = joints.elements[i];
        Vector<dim> from_contact;
        if constexpr (dim == 2)
          from_contact = element.offset[0] * Vector<dim>(-normal[1], normal[0]);
        else
          {
            const Vector<dim> tangent = at<dim>(joints.tangent, joint);
            from_contact = element.offset[0] * tangent + element.offset[1] * normal.cross(tangent);
          }
        const double arm =
          0.5 * (joints.rest_distance[joint] + joints.opening[joint]) + joints.half_radius_difference[joint];
        crack.centroid = in_space<dim>(placed(at<dim>(specimen.grains.position, joints.grain_1[joint]) + arm * normal +
                                              joints.half_length[joint] * from_contact));
        crack.joint = joint;
        crack.segment = std::uint32_t(i);
        seen.record.cracks.push_back(crack);
      }
  return seen;
}
/// "turned by 30.0 deg", in space with the axis.
template <int dim>
std::string describe_turn(const Tensor<dim>& turn)
{
  if constexpr (dim == 2)
    return fmt::format("{:.1f} deg", std::atan2(turn(1, 0), turn(0, 0)) * 180.0 / std::numbers::pi);
  else
    {
      const Eigen::AngleAxisd about(turn);
      const Vector<dim>& axis = about.axis();
      return fmt::format("{:.1f} deg about ({:.3f}, {:.3f}, {:.3f})", about.angle() * 180.0 / std::numbers::pi, axis[0],
                         axis[1], axis[2]);
    }
}

template <int dim>
std::string describe_position(const Vector<dim>& position)
{
  std::vector<std::string> components;
  for (const double component : position)
    components.push_back(fmt::format("{:.2f}", component * 1e3));
  return fmt::format("({})", fmt::join(components, ", "));
}

/// Writes the volume at a place of one test; what was written, in words.
template <int dim>
std::string extract(const PlannedSample& planned, const SampleTest& test, const TestRecord& of_sample,
                    const Place& place, const std::filesystem::path& folder)
{
  const SampleVolume<dim> volume = test.volume_at<dim>(place.cell, place.point);
  const auto& packings = std::get<Packings<dim>>(planned.rock->packings);
  const auto found = std::find_if(packings.realisations.begin(), packings.realisations.end(),
                                  [&](const auto& network) { return network.get() == volume.network; });
  const Specimen<dim>& specimen = packings.specimens[std::size_t(found - packings.realisations.begin())];
  std::filesystem::create_directories(folder);
  const std::string name = fmt::format("{}_cell_{}_point_{}", planned.name, place.cell, place.point);
  const auto file = folder / (name + ".h5");
  write_volume(specimen, volume.state, file);
  write_fields(as_seen(specimen, volume, of_sample, name + "_fields"), folder);
  return fmt::format("{}\n  at {} mm, its axes turned by {}; strain of the sample {:.4g} %; {} broken segments\n",
                     file.string(), describe_position<dim>(volume.position), describe_turn<dim>(volume.orientation),
                     100.0 * laboratory_sign(planned.test.kind) * of_sample.curve.back().axial_strain,
                     volume.state.n_tension_breaks + volume.state.n_shear_breaks);
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
      if (!std::filesystem::exists(state_folder(folder, one)))
        continue;
      const SampleTest test = open(one, record.input, folder);
      const TestRecord of_sample = test.finish(false); // to its last step, as the volume is
      if (of_sample.curve.empty())
        continue;
      const std::string text = dimension_of_volumes(record.input.sample.geometry) == 2
                                 ? extract<2>(one, test, of_sample, place, folder / "extracted")
                                 : extract<3>(one, test, of_sample, place, folder / "extracted");
      ++n_extracted;
      if (!quiet)
        fmt::print("{}", text);
    }
  if (n_extracted == 0)
    throw InputError(fmt::format("--extract {}: no test in {} has a state yet", cell_and_point, folder.string()));
  return 0;
}
} // namespace feldspar
