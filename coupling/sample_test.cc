#include "coupling/sample_test.h"

#include "coupling/grain_material.h"
#include "coupling/state_archive.h"
#include "dem/hdf5_archive.h"
#include "dem/input_error.h"
#include "dem/stop_rule.h"
#include "fem/advance.h"
#include "fem/linear_elasticity.h"
#include "fem/mohr_coulomb.h"
#include "fem/output.h"
#include "fem/plane_strain.h"
#include "fem/platen_test.h"

#include <deal.II/grid/grid_tools.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

namespace feldspar
{
namespace
{
fem::SampleMesh<2> mesh_of(const SampleParameters& sample)
{
  if (sample.mesh_file.empty())
    return fem::plane_sample(MPI_COMM_WORLD, sample.width, sample.height,
                             {sample.elements_across, sample.elements_along}, 0);
  try
    {
      fem::SampleMesh<2> mesh = fem::read_gmsh<2>(MPI_COMM_WORLD, sample.mesh_file, 0);
      for (const char* const boundary : {"left", "right", "bottom", "top"})
        mesh.boundary(boundary);
      return mesh;
    }
  catch (const fem::MeshError& error)
    {
      throw InputError(fmt::format("Sample/Mesh file = {}: {}", sample.mesh_file, error.what()));
    }
}

SampleSize size_of(const fem::SampleMesh<2>& mesh, const unsigned int order)
{
  const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
  double largest = 0.0;
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    largest = std::max(largest, std::sqrt(cell->measure()) / order);
  return {box.side_length(0), box.side_length(1), largest};
}

fem::Material<2> material_of(const SampleMaterial material, const ContinuumParameters& of)
{
  // Plane strain that shows the modulus and the ratio asked for.
  const auto [E, nu] = fem::plane_strain_equal_to_plate({of.modulus, of.poissons_ratio});
  if (material == SampleMaterial::linear_elasticity)
    return fem::linear_elasticity<2>(fem::isotropic_stiffness<2>(E, nu));
  return fem::plane_strain(fem::mohr_coulomb({E, nu, of.cohesion, of.friction_angle, of.dilation_angle}));
}
} // namespace

SampleSize measure(const SampleParameters& sample) { return size_of(mesh_of(sample), sample.order); }

struct SampleTest::Parts
{
  TestCase test;
  SampleParameters sample;
  TestParameters wanted;
  fem::SampleMesh<2> mesh;
  SampleSize size;
  SampleStanding standing;
  std::function<void(const SampleStanding&)> watch;
  fem::Solid<2> solid;
  std::optional<fem::FieldOutput> fields;
  StopRule stop_rule;
  TestRecord record;
  bool seated = false;
  bool ended = false;
  double height_at_seating = 0.0; ///< displacement of the top [m]
  double width_at_seating = 0.0;  ///< widening [m]
  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;

  Parts(const TestCase& which, const SampleParameters& of, const TestParameters& parameters,
        const fem::Material<2>& material, const std::uint64_t segments_a_volume)
    : test(which)
    , sample(of)
    , wanted(parameters)
    , mesh(mesh_of(sample))
    , size(size_of(mesh, sample.order))
    , solid(mesh, set_up(), material)
    , stop_rule(test.kind)
  {
    if (test.kind == TestKind::brazilian)
      throw InputError("Tests/List: brazilian: a multiscale sample is a rectangle; it makes direct_tension, "
                       "uniaxial_compression and triaxial_compression");
    standing.n_points = solid.material_points().size();
    standing.n_segments = standing.n_points * segments_a_volume;
    record.kind = test.kind;
    record.body = TestBody::finite_elements;
    record.strain_rate = record.time_step = std::numeric_limits<double>::quiet_NaN();
    record.confining_pressure = test.confining_pressure;
    record.size = {size.width, size.height, 0.0};
  }

  fem::SolidParameters set_up()
  {
    fem::SolidParameters parameters;
    parameters.order = sample.order;
    parameters.newton_tolerance = sample.newton_tolerance;
    parameters.watch = [this](const fem::NewtonReport& report) {
      standing.n_newton_iterations = report.n_iterations;
      standing.n_cascades = report.n_cascades;
      if (watch)
        watch(standing);
    };
    return parameters;
  }

