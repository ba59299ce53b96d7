#include "app/commands/commands.h"
#include "app/programme/multiscale_run.h"
#include "app/programme/run_board.h"
#include "app/run/file_list.h"
#include "app/run/run_record.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "base/text.h"
#include "coupling/rve/rve_file.h"
#include "results/folder/field_output.h"
#include "runs/rve_view.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
/// An integration point of the mesh.
struct RvePlace
{
  unsigned int cell;
  unsigned int point;
};

RvePlace place_of(const std::string& text)
{
  const auto number = [&](const std::string_view part) {
    const auto value = number_in<unsigned int>(part);
    if (!value)
      throw InputError("--extract {}: must be CELL:POINT, the number of a cell as ParaView shows it and of a "
                       "point in it, both from 0, e.g. 3:0",
                       text);
    return *value;
  };
  const std::string_view all = text;
  const std::size_t colon = std::min(all.find(':'), all.size());
  return {number(all.substr(0, colon)), number(all.substr(std::min(colon + 1, all.size())))};
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
  const Vector<dim> in_mm = position * 1e3;
  return fmt::format("({:.2f})", fmt::join(in_mm.begin(), in_mm.end(), ", "));
}

/// Writes the RVE at a place of one test; what was written, in words.
template <int dim>
std::string extract(const PlannedSample& planned, const SampleTest& test, const TestRecord& of_sample,
                    const RvePlace& place, const std::filesystem::path& folder)
{
  const SampleRve<dim> rve = test.rve_at<dim>(place.cell, place.point);
  const auto& packings = std::get<Packings<dim>>(planned.rock->packings);
  const Specimen<dim>& specimen = packings.specimens[packings.realisation_of(*rve.network)];
  std::filesystem::create_directories(folder);
  const std::string name = fmt::format("{}_cell_{}_point_{}", planned.name, place.cell, place.point);
  const auto file = folder / (name + ".h5");
  write_rve(specimen, rve.network->boundary(), rve.state, file);
  const RveView seen = as_seen(specimen, rve, of_sample);
  write_fields(name + "_fields", of_sample.kind, seen.cracks, {}, seen.appearance, folder);
  return fmt::format("{}\n  at {} mm, its axes turned by {}; strain of the sample {:.4g} %; {} broken segments\n",
                     file.string(), describe_position<dim>(rve.position), describe_turn<dim>(rve.orientation),
                     100.0 * planned.test.kind.sign * of_sample.curve.back().axial_strain,
                     rve.state.n_tension_breaks + rve.state.n_shear_breaks);
}
} // namespace

int extract_rve(const std::filesystem::path& folder, const std::string& cell_and_point, const bool quiet)
{
  const RvePlace place = place_of(cell_and_point);
  const RunRecord record = read_run_record("multiscale", folder, true);
  check_links(folder);
  const FileList list(folder);
  Progress progress(true);
  const auto rocks = make_rocks(record.input, record.input_file, folder, progress);
  const SampleSettings settings = sample_settings(record.input);
  const auto planned = plan(record.input, rocks, settings);
  RunBoard board(progress, "", {});
  std::size_t n_extracted = 0;
  for (const PlannedSample& one : planned)
    {
      if (!std::filesystem::exists(state_folder(folder, one)))
        continue;
      const SampleTest test = open(one, folder, board);
      const TestRecord of_sample = test.finish(false).record; // to its last step, as the RVE is
      if (of_sample.curve.empty())
        continue;
      const std::string text = dimension_of_rves(record.input.sample.geometry) == 2
                                 ? extract<2>(one, test, of_sample, place, folder / "extracted")
                                 : extract<3>(one, test, of_sample, place, folder / "extracted");
      ++n_extracted;
      if (!quiet)
        print_result("{}", text);
    }
  if (n_extracted == 0)
    throw InputError("--extract {}: no test in {} has a state yet", cell_and_point, folder.string());
  return 0;
}
} // namespace feldspar
