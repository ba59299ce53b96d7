#include "coupling/sample/sample_run.h"

#include "base/hdf5_archive.h"
#include "base/input_error.h"
#include "coupling/rve/state_archive.h"
#include "coupling/sample/checkpoints.h"
#include "coupling/sample/ranks.h"
#include "coupling/sample/sample_body.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/stop_rule.h"
#include "fem/solid/advance.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

namespace feldspar
{
struct SampleTest::Parts
{
  TestCase test;
  SampleParameters sample;
  TestParameters wanted;
  SampleStanding standing;
  std::function<void(const SampleStanding&)> watch;
  std::unique_ptr<SampleBody> body;
  SampleSize size{};
  std::optional<fem::FieldOutput> fields;
  StopRule stop_rule;
  TestRecord record;
  RunBookkeeping bookkeeping;
  std::function<void()> step_done;
  std::optional<fem::StepControl> steps; ///< to the next row, where it is on its way
  bool widens = false;                   ///< lateral strain is what is controlled
  double wanted_width = 0.0;             ///< lateral strain of the row that is on its way
  bool avalanche = false;                ///< the next of these steps may break as much as it likes
  unsigned int n_cuts_for_breaks = 0;    ///< of the step that is tried
  bool seated = false;
  bool ended = false;
  double height_at_seating = 0.0; ///< displacement of the top [m]
  double lateral_strain_at_seating = 0.0;
  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;

  Parts(const TestCase& which, const SampleParameters& of, const TestParameters& parameters)
    : test(which)
    , sample(of)
    , wanted(parameters)
    , stop_rule(test.kind)
  {
    if (const std::string objection = objection_to_finite_elements(test.kind); !objection.empty())
      throw InputError(objection);
    record.kind = test.kind;
    record.body = TestBody::finite_elements;
    record.strain_rate = bookkeeping.time_step = std::numeric_limits<double>::quiet_NaN();
    record.confining_pressure = test.confining_pressure;
    bookkeeping.solver_work.emplace();
  }

  void take(std::unique_ptr<SampleBody> its_body, const std::uint64_t segments_a_volume)
  {
    body = std::move(its_body);
    size = body->size();
    standing.n_points = body->n_points();
    standing.n_segments = standing.n_points * segments_a_volume;
    record.size = body->box();
  }

  SampleSetUp set_up()
  {
    return {test.confining_pressure, [this](const fem::NewtonReport& report) {
              standing.n_newton_iterations = report.n_iterations;
              standing.n_cascades = report.n_cascades;
              if (watch)
                watch(standing);
            }};
  }

