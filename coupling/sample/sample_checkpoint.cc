// A multiscale test as a checkpoint, and back.

#include "base/byte_archive.h"
#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "base/system/hdf5_archive.h"
#include "coupling/sample/checkpoints.h"
#include "coupling/sample/running_sample.h"

#include <type_traits>
#include <utility>

namespace feldspar
{
template <typename Archive>
void SampleTest::Parts::transfer(Archive& archive, std::string& fields_written, fem::StoredSolid& solid)
{
  transfer_flag(archive, "seated", seated);
  transfer_flag(archive, "ended", ended);
  archive.value("height_at_seating_m", height_at_seating);
  archive.value("lateral_strain_at_seating", lateral_strain_at_seating);
  archive.value("n_tension", n_tension);
  archive.value("n_shear", n_shear);
  archive.value("steps", bookkeeping.steps);
  archive.value("wall_time", bookkeeping.wall_time);
  archive.value("n_solves", bookkeeping.solver_work->n_solves);
  archive.value("n_iterations", bookkeeping.solver_work->n_iterations);
  archive.value("n_cascades", bookkeeping.solver_work->n_cascades);
  archive.value("seconds_in_points", bookkeeping.solver_work->seconds_in_points);
  archive.text("ended_early", record.ended_early);
  transfer_flag(archive, "came_apart", record.came_apart);
  archive.array("curve", record.curve);
  archive.array("solver_steps", bookkeeping.solver_work->steps);
  archive.value("n_cuts_of_step", step_on_its_way.n_cuts);
  archive.text("fields_written", fields_written);
  for (const std::string& boundary : body->boundaries())
    archive.value("pressure_" + boundary + "_Pa", solid.pressures[boundary]);
  archive.value("reaction_work_J", solid.work.reactions);
  archive.value("pressure_work_J", solid.work.pressures);
  archive.value("redistribution_energy_J", solid.work.redistribution);

  bool on_its_way = steps.has_value();
  transfer_flag(archive, "row_on_its_way", on_its_way);
  transfer_flag(archive, "widens", widens);
  archive.value("wanted_lateral_strain", wanted_width);
  if (stage_walk)
    {
      stage_walk->transfer(archive);
      auto lead = std::uint32_t(stage_row.lead);
      archive.value("stage_row_lead", lead);
      stage_row.lead = StageRow::Lead(lead);
      archive.value("stage_row_target", stage_row.target);
      archive.value("stage_row_confining_pressure_Pa", stage_row.confining_pressure);
      archive.value("stage_row_time_s", stage_row.time);
      record.stages = stage_walk->records();
    }
  transfer_flag(archive, "avalanche", avalanche);
  archive.value("n_cuts_for_breaks", n_cuts_for_breaks);
  archive.value("rank_mean_s", bookkeeping.ranks.mean);
  archive.value("rank_longest_s", bookkeeping.ranks.longest);
  archive.value("rank_longest_unmoved_s", bookkeeping.ranks.longest_unmoved);
  archive.value("n_moves", bookkeeping.ranks.n_moves);
  fem::StepControl::Standing standing_of_steps;
  if (steps)
    standing_of_steps = steps->standing();
  archive.value("steps_done", standing_of_steps.done);
  archive.value("steps_size", standing_of_steps.size);
  archive.value("steps_in_a_row", standing_of_steps.n_in_a_row);
  if constexpr (Archive::reads)
    {
      stop_rule = StopRule(test.kind, test.confining_pressure, record.peak_demands);
      for (const CurveSample& row : record.curve)
        stop_rule.add(row);
      steps.reset();
      if (on_its_way)
        {
          steps.emplace(first_steps());
          steps->go_on_from(standing_of_steps);
        }
    }
}

namespace
{
/// Rows of equal length, one a cell; and bytes of each point with their numbers.
void write_cells(Hdf5Writer& root, const std::vector<fem::StoredCell>& cells)
{
  std::vector<std::uint64_t> numbers, sizes;
  std::vector<double> displacement, responses;
  std::vector<std::uint8_t> points;
  for (const fem::StoredCell& cell : cells)
    {
      numbers.push_back(cell.number);
      displacement.insert(displacement.end(), cell.displacement.begin(), cell.displacement.end());
      responses.insert(responses.end(), cell.responses.begin(), cell.responses.end());
      for (const std::string& bytes : cell.points)
        {
          sizes.push_back(bytes.size());
          points.insert(points.end(), bytes.begin(), bytes.end());
        }
    }
  root.array("cells", numbers);
  root.array("displacement_m", displacement);
  root.array("responses_Pa", responses);
  root.array("point_sizes", sizes);
  root.array("points", points);
}

std::vector<fem::StoredCell> read_cells(Hdf5Reader& root)
{
  std::vector<std::uint64_t> numbers, sizes;
  std::vector<double> displacement, responses;
  std::vector<std::uint8_t> points;
  root.array("cells", numbers);
  root.array("displacement_m", displacement);
  root.array("responses_Pa", responses);
  root.array("point_sizes", sizes);
  root.array("points", points);
  const std::size_t n = numbers.size();
  if (n == 0)
    return {};
  if (displacement.size() % n != 0 || responses.size() % n != 0 || sizes.size() % n != 0)
    throw InputError("arrays of cells differ in length");
  const auto row = [=](const auto& values, const std::size_t k) {
    const auto length = std::ptrdiff_t(values.size() / n);
    return std::decay_t<decltype(values)>(values.begin() + std::ptrdiff_t(k) * length,
                                          values.begin() + std::ptrdiff_t(k + 1) * length);
  };
  std::vector<fem::StoredCell> cells;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < n; ++k)
    {
      cells.push_back({numbers[k], row(displacement, k), row(responses, k), {}});
      for (const std::uint64_t size : row(sizes, k))
        {
          if (size > points.size() - begin)
            throw InputError("points are missing");
          cells.back().points.emplace_back(points.begin() + std::ptrdiff_t(begin),
                                           points.begin() + std::ptrdiff_t(begin + size));
          begin += size;
        }
    }
  return cells;
}
} // namespace