  /// After Archive::reads `fields_written` tells of what lies in the folder of the fields.
  template <typename Archive>
  void transfer(Archive& archive, std::string& fields_written)
  {
    transfer_flag(archive, "seated", seated);
    transfer_flag(archive, "ended", ended);
    archive.value("height_at_seating_m", height_at_seating);
    archive.value("width_at_seating_m", width_at_seating);
    archive.value("n_tension", n_tension);
    archive.value("n_shear", n_shear);
    archive.value("steps", record.steps);
    archive.value("wall_time", record.wall_time);
    archive.text("ended_early", record.ended_early);
    archive.bytes("curve", record.curve);
    archive.bytes("cracks", record.cracks);
    archive.value("peak_deviator", stop_rule.peak.highest);
    transfer_flag(archive, "fallen", stop_rule.peak.fallen);
    archive.value("strain_at_peak", stop_rule.strain_at_peak);
    archive.text("fields_written", fields_written);

    fem::StoredSolid stored;
    if constexpr (!Archive::reads)
      stored = solid.stored();
    archive.array("displacement_m", stored.displacement);
    archive.array("internal_force_N", stored.internal_force);
    archive.array("external_force_N", stored.external_force);
    archive.array("strains", stored.strains);
    archive.array("answers_Pa", stored.answers);
    for (const char* const boundary : {"left", "right", "bottom", "top"})
      archive.value(std::string("pressure_") + boundary + "_Pa", stored.pressures[boundary]);
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
            solid.restore(stored);
          }
        catch (const std::invalid_argument& error)
          {
            throw InputError(error.what());
          }
      }
  }

  bool has_grains() const { return sample.material == SampleMaterial::grains; }

  /// Where there are grains.
  const GrainPoint<2>& point(const std::size_t i) const
  {
    return static_cast<const GrainPoint<2>&>(solid.material_points()[i]);
  }

  double sign() const { return laboratory_sign(test.kind); }
  double widening() const { return solid.mean_displacement("right", 0) - solid.mean_displacement("left", 0); }

  /// Pressure all round, the top plate free to follow.
  void seat()
  {
    if (test.confining_pressure > 0.0)
      go(platens().seating());
    height_at_seating = solid.mean_displacement("top", 1);
    width_at_seating = widening();
    seated = true;
    record.curve.push_back(sample_row());
  }

  /// In steps that break no more than their share. Where a step cut twice for that, or the smallest, still does, it is an
  /// avalanche, which no step divides.
  void go(const fem::Load<2>& load)
  {
    fem::StepControl steps(1.0, sample.smallest_step_share, 1.0);
    const auto most_events =
      std::max<std::uint64_t>(1, std::uint64_t(sample.most_broken_share * double(standing.n_segments)));
    constexpr unsigned int most_cuts_for_breaks = 2;
    unsigned int n_cuts_for_breaks = 0;
    bool avalanche = false;
    while (!steps.finished())
      {
        solid.limit_events(avalanche ? standing.n_segments : most_events);
        const fem::NewtonReport report = solid.solve(load, (steps.next() - steps.done()) / (1.0 - steps.done()));
        if (report.converged)
          {
            solid.accept();
            steps.succeeded();
            gather_cracks();
            avalanche = false;
            n_cuts_for_breaks = 0;
            continue;
          }
        solid.reject();
        const bool breaks_too_much = !avalanche && report.n_events > most_events;
        const bool was_cut = steps.cut();
        if (!was_cut && !breaks_too_much)
          throw fem::StepFailure(report.failure);
        if (breaks_too_much)
          avalanche = !was_cut || ++n_cuts_for_breaks == most_cuts_for_breaks;
      }
  }

  void load_to(const double strain) { go(platens().pressing(height_at_seating + strain * size.height)); }

  fem::PlatenTest<2> platens() const
  {
    fem::PlatenTest<2> set_up;
    set_up.platens = sample.rough_platens ? fem::Platens::rough : fem::Platens::smooth;
    set_up.confining_pressure = test.confining_pressure;
    return set_up;
  }

  double axial_strain() const { return (solid.mean_displacement("top", 1) - height_at_seating) / size.height; }

  /// After each accepted step.
  void gather_cracks()
  {
    ++record.steps;
    if (!has_grains())
      return;
    for (std::size_t i = 0; i < standing.n_points; ++i)
      for (const PointCrack<2>& broken : point(i).cracks_of_last_step())
        {
          const auto& place = solid.places()[i].position;
          record.cracks.push_back({broken.kind,
                                   i,
                                   broken.segment,
                                   record.steps,
                                   seated ? axial_strain() : 0.0,
                                   {place[0], place[1], 0.0},
                                   {broken.normal[0], broken.normal[1], 0.0},
                                   broken.size,
                                   broken.released_energy});
          ++(broken.kind == CrackKind::tension ? n_tension : n_shear);
        }
  }

  CurveSample sample_row()
  {
    CurveSample row;
    row.step = record.steps;
    row.axial_strain = axial_strain();
    row.axial_stress = record.curve.empty() ? -test.confining_pressure : solid.reaction("top", 1) / size.width;
    row.end_stress_difference =
      record.curve.empty() ? 0.0 : (solid.reaction("top", 1) + solid.reaction("bottom", 1)) / size.width;
    row.lateral_stress = -test.confining_pressure;
    row.mid_stress = solid.mean_stress()[1];
    row.gauge_axial_strain = row.axial_strain;
    row.gauge_lateral_strain = (widening() - width_at_seating) / size.width;
    row.gauge_volumetric_strain = row.gauge_axial_strain + row.gauge_lateral_strain;
    row.n_tension_cracks = n_tension;
    row.n_shear_cracks = n_shear;
    standing.n_damaged_points = 0;
    if (!has_grains())
      {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        row.energies = {unknown, unknown, unknown, unknown, unknown, unknown, unknown};
        return row;
      }
    for (std::size_t i = 0; i < standing.n_points; ++i)
      {
        const double volume = solid.volumes()[i];
        const NetworkWork work = point(i).work_density();
        row.energies.boundary_work += volume * work.boundary;
        row.energies.strain += volume * point(i).stored_energy_density();
        row.energies.slip += volume * work.slip;
        row.energies.released += volume * work.released;
        row.energies.damping += volume * work.settled;
        standing.n_damaged_points += !point(i).volume().state().intact;
      }
    return row;
  }
};

SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const EquilibriumParameters& equilibrium,
                       std::vector<std::shared_ptr<const Network<2>>> realisations, const SpecimenReport& of_volumes,
                       const std::uint64_t seed)
{
  const std::uint64_t segments_a_volume = realisations.front()->n_segments();
  GrainMaterialParameters material;
  material.seed = seed;
  material.random_orientation = sample.random_orientation;
  material.equilibrium = equilibrium;
  parts = std::make_unique<Parts>(test, sample, wanted, grain_material<2>(std::move(realisations), material),
                                  segments_a_volume);
  parts->record.seed = seed;
  parts->record.specimen = of_volumes;
}

SampleTest::SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
                       const ContinuumParameters& continuum)
  : parts(std::make_unique<Parts>(test, sample, wanted, material_of(sample.material, continuum), 0))
{
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
      record.ended_early = fmt::format("no equilibrium was found beyond an axial strain of {:.4g} %: {}",
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
  parts->fields->write(parts->solid, double(parts->record.curve.size()));
}

SampleVolume SampleTest::volume_at(const unsigned int cell, const unsigned int point) const
{
  if (!parts->has_grains())
    throw InputError("Sample/Material: the points of this sample have no grains");
  const std::size_t n = parts->solid.n_points_per_cell();
  if (point >= n || cell >= parts->standing.n_points / n)
    throw InputError(fmt::format("there is no point {} in a cell {}: cells are 0 to {}, their points 0 to {}", point,
                                 cell, parts->standing.n_points / n - 1, n - 1));
  const std::size_t number = n * cell + point;
  const GrainPoint<2>& at = parts->point(number);
  const auto& position = parts->solid.places()[number].position;
  return {number, Vector<2>(position[0], position[1]), at.orientation(), &at.volume().network(), at.volume().state()};
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
} // namespace feldspar