  /// What all ranks know besides the solid.
  template <typename Archive>
  void transfer_test(Archive& archive, std::string& fields_written, fem::StoredSolid& solid)
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
    archive.bytes("curve", record.curve);
    archive.value("peak_deviator", stop_rule.peak.highest);
    transfer_flag(archive, "fallen", stop_rule.peak.fallen);
    archive.value("strain_at_peak", stop_rule.strain_at_peak);
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
        steps.reset();
        if (on_its_way)
          {
            steps.emplace(first_steps());
            steps->go_on_from(standing_of_steps);
          }
      }
  }

  double sign() const { return test.kind.sign; }

  /// Pressure all round, the top plate free to follow.
  void seat()
  {
    if (test.confining_pressure > 0.0)
      go([this](const double fraction) { return body->seat(fraction); });
    height_at_seating = body->top_displacement();
    lateral_strain_at_seating = body->lateral_strain();
    seated = true;
    record.curve.push_back(sample_row());
  }

  /// To the next row.
  void load()
  {
    const double step = sign() > 0.0 ? sample.tension_step : sample.compression_step;
    widens = widens || (may_widen() && stress_falls());
    if (!widens)
      {
        const double top = height_at_seating + sign() * step * double(record.curve.size()) * size.height;
        go([=, this](const double fraction) { return body->press(top, fraction); });
      }
    if (widens)
      {
        if (!steps)
          wanted_width = std::max(body->lateral_strain(), width_of_last_row()) + step;
        go([=, this](const double fraction) { return body->widen(wanted_width, fraction); });
      }
  }

  /// From the first avalanche or fall of the stress on.
  bool may_widen() const { return seated && sample.widened_past_peak && sign() < 0.0; }

  bool stress_falls() const
  {
    const auto& curve = record.curve;
    return curve.size() > 1 && std::abs(curve.back().axial_stress) < std::abs(curve[curve.size() - 2].axial_stress);
  }
  double width_of_last_row() const { return lateral_strain_at_seating + record.curve.back().gauge_lateral_strain; }

  fem::StepControl first_steps() const { return {1.0, sample.smallest_step_share, 1.0}; }

  /// In steps that break no more than their share. Where a step cut twice for that, or the smallest, still does, it is an
  /// avalanche, which no step divides. From where it was left, if it was. `solve` goes a fraction of the way that is left.
  void go(const std::function<fem::NewtonReport(double)>& solve)
  {
    if (!steps)
      steps.emplace(first_steps());
    const auto most_events =
      std::max<std::uint64_t>(1, std::uint64_t(sample.most_broken_share * double(standing.n_segments)));
    constexpr unsigned int most_cuts_for_breaks = 2;
    while (!steps->finished())
      {
        body->limit_events(avalanche ? standing.n_segments : most_events);
        const fem::NewtonReport report = solve((steps->next() - steps->done()) / (1.0 - steps->done()));
        ++bookkeeping.solver_work->n_solves;
        bookkeeping.solver_work->n_iterations += report.n_iterations;
        bookkeeping.solver_work->n_cascades += report.n_cascades;
        if (report.converged)
          {
            body->accept();
            steps->succeeded();
            avalanche = false;
            n_cuts_for_breaks = 0;
            gather_cracks();
            share_work();
            step_done();
            continue;
          }
        body->reject();
        const bool breaks_too_much = !avalanche && report.n_events > most_events;
        const bool was_cut = steps->cut();
        if (!was_cut && !breaks_too_much)
          {
            record.came_apart = avalanche;
            throw fem::StepFailure(report.failure);
          }
        if (!breaks_too_much)
          continue;
        avalanche = !was_cut || ++n_cuts_for_breaks == most_cuts_for_breaks;
        if (avalanche && may_widen() && !widens)
          {
            // At a held width there may be none.
            widens = true;
            avalanche = false;
            n_cuts_for_breaks = 0;
            break;
          }
      }
    steps.reset();
  }

  void share_work()
  {
    const fem::Balance balance = body->rebalance();
    bookkeeping.solver_work->seconds_in_points += balance.mean * ranks::number();
    RankBalance& ranks = bookkeeping.ranks;
    ranks.mean += balance.mean;
    ranks.longest += balance.longest;
    ranks.longest_unmoved += balance.longest_unmoved;
    ranks.n_moves += balance.moved;
  }

  double axial_strain() const { return (body->top_displacement() - height_at_seating) / size.height; }

  /// After each accepted step. Those of a point in the order they broke in, points in the order of their numbers.
  void gather_cracks()
  {
    ++bookkeeping.steps;
    std::vector<Crack> broken = body->cracks_of_last_step();
    const double strain = seated ? axial_strain() : 0.0;
    for (Crack& crack : broken)
      {
        crack.step = bookkeeping.steps;
        crack.axial_strain = strain;
      }
    const auto n_of = [&](const CrackKind kind) {
      const auto is = [=](const Crack& crack) { return crack.kind == kind; };
      return ranks::sum(std::uint64_t(std::count_if(broken.begin(), broken.end(), is)));
    };
    n_tension += n_of(CrackKind::tension);
    n_shear += n_of(CrackKind::shear);
    const std::string everywhere =
      ranks::gathered({reinterpret_cast<const char*>(broken.data()), broken.size() * sizeof(Crack)});
    broken.resize(everywhere.size() / sizeof(Crack));
    std::copy(everywhere.begin(), everywhere.end(), reinterpret_cast<char*>(broken.data()));
    std::stable_sort(broken.begin(), broken.end(),
                     [](const Crack& one, const Crack& other) { return one.joint < other.joint; });
    record.cracks.insert(record.cracks.end(), broken.begin(), broken.end());
  }

  CurveSample sample_row()
  {
    const bool is_first = record.curve.empty();
    CurveSample row;
    row.step = bookkeeping.steps;
    row.axial_strain = axial_strain();
    row.axial_stress = is_first ? -test.confining_pressure : body->platen_stress("top");
    row.end_stress_difference = is_first ? 0.0 : body->platen_stress("top") + body->platen_stress("bottom");
    row.lateral_stress = -test.confining_pressure;
    row.mid_stress = body->mean_axial_stress();
    row.gauge_axial_strain = row.axial_strain;
    row.gauge_lateral_strain = body->lateral_strain() - lateral_strain_at_seating;
    row.gauge_volumetric_strain = row.gauge_axial_strain + body->n_lateral_directions() * row.gauge_lateral_strain;
    row.n_tension_cracks = n_tension;
    row.n_shear_cracks = n_shear;
    row.energies = body->energies();
    standing.n_damaged_points = body->n_damaged_points();
    return row;
  }
};

