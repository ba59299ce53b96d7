#include "coupling/sample_test.h"

#include "coupling/sample_body.h"
#include "coupling/state_archive.h"
#include "dem/hdf5_archive.h"
#include "dem/input_error.h"
#include "dem/stop_rule.h"
#include "fem/advance.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
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
    if (test.kind == TestKind::brazilian)
      throw InputError("Tests/List: brazilian: a multiscale sample stands between platens; it makes direct_tension, "
                       "uniaxial_compression and triaxial_compression");
    record.kind = test.kind;
    record.body = TestBody::finite_elements;
    record.strain_rate = record.time_step = std::numeric_limits<double>::quiet_NaN();
    record.confining_pressure = test.confining_pressure;
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

  /// After Archive::reads `fields_written` tells of what lies in the folder of the fields.
  template <typename Archive>
  void transfer(Archive& archive, std::string& fields_written)
  {
    transfer_flag(archive, "seated", seated);
    transfer_flag(archive, "ended", ended);
    archive.value("height_at_seating_m", height_at_seating);
    archive.value("lateral_strain_at_seating", lateral_strain_at_seating);
    archive.value("n_tension", n_tension);
    archive.value("n_shear", n_shear);
    archive.value("steps", record.steps);
    archive.value("wall_time", record.wall_time);
    archive.text("ended_early", record.ended_early);
    transfer_flag(archive, "came_apart", record.came_apart);
    archive.bytes("curve", record.curve);
    archive.bytes("cracks", record.cracks);
    archive.value("peak_deviator", stop_rule.peak.highest);
    transfer_flag(archive, "fallen", stop_rule.peak.fallen);
    archive.value("strain_at_peak", stop_rule.strain_at_peak);
    archive.text("fields_written", fields_written);

    fem::StoredSolid stored;
    if constexpr (!Archive::reads)
      stored = body->stored();
    archive.array("displacement_m", stored.displacement);
    archive.array("internal_force_N", stored.internal_force);
    archive.array("external_force_N", stored.external_force);
    archive.array("strains", stored.strains);
    archive.array("answers_Pa", stored.answers);
    for (const std::string& boundary : body->boundaries())
      archive.value("pressure_" + boundary + "_Pa", stored.pressures[boundary]);
    std::vector<std::uint64_t> sizes;
    std::vector<std::uint8_t> points;
    for (const std::string& bytes : stored.points)
      {
        sizes.push_back(bytes.size());
        points.insert(points.end(), bytes.begin(), bytes.end());
      }
    archive.array("point_sizes", sizes);
    archive.array("points", points);
    if constexpr (Archive::reads)
      {
        std::size_t begin = 0;
        for (const std::uint64_t n : sizes)
          {
            if (n > points.size() - begin)
              throw InputError("points are missing");
            stored.points.emplace_back(points.begin() + std::ptrdiff_t(begin),
                                       points.begin() + std::ptrdiff_t(begin + n));
            begin += n;
          }
        try
          {
            body->restore(stored);
          }
        catch (const std::invalid_argument& error)
          {
            throw InputError(error.what());
          }
      }
  }

  double sign() const { return laboratory_sign(test.kind); }

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

  void load_to(const double strain)
  {
    const double top = height_at_seating + strain * size.height;
    go([=, this](const double fraction) { return body->press(top, fraction); });
  }

  /// In steps that break no more than their share. Where a step cut twice for that, or the smallest, still does, it is an
  /// avalanche, which no step divides. `solve` goes a fraction of the way that is left.
  void go(const std::function<fem::NewtonReport(double)>& solve)
  {
    fem::StepControl steps(1.0, sample.smallest_step_share, 1.0);
    const auto most_events =
      std::max<std::uint64_t>(1, std::uint64_t(sample.most_broken_share * double(standing.n_segments)));
    constexpr unsigned int most_cuts_for_breaks = 2;
    unsigned int n_cuts_for_breaks = 0;
    bool avalanche = false;
    while (!steps.finished())
      {
        body->limit_events(avalanche ? standing.n_segments : most_events);
        const fem::NewtonReport report = solve((steps.next() - steps.done()) / (1.0 - steps.done()));
        if (report.converged)
          {
            body->accept();
            steps.succeeded();
            gather_cracks();
            avalanche = false;
            n_cuts_for_breaks = 0;
            continue;
          }
        body->reject();
        const bool breaks_too_much = !avalanche && report.n_events > most_events;
        const bool was_cut = steps.cut();
        if (!was_cut && !breaks_too_much)
          {
            record.came_apart = avalanche;
            throw fem::StepFailure(report.failure);
          }
        if (breaks_too_much)
          avalanche = !was_cut || ++n_cuts_for_breaks == most_cuts_for_breaks;
      }
  }

  double axial_strain() const { return (body->top_displacement() - height_at_seating) / size.height; }

  /// After each accepted step.
  void gather_cracks()
  {
    ++record.steps;
    for (Crack& crack : body->cracks_of_last_step())
      {
        crack.step = record.steps;
        crack.axial_strain = seated ? axial_strain() : 0.0;
        ++(crack.kind == CrackKind::tension ? n_tension : n_shear);
        record.cracks.push_back(crack);
      }
  }

  CurveSample sample_row()
  {
    const bool is_first = record.curve.empty();
    CurveSample row;
    row.step = record.steps;
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
                       std::vector<std::shared_ptr<const Network<dim>>> realisations, const SpecimenReport& of_volumes,
                       const std::uint64_t seed)
  : parts(std::make_unique<Parts>(test, sample, wanted))
{
  const std::uint64_t segments_a_volume = realisations.front()->n_segments();
  parts->take(make_body_of_grains<dim>(sample, parts->set_up(), equilibrium, std::move(realisations), seed),
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

bool SampleTest::advance(const std::function<void(const SampleStanding&)>& watch)
{
  const auto clock = std::chrono::steady_clock::now();
  parts->watch = watch;
  TestRecord& record = parts->record;
  try
    {
      if (!parts->seated)
        parts->seat();
      const double step =
        parts->test.kind == TestKind::direct_tension ? parts->sample.tension_step : parts->sample.compression_step;
      parts->load_to(parts->sign() * step * double(record.curve.size()));
      record.curve.push_back(parts->sample_row());
      parts->ended = parts->stop_rule.is_met_by(record.curve.back(), parts->test.confining_pressure, parts->wanted);
    }
  catch (const fem::StepFailure& failure)
    {
      if (!parts->seated)
        throw InputError(fmt::format("Tests/Confinements: the sample finds no equilibrium under {:g} MPa: {}",
                                     parts->test.confining_pressure / 1e6, failure.what()));
      parts->ended = true;
      record.ended_early =
        fmt::format("{} beyond an axial strain of {:.4g} %: {}",
                    record.came_apart ? "it came apart in an avalanche of breaks" : "no equilibrium was found",
                    100.0 * std::abs(parts->axial_strain()), failure.what());
    }
  parts->watch = nullptr;
  record.wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
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
  if (!parts->body->has_grains())
    throw InputError("Sample/Material: the points of this sample have no grains");
  const std::size_t n = parts->body->n_points_per_cell();
  if (point >= n || cell >= parts->standing.n_points / n)
    throw InputError(fmt::format("there is no point {} in a cell {}: cells are 0 to {}, their points 0 to {}", point,
                                 cell, parts->standing.n_points / n - 1, n - 1));
  return std::get<SampleVolume<dim>>(parts->body->volume(n * cell + point));
}

std::size_t SampleTest::n_fields_written() const { return parts->fields ? parts->fields->n_written() : 0; }

TestRecord SampleTest::finish(const bool interrupted) const
{
  TestRecord record = parts->record;
  record.interrupted = interrupted;
  const std::uint64_t last = record.curve.empty() ? 0 : record.curve.back().step;
  if (interrupted) // perhaps within a row
    {
      record.steps = last;
      std::erase_if(record.cracks, [=](const Crack& crack) { return crack.step > last; });
    }
  return record;
}

void SampleTest::write_state(const std::filesystem::path& file, const std::string& identity) const
{
  write_hdf5(file, [&](Hdf5Writer& root) {
    std::string of_test = identity;
    root.text("identity", of_test);
    std::string fields_written = parts->fields ? parts->fields->stored() : "";
    parts->transfer(root, fields_written);
  });
}

void SampleTest::read_state(const std::filesystem::path& file, const std::string& identity,
                            const std::filesystem::path& folder, const std::string& name)
{
  read_hdf5(file, "a state of `feldspar multiscale`", [&](Hdf5Reader& root) {
    std::string of_test;
    root.text("identity", of_test);
    if (of_test != identity)
      throw InputError("of another test, input or version of this program");
    std::string fields_written;
    parts->transfer(root, fields_written);
    if (!fields_written.empty())
      parts->fields.emplace(folder, name).restore(fields_written);
  });
}

template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<std::shared_ptr<const Network<2>>>,
                                const SpecimenReport&, std::uint64_t);
template SampleTest::SampleTest(const TestCase&, const SampleParameters&, const TestParameters&,
                                const EquilibriumParameters&, std::vector<std::shared_ptr<const Network<3>>>,
                                const SpecimenReport&, std::uint64_t);
template SampleVolume<2> SampleTest::volume_at<2>(unsigned int, unsigned int) const;
template SampleVolume<3> SampleTest::volume_at<3>(unsigned int, unsigned int) const;
} // namespace feldspar