void SampleTest::write_state(const std::filesystem::path& folder, const std::string& identity) const
{
  fem::StoredSolid solid = parts->body->stored();
  write_checkpoint(folder, parts->bookkeeping.steps, identity, [&](Hdf5Writer& root) {
    if (ranks::is_first())
      {
        std::string fields_written = parts->fields ? parts->fields->stored() : "";
        parts->transfer(root, fields_written, solid);
        root.array("cracks", parts->record.cracks);
        root.array("events", parts->record.events);
      }
    write_cells(root, solid.cells);
  });
}

void SampleTest::read_state(const std::filesystem::path& checkpoint, const std::string& identity,
                            const std::filesystem::path& folder, const std::string& name)
{
  fem::StoredSolid solid;
  std::string fields_written;
  read_checkpoint(checkpoint, identity, [&](Hdf5Reader& root, const std::uint64_t part) {
    if (part == 0)
      {
        parts->transfer(root, fields_written, solid);
        root.array("cracks", parts->record.cracks);
        root.array("events", parts->record.events);
      }
    for (auto& cell : read_cells(root))
      solid.cells.push_back(std::move(cell));
  });
  BytesWriter of_first;
  parts->transfer(of_first, fields_written, solid);
  const std::string bytes = ranks::of_first(of_first.all);
  BytesReader reader(bytes);
  parts->transfer(reader, fields_written, solid);
  try
    {
      parts->body->restore(solid);
      if (!fields_written.empty())
        parts->fields.emplace(folder, name).restore(fields_written);
    }
  catch (const std::exception& error)
    {
      throw InputError("{}: {}", checkpoint.string(), error.what());
    }
}
} // namespace feldspar