template <int dim>
SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const EquilibriumParameters& equilibrium,
                       std::vector<std::shared_ptr<const Network<dim>>> realisations,
                       std::vector<std::shared_ptr<const Network<dim>>> weak_twins, const SpecimenReport& of_volumes,
                       const std::uint64_t seed)
  : parts(std::make_unique<Parts>(test, sample, wanted))
{
  const std::uint64_t segments_a_volume = realisations.front()->n_segments();
  parts->take(make_body_of_grains<dim>(sample, parts->set_up(), equilibrium, std::move(realisations),
                                       std::move(weak_twins), seed),
              segments_a_volume);
  parts->record.seed = seed;
  parts->record.specimen = of_volumes;
}

SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const ContinuumParameters& continuum)
  : parts(std::make_unique<Parts>(test, sample, wanted))
{
  parts->take(make_continuous_body(sample, parts->set_up(), continuum), 0);
}
SampleTest::~SampleTest() = default;
SampleTest::SampleTest(SampleTest&&) noexcept = default;

bool SampleTest::advance(const std::function<void(const SampleStanding&)>& watch,
                         const std::function<void()>& step_done)
{
  const auto clock = std::chrono::steady_clock::now();
  parts->watch = watch;
  parts->step_done = step_done;
  TestRecord& record = parts->record;
  try
    {
      if (!parts->seated)
        parts->seat();
      parts->load();
      record.curve.push_back(parts->sample_row());
      parts->ended = parts->stop_rule.is_met_by(record.curve.back(), parts->test.confining_pressure, parts->wanted);
    }
  catch (const fem::StepFailure& failure)
    {
      if (!parts->seated)
        throw InputError(fmt::format("Tests/Confinements: the sample finds no equilibrium under {:g} MPa: {}",
                                     parts->test.confining_pressure / 1e6, failure.what()));
      parts->steps.reset();
      parts->ended = true;
      record.ended_early =
        fmt::format("{} beyond an axial strain of {:.4g} %: {}",
                    record.came_apart ? "it came apart in an avalanche of breaks" : "no equilibrium was found",
                    100.0 * std::abs(parts->axial_strain()), failure.what());
    }
  parts->watch = nullptr;
  parts->step_done = nullptr;
  parts->bookkeeping.wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return !parts->ended;
}

bool SampleTest::has_ended() const { return parts->ended; }
const CurveSample& SampleTest::last_row() const { return parts->record.curve.back(); }
SampleStanding SampleTest::standing() const { return parts->standing; }

void SampleTest::write_fields(const std::filesystem::path& folder, const std::string& name)
{
  if (!parts->fields)
    parts->fields.emplace(folder, name);
  parts->body->write_fields(*parts->fields, double(parts->record.curve.size()));
}

template <int dim>
SampleVolume<dim> SampleTest::volume_at(const unsigned int cell, const unsigned int point) const
{
  const std::size_t n = parts->body->n_points_per_cell();
  if (point >= n || cell >= parts->standing.n_points / n)
    throw InputError(fmt::format("there is no point {} in a cell {}: cells are 0 to {}, their points 0 to {}", point,
                                 cell, parts->standing.n_points / n - 1, n - 1));
  return std::get<SampleVolume<dim>>(parts->body->volume(n * cell + point).value());
}

template <int dim>
std::optional<SampleVolume<dim>> SampleTest::volume_here(const std::uint64_t number) const
{
  const auto volume = parts->body->volume(number);
  return volume ? std::optional(std::get<SampleVolume<dim>>(*volume)) : std::nullopt;
}

std::size_t SampleTest::n_points_per_cell() const { return parts->body->n_points_per_cell(); }

std::size_t SampleTest::n_fields_written() const { return parts->fields ? parts->fields->n_written() : 0; }

TestOutcome SampleTest::finish(const bool interrupted) const
{
  TestOutcome outcome{parts->record, {}, parts->bookkeeping};
  TestRecord& record = outcome.record;
  record.interrupted = interrupted;
  const std::uint64_t last = record.curve.empty() ? 0 : record.curve.back().step;
  if (interrupted) // perhaps within a row
    {
      outcome.bookkeeping.steps = last;
      std::erase_if(record.cracks, [=](const Crack& crack) { return crack.step > last; });
    }
  return outcome;
}

namespace
{
/// Rows of equal length, one a cell; and bytes of each point with their numbers.
void write_cells(Hdf5Writer& root, const std::vector<fem::StoredCell>& cells)
{
  std::vector<std::uint64_t> numbers, sizes;
  std::vector<double> displacement, answers;
  std::vector<std::uint8_t> points;
  for (const fem::StoredCell& cell : cells)
    {
      numbers.push_back(cell.number);
      displacement.insert(displacement.end(), cell.displacement.begin(), cell.displacement.end());
      answers.insert(answers.end(), cell.answers.begin(), cell.answers.end());
      for (const std::string& bytes : cell.points)
        {
          sizes.push_back(bytes.size());
          points.insert(points.end(), bytes.begin(), bytes.end());
        }
    }
  root.array("cells", numbers);
  root.array("displacement_m", displacement);
  root.array("answers_Pa", answers);
  root.array("point_sizes", sizes);
  root.array("points", points);
}

std::vector<fem::StoredCell> read_cells(Hdf5Reader& root)
{
  std::vector<std::uint64_t> numbers, sizes;
  std::vector<double> displacement, answers;
  std::vector<std::uint8_t> points;
  root.array("cells", numbers);
  root.array("displacement_m", displacement);
  root.array("answers_Pa", answers);
  root.array("point_sizes", sizes);
  root.array("points", points);
  const std::size_t n = numbers.size();
  if (n == 0)
    return {};
  if (displacement.size() % n != 0 || answers.size() % n != 0 || sizes.size() % n != 0)
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
      cells.push_back({numbers[k], row(displacement, k), row(answers, k), {}});
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
        parts->transfer_test(root, fields_written, solid);
        root.bytes("cracks", parts->record.cracks);
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
        parts->transfer_test(root, fields_written, solid);
        root.bytes("cracks", parts->record.cracks);
      }
    for (auto& cell : read_cells(root))
      solid.cells.push_back(std::move(cell));
  });
  BytesWriter of_first;
  parts->transfer_test(of_first, fields_written, solid);
  const std::string bytes = ranks::of_first(of_first.all);
  BytesReader reader(bytes);
  parts->transfer_test(reader, fields_written, solid);
  try
    {
      parts->body->restore(solid);
      if (!fields_written.empty())
        parts->fields.emplace(folder, name).restore(fields_written);
    }
  catch (const std::exception& error)
    {
      throw InputError(fmt::format("{}: {}", checkpoint.string(), error.what()));
    }
}

template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<std::shared_ptr<const Network<2>>>,
                                std::vector<std::shared_ptr<const Network<2>>>, const SpecimenReport&, std::uint64_t);
template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<std::shared_ptr<const Network<3>>>,
                                std::vector<std::shared_ptr<const Network<3>>>, const SpecimenReport&, std::uint64_t);
template SampleVolume<2> SampleTest::volume_at<2>(unsigned int, unsigned int) const;
template SampleVolume<3> SampleTest::volume_at<3>(unsigned int, unsigned int) const;
template std::optional<SampleVolume<2>> SampleTest::volume_here<2>(std::uint64_t) const;
template std::optional<SampleVolume<3>> SampleTest::volume_here<3>(std::uint64_t) const;
} // namespace feldspar
