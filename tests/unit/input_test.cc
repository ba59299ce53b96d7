#include "app/input/input.h"

#include "app/input/given_entries.h"
#include "app/input/input_entries.h"
#include "app/input/parameter_table.h"
#include "app/input/variant_names.h"
#include "base/input_error.h"
#include "dem/lab/emission_entries.h"
#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"
#include "laboratory/compression.h"
#include "laboratory/loading_stages.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
const FlatJointParameters& flat_joint(const Input& input) { return std::get<FlatJointParameters>(input.joints); }
const ParallelBondParameters& parallel_bond(const Input& input)
{
  return std::get<ParallelBondParameters>(input.joints);
}

/// Compares with the values that inputs of this file give to the joints of any law.
template <typename Parameters>
void expect_bonds_as_set(const Parameters& joint)
{
  EXPECT_EQ(joint.modulus, 70e9);
  EXPECT_EQ(joint.stiffness_ratio, 1.5);
  EXPECT_EQ(joint.radius_multiplier, 0.9);
  EXPECT_EQ(joint.bond_tensile_strength, 20e6);
  EXPECT_EQ(joint.bond_tensile_strength_deviation, 2e6);
  EXPECT_EQ(joint.bond_cohesion, 300e6);
  EXPECT_EQ(joint.bond_cohesion_deviation, 30e6);
  EXPECT_EQ(joint.strength_distribution, StrengthDistribution::weibull);
  EXPECT_EQ(joint.coordination_number, std::nullopt);
  EXPECT_EQ(joint.gapped_fraction, 0.1);
  EXPECT_EQ(joint.slit_fraction, 0.2);
  EXPECT_DOUBLE_EQ(joint.bond_friction_angle, std::numbers::pi / 12.0);
  EXPECT_DOUBLE_EQ(joint.initial_gap, 1e-6);
}

using tests::has;
using tests::refusal;
using tests::TemporaryFolder;

/// Every entry that goes with flat joints, each away from its default where it has a choice.
constexpr std::string_view everything = R"(# all of it
subsection Specimen
  set Dimension = 2
  set Shape = box
  set Width = 5.4 cm
  set Height = 108 mm
  set Minimum radius = 0.3 mm      # a comment
  set Radius ratio = 2
  set Size distribution = log-normal
  set Sieve curve = none           # excludes the radii above
  set Porosity = 0.15
  set Density = 2.65 g/cm^3
  set Packing stress ratio = 4e-4
  set Packing relaxation = dynamics
  set Coring = none                # the other needs grains of its own, below
  set Cells across = 1
  set Cells along = 1
  set Packing file = grains.txt
  set Packing unit = 1 mm
  set Packing shift = 27, 54 mm
  set Specimen file = none
  set Joint law = flat joint
end
SUBSECTION Flat joint
  SET Segments = 3
  set Rings = 3
  set Sectors = 12
  set Modulus = 70 GPa
  set Stiffness ratio = 1.5
  set Friction = 0.6
  set Radius multiplier = 0.9
  set Bond tensile strength = 20 MPa
  set Bond tensile \
      strength standard deviation = 2 MPa
  set Bond cohesion = 300 MPa
  set Bond cohesion standard deviation = 30 MPa
  set Bond friction angle = 15 deg
  set Strength distribution = Weibull
  set Strength draw = per contact
  set Installation gap ratio = 0.05
  set Coordination number = none
  set Gapped fraction = 0.1
  set Slit fraction = 0.2
  set Initial gap = 1 um
END
subsection Particle contact
  set Modulus = 60 GPa
  set Stiffness ratio = 2.5
  set Friction = 0.4
end
subsection Smooth joint
  set Normal stiffness = 30 GPa/mm
  set Shear stiffness = 10 GPa/mm
  set Friction = 0.7
  set Dilation angle = 5 deg
  set Tensile strength = 8 MPa
  set Cohesion = 90 MPa
  set Friction angle = 40 deg
end
subsection Mineral grains
  set Mean size = 6 mm
end
subsection Flaws
  set Shapes = hole centre 20, 50 mm radius 5 mm | joint set angle 30 deg spacing 10 mm
  set Traces file = traces.csv
  set Traces origin = 1, 2 mm
  set Traces angle = 10 deg
  set Traces scale = 0.5
  set Smooth layers = none
end
subsection Dynamics
  set Damping = 0
  set Time step safety = 0.5
end
subsection Emission
  set Event radius = 0.7
  set Event duration = 3
  set Thickness = 30 mm
end
subsection Tests
  set List = uniaxial_compression
  set Confinements = 2, 4 MPa
  set Compression strain rate = 0.5 1/s
  set Tension strain rate = 0.082 1/s
  set Brazilian strain rate = 0.3 1/s
  set Brazilian sampling strain = 3e-6
  set Bending strain rate = 0.2 1/s
  set Bending sampling strain = 4e-6
  set Notch ratio = 0.5
  set Loading table = stages.csv
  set Snapshots = 20
  set Shear strain rate = 0.3 1/s
  set Shear sampling strain = 3e-5
  set Shear normal stiffness = 4 GPa/mm
  set Tilt rate = 50 1/s
  set Tilt sampling = 1e-3
  set Gravity = 0.5, -9.81 m/s^2
  set Machine stiffness = 300 kN/mm
  set Compression loading rate = 0.6 mm/min
  set Platen friction = 0.1
  set Seating transits = 12
  set Steps between checkpoints = 500
  set Shared body = always
  set Compression sampling strain = 2e-5
  set Tension sampling strain = 2e-6
  set Lateral boundary = membrane
  set Intermediate stress = 15 MPa
  set Brazilian length ratio = 0.4
  set Grip ratio = 0.2
  set Stop strain over peak strain = 1.5
  set Stop strain = 0.004
  set Stop stress over peak = 0.5
  set Least peak stress = 3 MPa
  set Least transits to peak = 2
  set Least fall after peak = 0.04
end
subsection Variants
  set Entry = Flat joint/Segments
  set Values = 2; 4
  set Combine = in step
  set Table = none
end
subsection Seeds
  set Seeds = 7, 1..3
end
subsection Contact
  set Radius 1 = 2 mm
  set Radius 2 = 3 mm
end
subsection Contact path
  set File = path.csv
end
subsection Strain path
  set File = path.csv
  set Direction = free, -1, 0.5
  set Size = 2e-3
  set Confining pressure = 20 MPa
  set Largest step = 3e-6
  set Solver = explicit
  set Steps per millistrain = 3000
  set Cell angle = 30 deg
end
subsection Representative volume
  set Event tolerance = 1e-4
  set Final tolerance = 1e-8
  set Break rule = only worst
  set Softening steps = 12
  set Kinematics = finite
  set Most iterations = 50
  set Boundary = weakly periodic
  set Traction pieces = 7
  set Free axis = z
end
subsection Sample
  set Material = Mohr-Coulomb
  set Mesh file = sample.msh
  set Mesh unit = mm
  set Mesh names = top = roof; bottom = base 1, base 2
  set Width = 40 mm
  set Height = 80 mm
  set Geometry = cylinder
  set Quadrature = reduced
  set Elements across = 3
  set Elements along = 6
  set Order = 2
  set Platens = rough
  set Control past the peak = lateral strain
  set Softening = as it is
  set Realisations = 5
  set Orientation = fixed
  set Dealing = to elements
  set Draw = in turn
  set Weak seed = element
  set Weak seed strength = 0.8
  set Compression step = 3e-5
  set Tension step = 1e-6
  set Most broken share = 0.02
  set Smallest step share = 0.25
  set Newton tolerance = 1e-7
end
subsection Continuum
  set Modulus = 50 GPa
  set Poisson ratio = 0.25
  set Cohesion = 20 MPa
  set Friction angle = 45 deg
  set Dilation angle = 30 deg
end
subsection Calibration
  set Targets = tensile_strength, youngs_modulus
  set Stiffness ratio = 1.5, 3
  set Cohesion ratio = fixed
  set Bond friction angle = 5, 30 deg
  set Friction = 0.3, 0.9
  set Installation gap ratio = 0.02, 0.1
  set Youngs modulus = secant
  set Poissons ratio = initial
  set Tolerance = 0.04
  set Design points = 30
  set Design packings = 3
  set Step packings = 5
  set Most steps = 6
  set Most packings = 7
  set Samples = 800
end
subsection Report
  set Reference file = rock.json
  set Reference results = summary.json
  set Title = Tunnel <7>, "north"
  set Client = Nagra & Co
  set Specimen = BS06-3
  set Author = Ümit
  set Date = 29 November
end
)";

/// The input `everything`, beside the files that it names.
std::filesystem::path write_everything(const TemporaryFolder& folder)
{
  for (const char* const empty : {"grains.txt", "path.csv", "sample.msh"})
    folder.write(empty, "");
  for (const char* const empty : {"rock.json", "summary.json"})
    folder.write(empty, "{}");
  folder.write("stages.csv", "axial_strain\n0.01\n");
  folder.write("traces.csv", "from_x_m,from_y_m,to_x_m,to_y_m\n0.01,0.02,0.03,0.04\n");
  return folder.write("everything.prm", everything);
}

/// The message on an input beside what is in the folder, without the folder; empty where it is read.
std::string error_in(const TemporaryFolder& folder, const std::string_view name, const std::string_view text)
{
  const std::string what = refusal([&] { read_input(folder.write(name, text)); });
  return what.empty() ? "" : what.substr(folder.path().string().size() + 1);
}

std::string error_of(const std::string_view name, const std::string_view text)
{
  return error_in(TemporaryFolder(), name, text);
}

std::string error_of_entry(const std::string_view section, const std::string_view setting)
{
  return error_of("a.prm", fmt::format("subsection {}\n  set {}\nend\n", section, setting));
}

// A run keeps the folder of its input, which may have been renamed when it is resumed.
TEST(Input, FindsAFileAboveAFolderThatIsGone)
{
  const TemporaryFolder folder;
  const auto rock = folder.write("rock.json", "{}");
  const auto prm = folder.write("a.prm", "subsection Report\n  set Reference file = ../rock.json\nend\n");
  EXPECT_EQ(read_input(prm, folder.path() / "gone").reference_file, rock.string());
}

// Texts for the head of a report are any line of UTF-8; a control character would end a line of a file or of the screen.
TEST(Input, TextsOfAReportAreALineEach)
{
  EXPECT_EQ(error_of("a.json", R"({"Report": {"Title": "Caf\u00e9 <b>"}})"), "");
  const std::string of_bell = error_of("a.json", R"({"Report": {"Title": "a\u0007b"}})");
  EXPECT_TRUE(has(of_bell, "Report/Title", "\"a\\x07b\" is no line of UTF-8 text without control characters"));
  const std::string of_lines = error_of("a.json", R"({"Report": {"Client": "a\nb"}})");
  EXPECT_TRUE(has(of_lines, "Report/Client"));
  EXPECT_FALSE(has(of_lines, "\n"));
  const std::string too_long = error_of_entry("Report", "Author = " + std::string(201, 'a'));
  EXPECT_TRUE(has(too_long, "is too long: 201 bytes, at most 200 are allowed"));
}

TEST(Input, AnEmptyFileMeansTheDefaults)
{
  const TemporaryFolder folder;
  const Input input = read_input(folder.write("empty.prm", "# nothing\n"));
  for (const Parameter& parameter : parameter_table())
    EXPECT_EQ(parameter.write(input), parameter.default_text()) << parameter.name();
  EXPECT_EQ(flat_joint(input).coordination_number, std::nullopt);
  EXPECT_EQ(flat_joint(input).installation_gap_ratio, 0.05);
}

TEST(Input, ADefaultWrittenOutIsTheDefault)
{
  for (const Parameter& parameter : parameter_table())
    {
      Input input;
      parameter.read(input, parameter.default_text());
      EXPECT_EQ(parameter.write(input), parameter.default_text()) << parameter.name();
    }
}

TEST(Input, EveryEntryReachesItsMember)
{
  const TemporaryFolder folder;
  const Input input = read_input(write_everything(folder));
  // Other joint laws exclude flat joints, clumps and minerals exclude mineral grains, and Sample/Rocks a weak seed; they have tests
  // of their own, with the boundary strength that a calibration seeks.
  EXPECT_EQ(scan_prm("everything.prm", std::string(everything)).size() + entry_names("Parallel bond").size() +
              entry_names("Softening flat joint").size() + entry_names("Clumps").size() +
              entry_names("Minerals").size() + 2,
            parameter_table().size());

  EXPECT_EQ(input.calibration.targets, (std::vector<std::string>{"tensile_strength", "youngs_modulus"}));
  EXPECT_EQ(input.calibration.stiffness_ratio->lower, 1.5);
  EXPECT_EQ(input.calibration.stiffness_ratio->upper, 3.0);
  EXPECT_FALSE(input.calibration.cohesion_ratio);
  EXPECT_DOUBLE_EQ(input.calibration.bond_friction_angle->upper, std::numbers::pi / 6.0);
  EXPECT_EQ(input.calibration.friction->lower, 0.3);
  EXPECT_EQ(input.calibration.installation_gap_ratio->upper, 0.1);
  EXPECT_EQ(input.calibration.youngs_modulus, ElasticFigure::secant);
  EXPECT_EQ(input.calibration.poissons_ratio, ElasticFigure::initial);
  EXPECT_EQ(input.calibration.tolerance, 0.04);
  EXPECT_EQ(input.calibration.n_points, 30u);
  EXPECT_EQ(input.calibration.n_packings, 3u);
  EXPECT_EQ(input.calibration.n_step_packings, 5u);
  EXPECT_EQ(input.calibration.most_steps, 6u);
  EXPECT_EQ(input.calibration.most_packings, 7u);
  EXPECT_EQ(input.calibration.n_samples, 800u);
  EXPECT_EQ(input.specimen.dimension, 2u);
  EXPECT_EQ(input.specimen.shape, BodyShape::box);
  EXPECT_DOUBLE_EQ(input.specimen.width, 0.054);
  EXPECT_DOUBLE_EQ(input.specimen.height, 0.108);
  EXPECT_DOUBLE_EQ(input.specimen.minimum_radius, 3e-4);
  EXPECT_EQ(input.specimen.radius_ratio, 2.0);
  EXPECT_EQ(input.specimen.size_distribution, SizeDistribution::log_normal);
  EXPECT_EQ(input.specimen.porosity, 0.15);
  EXPECT_DOUBLE_EQ(input.specimen.bulk_density, 2650.0);
  EXPECT_EQ(input.specimen.packing_stress_ratio, 4e-4);
  EXPECT_EQ(input.specimen.packing_file, (folder.path() / "grains.txt").string());
  EXPECT_DOUBLE_EQ(input.specimen.packing_unit, 1e-3);
  EXPECT_EQ(input.specimen.packing_shift.size(), 2u);
  EXPECT_DOUBLE_EQ(input.specimen.packing_shift.back(), 0.054);
  EXPECT_EQ(input.specimen.specimen_file, "");

  EXPECT_EQ(flat_joint(input).n_segments, 3u);
  EXPECT_EQ(flat_joint(input).n_rings, 3u);
  EXPECT_EQ(flat_joint(input).n_sectors, 12u);
  EXPECT_EQ(flat_joint(input).friction, 0.6);
  EXPECT_EQ(flat_joint(input).strength_draw, StrengthDraw::per_contact);
  EXPECT_EQ(flat_joint(input).installation_gap_ratio, 0.05);
  expect_bonds_as_set(flat_joint(input));

  EXPECT_EQ(input.particle_contact.modulus, 60e9);
  EXPECT_EQ(input.particle_contact.stiffness_ratio, 2.5);
  EXPECT_EQ(input.particle_contact.friction, 0.4);
  EXPECT_EQ(input.dynamics.damping, 0.0);
  EXPECT_EQ(input.dynamics.time_step_safety, 0.5);

  EXPECT_DOUBLE_EQ(input.smooth_joint.normal_stiffness, 30e12);
  EXPECT_DOUBLE_EQ(input.smooth_joint.shear_stiffness, 10e12);
  EXPECT_EQ(input.smooth_joint.friction, 0.7);
  EXPECT_DOUBLE_EQ(input.smooth_joint.dilation_angle, 5.0 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(input.smooth_joint.tensile_strength, 8e6);
  EXPECT_DOUBLE_EQ(input.smooth_joint.cohesion, 90e6);
  EXPECT_DOUBLE_EQ(input.smooth_joint.friction_angle.value(), 40.0 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(input.mineral_grains.mean_size.value(), 0.006);
  ASSERT_EQ(input.flaws.shapes.size(), 2u);
  const auto& hole = std::get<EllipseHole>(input.flaws.shapes[0]);
  EXPECT_EQ(hole.centre, Vector<2>(0.020, 0.050));
  EXPECT_EQ(hole.semi_axes, Vector<2>(0.005, 0.005));
  const auto& set = std::get<JointSet>(input.flaws.shapes[1]);
  EXPECT_DOUBLE_EQ(set.angle, std::numbers::pi / 6.0);
  EXPECT_DOUBLE_EQ(set.spacing, 0.010);
  EXPECT_EQ(input.flaws.traces_file, (folder.path() / "traces.csv").string());
  ASSERT_EQ(input.flaws.traces.size(), 1u);
  EXPECT_EQ(std::get<ClosedFlaw>(input.flaws.traces[0]).points[1], Vector<2>(0.03, 0.04));
  EXPECT_EQ(input.flaws.map.origin, Vector<2>(0.001, 0.002));
  EXPECT_DOUBLE_EQ(input.flaws.map.angle, std::numbers::pi / 18.0);
  EXPECT_EQ(input.flaws.map.scale, 0.5);

  EXPECT_EQ(input.tests.of<BendingParameters>().strain_rate, 0.2);
  EXPECT_EQ(input.tests.of<BendingParameters>().sampling_strain, 4e-6);
  EXPECT_EQ(input.tests.of<NotchParameters>().ratio, 0.5);
  EXPECT_TRUE(input.tests.of<LoadingTable>().file.ends_with("stages.csv"));
  EXPECT_EQ(input.tests.n_snapshots, 20u);
  EXPECT_EQ(input.tests.of<ShearParameters>().strain_rate, 0.3);
  EXPECT_DOUBLE_EQ(input.tests.of<ShearParameters>().normal_stiffness.value(), 4e12);
  EXPECT_EQ(input.tests.of<ShearParameters>().sampling_strain, 3e-5);
  EXPECT_EQ(input.tests.of<TiltParameters>().strain_rate, 50.0);
  EXPECT_EQ(input.tests.of<TiltParameters>().sampling_strain, 1e-3);
  EXPECT_EQ(input.tests.of<EmissionParameters>().event_radius, 0.7);
  EXPECT_EQ(input.tests.of<EmissionParameters>().event_duration, 3.0);
  EXPECT_DOUBLE_EQ(input.tests.of<EmissionParameters>().thickness.value(), 0.03);
  EXPECT_EQ(input.tests.gravity, (std::vector{0.5, -9.81}));
  EXPECT_DOUBLE_EQ(input.tests.of<CompressionParameters>().machine_stiffness.value(), 3e8);
  EXPECT_EQ(input.tests.of<CompressionParameters>().loading_rate->of, LoadingRate::Of::travel);
  EXPECT_DOUBLE_EQ(input.tests.of<CompressionParameters>().loading_rate->value, 1e-5);
  EXPECT_EQ(input.test_list, std::vector{uniaxial_compression.kind});
  EXPECT_EQ(input.tests.of<CompressionParameters>().strain_rate, 0.5);
  EXPECT_EQ(input.tests.of<TensionParameters>().strain_rate, 0.082);
  EXPECT_EQ(input.tests.of<CompressionParameters>().sampling_strain, 2e-5);
  EXPECT_EQ(input.tests.of<TensionParameters>().sampling_strain, 2e-6);
  EXPECT_EQ(input.tests.of<ConfinementParameters>().lateral_boundary, LateralBoundary::membrane);
  EXPECT_EQ(input.tests.of<ConfinementParameters>().intermediate_stress, 15e6);
  EXPECT_EQ(input.tests.of<BrazilianParameters>().length_ratio, 0.4);
  EXPECT_EQ(input.tests.of<TensionParameters>().grip_ratio, 0.2);
  EXPECT_EQ(input.tests.stop_strain_over_peak_strain, 1.5);
  EXPECT_EQ(input.tests.stop_strain, 0.004);
  EXPECT_EQ(input.tests.stop_stress_over_peak, 0.5);
  EXPECT_EQ(input.tests.least_peak_stress, 3e6);
  EXPECT_EQ(input.tests.least_transits_to_peak, 2.0);
  EXPECT_EQ(input.tests.least_fall_after_peak, 0.04);
  EXPECT_EQ(input.confinements, (std::vector<double>{2e6, 4e6}));
  EXPECT_EQ(input.tests.of<BrazilianParameters>().strain_rate, 0.3);
  EXPECT_EQ(input.tests.of<BrazilianParameters>().sampling_strain, 3e-6);
  EXPECT_EQ(input.tests.platen_friction, 0.1);
  EXPECT_EQ(input.tests.seating_transits, 12.0);
  EXPECT_EQ(input.steps_between_checkpoints, 500u);
  EXPECT_EQ(input.shared_body, SharedBody::always);
  const auto both = variants(input);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(flat_joint(both[0].input).n_segments, 2u);
  EXPECT_EQ(both[1].label, "Flat joint/Segments = 4");
  EXPECT_EQ(input.seeds, (std::vector<std::uint64_t>{7, 1, 2, 3}));
  EXPECT_DOUBLE_EQ(input.contact.radius_1, 0.002);
  EXPECT_DOUBLE_EQ(input.contact.radius_2, 0.003);
  EXPECT_EQ(input.contact.path_file, (folder.path() / "path.csv").string());
  EXPECT_EQ(input.strain_path.path_file, (folder.path() / "path.csv").string());
  EXPECT_EQ(input.strain_path.direction, (std::vector<std::optional<double>>{std::nullopt, -1.0, 0.5}));
  EXPECT_EQ(input.strain_path.size, 2e-3);
  EXPECT_EQ(input.strain_path.confining_pressure, 20e6);
  EXPECT_EQ(input.strain_path.largest_step, 3e-6);
  EXPECT_EQ(input.strain_path.solver, PathSolver::explicit_dynamics);
  EXPECT_EQ(input.strain_path.steps_per_millistrain, 3000u);
  EXPECT_DOUBLE_EQ(input.strain_path.cell_angle, std::numbers::pi / 6.0);
  EXPECT_EQ(input.equilibrium.event_tolerance, 1e-4);
  EXPECT_EQ(input.equilibrium.final_tolerance, 1e-8);
  EXPECT_EQ(input.equilibrium.break_rule, BreakRule::only_worst);
  EXPECT_EQ(input.boundary, (Boundary{.kind = BoundaryKind::weakly_periodic, .n_pieces = 7, .free_axis = 2}));
  EXPECT_EQ(input.sample.material, "Mohr-Coulomb");
  EXPECT_EQ(input.sample.mesh_file, (folder.path() / "sample.msh").string());
  EXPECT_EQ(input.sample.mesh_unit, MeshUnit::millimetre);
  EXPECT_EQ(input.sample.mesh_names,
            (std::map<std::string, std::vector<std::string>>{{"bottom", {"base 1", "base 2"}}, {"top", {"roof"}}}));
  EXPECT_DOUBLE_EQ(input.sample.width, 0.040);
  EXPECT_DOUBLE_EQ(input.sample.height, 0.080);
  EXPECT_EQ(input.sample.elements_across, 3u);
  EXPECT_EQ(input.sample.elements_along, 6u);
  EXPECT_EQ(input.sample.geometry, SampleGeometry::cylinder);
  EXPECT_TRUE(input.sample.reduced_quadrature);
  EXPECT_EQ(input.sample.order, 2u);
  EXPECT_TRUE(input.sample.rough_platens);
  EXPECT_TRUE(input.sample.widened_past_peak);
  EXPECT_FALSE(input.sample.scaled_softening);
  EXPECT_EQ(input.sample.n_realisations, 5u);
  EXPECT_FALSE(input.sample.random_orientation);
  EXPECT_TRUE(input.sample.assigned_to_elements);
  EXPECT_TRUE(input.sample.without_replacement);
  EXPECT_EQ(input.sample.weak_seed, WeakSeed::element);
  EXPECT_EQ(input.sample.weak_seed_strength, 0.8);
  EXPECT_EQ(input.sample.compression_step, 3e-5);
  EXPECT_EQ(input.sample.tension_step, 1e-6);
  EXPECT_EQ(input.sample.most_broken_share, 0.02);
  EXPECT_EQ(input.sample.smallest_step_share, 0.25);
  EXPECT_EQ(input.sample.newton_tolerance, 1e-7);
  EXPECT_DOUBLE_EQ(input.continuum.modulus, 50e9);
  EXPECT_EQ(input.continuum.poissons_ratio, 0.25);
  EXPECT_DOUBLE_EQ(input.continuum.cohesion, 20e6);
  EXPECT_DOUBLE_EQ(input.continuum.friction_angle, 0.25 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(input.continuum.dilation_angle, std::numbers::pi / 6.0);
  EXPECT_EQ(input.equilibrium.most_iterations, 50u);
  EXPECT_EQ(input.equilibrium.softening_steps, 12u);
  EXPECT_EQ(input.equilibrium.kinematics, Kinematics::finite);
  EXPECT_EQ(input.reference_file, (folder.path() / "rock.json").string());
  EXPECT_EQ(input.reference_results, (folder.path() / "summary.json").string());
  EXPECT_EQ(input.report_labels.title, "Tunnel <7>, \"north\"");
  EXPECT_EQ(input.report_labels.client, "Nagra & Co");
  EXPECT_EQ(input.report_labels.specimen, "BS06-3");
  EXPECT_EQ(input.report_labels.author, "Ümit");
  EXPECT_EQ(input.report_labels.date, "29 November");
}

TEST(Input, EveryEntryOfCoresReachesItsMember)
{
  const TemporaryFolder folder;
  const Input input = read_input(folder.write(
    "core.prm",
    "subsection Specimen\n  set Coring = free sides\n  set Cells across = 2\n  set Cells along = 4\nend\n"));
  EXPECT_EQ(input.specimen.coring, Coring::free_sides);
  EXPECT_EQ(input.specimen.cells_across, 2u);
  EXPECT_EQ(input.specimen.cells_along, 4u);
}

// A body without sides cannot be cut free, a packing made elsewhere is no cell, and cells belong to a core.
TEST(Input, CoresAreRefusedWhereTheyCannotBe)
{
  const auto refused = [](const std::string& entries) {
    return error_of("a.prm", "subsection Specimen\n" + entries + "end\n");
  };
  const std::string core = "  set Coring = free sides\n";
  EXPECT_TRUE(has(refused(core + "  set Shape = periodic\n"), "a periodic cell has no sides"));
  EXPECT_TRUE(has(refused("  set Cells across = 2\n"), "needs Coring = free sides"));
  // Cells of 50 mm / 20, with grains up to 1.03 mm: less than four radii.
  EXPECT_TRUE(has(refused(core + "  set Cells across = 20\n"), "must be at least"));
  EXPECT_EQ(refused(core + "  set Cells across = 10\n"), "");
}

TEST(Input, TakesASieveCurveForTheGrains)
{
  const TemporaryFolder folder;
  const std::string curve = "  set Sieve curve = 800 um 0 %; 1.2 mm 40 %; 2 mm 100%\n";
  const Input input = read_input(folder.write("a.prm", "subsection Specimen\n" + curve + "end\n"));
  const SpecimenParameters& specimen = input.specimen;
  ASSERT_EQ(specimen.sieve_curve.size(), 3u);
  EXPECT_DOUBLE_EQ(specimen.sieve_curve[0].size, 0.8e-3);
  EXPECT_EQ(specimen.sieve_curve[1].passing, 0.4);
  EXPECT_EQ(specimen.largest_radius(), 1e-3);
  EXPECT_EQ(find_parameter("Specimen/Sieve curve")->write(input), "0.8 mm 0 %; 1.2 mm 40 %; 2 mm 100 %");
  const auto refused = [](const std::string& entries, const std::string& words) {
    EXPECT_TRUE(has(error_of("a.prm", "subsection Specimen\n" + entries + "end\n"), words));
  };
  refused(curve + "  set Minimum radius = 1 mm\n", "leave out Minimum radius, Radius ratio and Size distribution");
  refused("  set Sieve curve = 1 mm 0 %; 2 mm\n", "\"2 mm\" is no point of a sieve curve; write size and share");
  refused("  set Sieve curve = 1 mm 0 %; 2 mm 60 %\n", "must begin with 0 %");
  refused("  set Sieve curve = 1 mm 0 %; 2 mm 60 %; 1.5 mm 100 %\n", "sizes must be above 0 and increase");
  refused("  set Sieve curve = 1 mm 0 %; 101 mm 100 %\n", "at most 100 times the smallest");
  refused("  set Sieve curve = 8 mm 0 %; 16 mm 100 %\n  set Width = 30 mm\n", "must be at least 32 mm");
  EXPECT_TRUE(
    has(error_of("a.prm",
                 "subsection Flat joint\n  set Strength distribution = Weibull\n  set Bond cohesion = 10 MPa\nend\n"),
        "a standard deviation must be at most 3 times its mean"));
}

TEST(Input, GrainsComeToRestByDescentUnlessMotionIsAskedFor)
{
  const TemporaryFolder folder;
  const std::string choice = "subsection Specimen\n  set Packing relaxation = ";
  EXPECT_TRUE(SpecimenParameters().packed_by_descent);
  EXPECT_FALSE(read_input(folder.write("a.prm", choice + "dynamics\nend\n")).specimen.packed_by_descent);
  EXPECT_TRUE(has(error_of("a.prm", choice + "fast\nend\n"), "static or dynamics"));
  // An input that states every entry may name grains that are there already.
  folder.write("grains.txt", "0.002 0.005 0.001\n");
  EXPECT_NO_THROW(read_input(folder.write("b.prm", choice + "static\n  set Packing file = grains.txt\nend\n")));
}

TEST(Input, EveryEntryOfClumpsReachesItsMemberOrIsRefusedByName)
{
  const TemporaryFolder folder;
  const std::string clumps = "subsection Clumps\n  set Diameter = 4 mm\n  set Form = cells\nend\n";
  const Input input = read_input(folder.write("clumps.prm", clumps));
  EXPECT_DOUBLE_EQ(input.clumps.diameter.value(), 0.004);
  EXPECT_EQ(input.clumps.form, ClumpForm::cells);
  const auto refused = [&](const std::string& more) { return error_of("a.prm", clumps + more); };
  EXPECT_TRUE(
    has(refused("subsection Specimen\n  set Dimension = 3\nend\n"), "a.prm:2: Clumps/Diameter = 4 mm: clumps are"));
  // A representative volume is not sent to a box, which it cannot have.
  EXPECT_TRUE(has(refused("subsection Specimen\n  set Shape = periodic\nend\n"),
                  "a representative volume takes none, set Diameter = none; a laboratory test takes them with Shape = "
                  "box"));
  EXPECT_TRUE(has(refused("subsection Mineral grains\n  set Mean size = 5 mm\nend\n"), "excludes Mineral grains"));
  EXPECT_TRUE(has(refused("subsection Flaws\n  set Shapes = hole centre 20, 50 mm radius 5 mm\nend\n"),
                  "excludes section Flaws"));
  EXPECT_TRUE(has(
    refused("subsection Tests\n  set List = brazilian\nend\n"),
    "Tests/List = brazilian: brazilian takes no clumps; take it out, or set Clumps/Diameter = none; tests that take "
    "them: direct_tension, uniaxial_compression, triaxial_compression"));
  EXPECT_EQ(error_of_entry("Clumps", "Form = cells"),
            "a.prm:2: Clumps/Form = cells: has no effect: Clumps/Diameter is none");
}

TEST(Input, MineralGrainsNeedAWordOnTheBondsAtTheirBoundaries)
{
  const std::string minerals = "subsection Mineral grains\n  set Mean size = 5 mm\nend\n";
  const std::string unsaid = error_of("a.prm", minerals);
  EXPECT_TRUE(unsaid.starts_with("a.prm:2: Mineral grains/Mean size = 5 mm: says nothing of the bonds")) << unsaid;
  EXPECT_NE(error_of("a.prm", minerals + "subsection Smooth joint\n  set Friction = 0.6\nend\n"), "");
  const std::string tension = "Smooth joint\n  set Tensile strength = 10 MPa\n";
  const std::string cohesion_varies = "Variants\n  set Entry = Smooth joint/Cohesion\n  set Values = 10 MPa; 20 MPa";
  for (const std::string& said :
       {std::string("Smooth joint\n  set Tensile strength = 0 MPa"), tension + "  set Cohesion = 30 MPa",
        tension + "  set Cohesion = 0 MPa", tension + "end\nsubsection " + cohesion_varies})
    EXPECT_EQ(error_of("a.prm", minerals + "subsection " + said + "\nend\n"), "") << said;
  // One strength of a bond alone would leave the other at zero without a word.
  EXPECT_EQ(error_of("a.prm", minerals + "subsection " + tension + "end\n"),
            "a.prm:2: Mineral grains/Mean size = 5 mm: has boundaries bonded by Smooth joint/Tensile strength, and "
            "Smooth joint/Cohesion is missing: give it too, 0 MPa for none");
  for (const std::string& said : {std::string("Smooth joint\n  set Cohesion = 30 MPa"), cohesion_varies})
    EXPECT_TRUE(has(error_of("a.prm", minerals + "subsection " + said + "\nend\n"),
                    "bonded by Smooth joint/Cohesion, and Smooth joint/Tensile strength is missing"))
      << said;
}

TEST(Input, EveryEntryOfParallelBondsReachesItsMember)
{
  constexpr std::string_view bonds = R"(subsection Specimen
  set Joint law = parallel bond
end
subsection Parallel bond
  set Modulus = 70 GPa
  set Stiffness ratio = 1.5
  set Radius multiplier = 0.9
  set Moment contribution = 0.5
  set Tensile strength = 20 MPa
  set Tensile strength standard deviation = 2 MPa
  set Cohesion = 300 MPa
  set Cohesion standard deviation = 30 MPa
  set Friction angle = 15 deg
  set Strength distribution = Weibull
  set Installation gap ratio = 0.07
  set Coordination number = none
  set Gapped fraction = 0.1
  set Slit fraction = 0.2
  set Initial gap = 1 um
end
)";
  const TemporaryFolder folder;
  const Input input = read_input(folder.write("bonds.prm", bonds));
  EXPECT_EQ(scan_prm("bonds.prm", std::string(bonds)).size(), entry_names("Parallel bond").size() + 1);
  EXPECT_EQ(input.specimen.joint_law, "parallel bond");
  EXPECT_EQ(parallel_bond(input).moment_contribution, 0.5);
  EXPECT_EQ(parallel_bond(input).installation_gap_ratio, 0.07);
  expect_bonds_as_set(parallel_bond(input));
  EXPECT_EQ(error_of("a.prm", "subsection Specimen\nset Joint law = parallel bond\nend\nsubsection Parallel bond\n"
                              "set Slit fraction = 0.7\nset Gapped fraction = 0.7\nend"),
            "a.prm:5: Parallel bond/Slit fraction = 0.7: must be at most 1 together with Gapped fraction = 0.7");
}

TEST(Input, EntriesOfAnotherJointLawAreRefusedByName)
{
  EXPECT_EQ(error_of_entry("Parallel bond", "Cohesion = 3 MPa"),
            "a.prm:2: Parallel bond/Cohesion = 3 MPa: is of another joint law; Specimen/Joint law is flat joint");
  // The default of another law is refused too: an entry in a file is to have an effect.
  EXPECT_EQ(error_of("a.prm", "subsection Flat joint\nset Segments = 4\nend\n"
                              "subsection Specimen\nset Joint law = parallel bond\nend"),
            "a.prm:2: Flat joint/Segments = 4: is of another joint law; Specimen/Joint law is parallel bond");
  EXPECT_EQ(error_of("a.prm", "subsection Variants\nset Entry = Flat joint/Segments\nset Values = 2; 4\nend\n"
                              "subsection Specimen\nset Joint law = parallel bond\nend"),
            "a.prm:2: Variants/Entry = Flat joint/Segments: is of another joint law; Specimen/Joint law is parallel "
            "bond");
  EXPECT_EQ(error_of_entry("Specimen", "Joint law = parallel"),
            "a.prm:2: Specimen/Joint law = parallel: must be flat joint or parallel bond or softening flat "
            "joint; did you mean \"parallel bond\"?");
}

TEST(Input, AMisspelledChoiceIsToldTheNearest)
{
  const std::string laws = ": must be flat joint or parallel bond or softening flat joint";
  EXPECT_EQ(error_of_entry("Specimen", "Joint law = paralel bond"),
            "a.prm:2: Specimen/Joint law = paralel bond" + laws + "; did you mean \"parallel bond\"?");
  EXPECT_EQ(error_of_entry("Specimen", "Joint law = Parallel Bond"),
            "a.prm:2: Specimen/Joint law = Parallel Bond" + laws +
              "; did you mean \"parallel bond\" (capital and small letters are told apart)?");
  EXPECT_EQ(error_of_entry("Specimen", "Joint law = glue"), "a.prm:2: Specimen/Joint law = glue" + laws);
  EXPECT_TRUE(error_of_entry("Specimen", "Shape = cilinder").ends_with("; did you mean \"cylinder\"?"));
  EXPECT_TRUE(error_of_entry("Tests", "List = direct_tension, brasilian").ends_with("; did you mean \"brazilian\"?"));
}

TEST(Input, AMistakeInATableOfMineralsIsThatOfItsVariant)
{
  const TemporaryFolder folder;
  folder.write("good.csv", "mineral,share [%],size [mm]\nquartz,60,5\nmica,40,4\n");
  folder.write("bad.csv", "mineral,share [%],size [mm]\nquartz,60,5\nmica,30,4\n");
  folder.write("pair.csv", "mineral_1,mineral_2,tensile_strength_ratio\nmica,pyrite,0.5\n");
  folder.write("plan.csv", "Minerals/Table\ngood.csv\nbad.csv\n");
  const std::string table = "subsection Minerals\n  set Table = good.csv\nend\n";
  const auto error_of_variants = [&](const std::string& variants) {
    return error_in(folder, "a.prm", table + "subsection Variants\n" + variants + "end\n");
  };
  const std::string shares = ": the shares add up to 90 %; they must be 100 % together";
  EXPECT_EQ(error_of_variants("  set Entry = Minerals/Table\n  set Values = good.csv; bad.csv\n"),
            "a.prm:6: Minerals/Table = bad.csv" + shares);
  EXPECT_EQ(error_of_variants("  set Table = plan.csv\n"), "a.prm:5: Minerals/Table = bad.csv" + shares);
  EXPECT_EQ(error_of_variants("  set Entry = Minerals/Boundaries\n  set Values = none; pair.csv\n"),
            "a.prm:6: Minerals/Boundaries = pair.csv: \"pyrite\" is not in the table of minerals");
}

TEST(Input, AVariantThatSetsAnEntryOfAnotherJointLawIsRefusedByName)
{
  const auto varied = [](const std::string& values, const std::string& more = "") {
    return error_of("a.prm", "subsection Variants\nset Entry = Specimen/Joint law; Flat joint/Segments\nset Values = " +
                               values + "\n" + more + "end");
  };
  // In a grid the parallel bond would be tested twice, with segments that it does not have.
  EXPECT_EQ(
    varied("flat joint; parallel bond || 2; 3"),
    "a.prm:3: Variants/Values = flat joint; parallel bond || 2; 3: Flat joint/Segments = 2: is of another joint "
    "law; Specimen/Joint law is parallel bond; set Combine = in step, or give a Table, with 4 in such a variant");
  const std::string in_step = "set Combine = in step\n";
  EXPECT_EQ(
    varied("flat joint; parallel bond || 2; 3", in_step),
    "a.prm:3: Variants/Values = flat joint; parallel bond || 2; 3: Flat joint/Segments = 3: is of another joint "
    "law; Specimen/Joint law is parallel bond; give it 4 in such a variant");
  // The value that the input has without variants says nothing new of the parallel bond.
  EXPECT_EQ(varied("flat joint; flat joint; parallel bond || 2; 3; 4", in_step), "");

  const TemporaryFolder folder;
  folder.write("plan.csv", "Specimen/Joint law,Flat joint/Segments\nflat joint,2\nparallel bond,3\n");
  EXPECT_TRUE(has(error_in(folder, "a.prm", "subsection Variants\nset Table = plan.csv\nend"),
                  "a.prm:2: Variants/Table = plan.csv: Flat joint/Segments = 3: is of another joint law; "
                  "Specimen/Joint law is parallel bond"));
}

TEST(Input, VariantsAreNamedInFilesByTheirValues)
{
  const auto names = [](const std::string& entry, const std::vector<std::string>& values) {
    std::vector<std::vector<VariantSetting>> variants;
    for (const std::string& value : values)
      variants.push_back({{entry, value}});
    return names_in_files(variants);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("Flat joint/Bond cohesion", {"80 MPa", "0.12 GPa"}),
            (Names{"bond_cohesion_80_MPa", "bond_cohesion_0.12_GPa"}));
  EXPECT_EQ(names("Tests/Tension strain rate", {"1 1/s", "2.5e-1 1/s", "1e+2 mm/m/s"}),
            (Names{"tension_strain_rate_1_per_s", "tension_strain_rate_2.5e-1_per_s",
                   "tension_strain_rate_1e2_mm_per_m_per_s"}));
  EXPECT_EQ(names("Strain path/Direction", {"free, -1, 0", "free, 1, 0"}),
            (Names{"direction_free_-1_0", "direction_free_1_0"}));
  EXPECT_EQ(names("Specimen/Specimen file", {"../rocks/a.h5", "none"}),
            (Names{"specimen_file_rocks_a_h5", "specimen_file_none"}));
  // Also where capitals make no difference two files are two: a press of 1 MPa is not one of 1 mPa.
  EXPECT_EQ(names("Tests/Confinements", {"1 MPa", "1 mPa", "2 MPa"}),
            (Names{"confinements_1_MPa_variant_1", "confinements_1_mPa_variant_2", "confinements_2_MPa"}));
  // Two sections have an entry of this name.
  EXPECT_EQ(names_in_files({{{"Flat joint/Friction", "0.5"}, {"Particle contact/Friction", "0.3"}}}),
            (Names{"flat_joint_friction_0.5_particle_contact_friction_0.3"}));
  const std::string list = "slot from 5, 10 mm to 15, 10 mm width 1 mm, slot from 5, 20 mm to 15, 20 mm width ";
  const auto long_ones = names("Flaws/Shapes", {list + "1 mm", list + "2 mm"});
  EXPECT_EQ(long_ones[0], "shapes_slot_from_5_10_mm_to_15_10_mm_width_1_mm_slot_from_5_20_mm_to_15_20_mm_variant_1");
  EXPECT_EQ(long_ones[1].back(), '2');
  for (const std::string& name : long_ones)
    EXPECT_LE(name.size(), 90u) << name;
}

// Each value with each of the others, the last entry fastest; in step as many as the lists are long; a table the same by
// rows.
TEST(Input, VariantsOfSeveralEntriesAreAGridOrInStepOrATable)
{
  const TemporaryFolder folder;
  const auto labels = [&](const std::string& section) {
    std::vector<std::string> all;
    for (const Variant& variant :
         variants(read_input(folder.write("a.prm", "subsection Variants\n" + section + "end\n"))))
      all.push_back(variant.label);
    return all;
  };
  const std::string entries = "set Entry = Flat joint/Friction; Flat joint/Bond cohesion\n";
  const auto named = [](const char* friction, const char* cohesion) {
    return fmt::format("Flat joint/Friction = {}, Flat joint/Bond cohesion = {}", friction, cohesion);
  };
  EXPECT_EQ(
    labels(entries + "set Values = 0.2; 0.6 || 80 MPa; 0.12 GPa\n"),
    (std::vector{named("0.2", "80 MPa"), named("0.2", "0.12 GPa"), named("0.6", "80 MPa"), named("0.6", "0.12 GPa")}));
  EXPECT_EQ(labels(entries + "set Values = 0.2..0.6 step 0.4 || 80..120 MPa step 40\n").size(), 4u);
  EXPECT_EQ(labels(entries + "set Values = 0.2; 0.6 || 80 MPa; 0.12 GPa\nset Combine = in step\n"),
            (std::vector{named("0.2", "80 MPa"), named("0.6", "0.12 GPa")}));
  folder.write("plan.csv", "Flat joint/Friction, Flat joint/Bond cohesion\n0.2, 80 MPa\n0.6, 0.12 GPa\n");
  EXPECT_EQ(labels("set Table = plan.csv\n"), (std::vector{named("0.2", "80 MPa"), named("0.6", "0.12 GPa")}));

  folder.write("german.csv", "Flat joint/Friction;Flat joint/Bond cohesion [MPa]\n0,2;80,5\n0,6;120\n");
  EXPECT_EQ(labels("set Table = german.csv\n"), (std::vector{named("0.2", "80.5 MPa"), named("0.6", "120 MPa")}));

  // Units in the header, as in tests.csv of a run, which has a row for each test and columns of results.
  const std::vector<std::string> two{named("0.2", "80 MPa"), named("0.6", "120 MPa")};
  folder.write("units.csv", "\"\",Flat joint/Friction,Flat joint/Bond cohesion [MPa]\n1,0.2,80\n2,0.6,\"120\"\n");
  EXPECT_EQ(labels("set Table = units.csv\n"), two);
  folder.write("tests.csv", "name,kind,seed,Flat joint/Friction,Flat joint/Bond cohesion [MPa],peak_stress_Pa\n"
                            "a,direct_tension,1,0.2,80,1e7\na,direct_tension,2,0.2,80,\nb,direct_tension,1,0.6,120,\n");
  EXPECT_EQ(labels("set Table = tests.csv\n"), two);

  const auto all = variants(read_input(folder.write("a.prm", "subsection Variants\nset Table = plan.csv\nend\n")));
  EXPECT_EQ(flat_joint(all[1].input).friction, 0.6);
  EXPECT_EQ(flat_joint(all[1].input).bond_cohesion, 120e6);
  ASSERT_EQ(all[1].settings.size(), 2u);
  const auto written = number_of(all[1].settings[1]);
  ASSERT_TRUE(written);
  EXPECT_EQ(written->value, 0.12);
  EXPECT_EQ(written->unit, "GPa");
  EXPECT_FALSE(number_of({"Specimen/Joint law", "flat joint"}));
  EXPECT_FALSE(number_of({"Tests/Confinements", "5, 10 MPa"}));

  EXPECT_EQ(all[1].name_in_files, "friction_0.6_bond_cohesion_0.12_GPa");

  const auto refused = [&](const std::string& section, const std::string& with) {
    EXPECT_TRUE(has(error_in(folder, "a.prm", "subsection Variants\n" + section + "end\n"), with));
  };
  refused(entries + "set Values = 0.2; 0.6\n", "there are 2 entries and 1 lists of values");
  refused(entries + "set Values = 0.2; 0.6 || 80 MPa\nset Combine = in step\n", "in step they need as many");
  refused("set Entry = Flat joint/Friction; Flat joint/Friction\nset Values = 0.2 || 0.6\n", "is named twice");
  refused(entries + "set Values = 0.2 || 80 MPa\nset Table = plan.csv\n", "excludes Entry and Values");
}

TEST(Input, EveryEntryOfSofteningFlatJointsReachesItsMember)
{
  constexpr std::string_view joints = R"(subsection Specimen
  set Joint law = softening flat joint
end
subsection Softening flat joint
  set Segments = 3
  set Rings = 1
  set Sectors = 6
  set Modulus = 70 GPa
  set Stiffness ratio = 1.5
  set Friction = 0.4
  set Radius multiplier = 0.9
  set Bond tensile strength = 20 MPa
  set Bond tensile strength standard deviation = 2 MPa
  set Bond cohesion = 300 MPa
  set Bond cohesion standard deviation = 30 MPa
  set Bond friction angle = 15 deg
  set Strength distribution = Weibull
  set Strength draw = per contact
  set Installation gap ratio = 0.07
  set Coordination number = none
  set Gapped fraction = 0.1
  set Slit fraction = 0.2
  set Initial gap = 1 um
  set Softening opening = 3 um
end
)";
  const auto entries = scan_prm("joints.prm", std::string(joints));
  EXPECT_EQ(entries.size(), entry_names("Softening flat joint").size() + 1);
  // Entries of space have no use in the plane, where they must be left out.
  std::string in_plane(joints);
  for (const std::string line : {"  set Rings = 1\n", "  set Sectors = 6\n"})
    in_plane.erase(in_plane.find(line), line.size());
  const TemporaryFolder folder;
  const Input input = read_input(folder.write("joints.prm", in_plane));
  const SofteningFlatJointParameters& read = std::get<SofteningFlatJointParameters>(input.joints);
  EXPECT_EQ(read.n_segments, 3u);
  EXPECT_EQ(read.modulus, 70e9);
  EXPECT_EQ(read.stiffness_ratio, 1.5);
  EXPECT_EQ(read.friction, 0.4);
  EXPECT_EQ(read.radius_multiplier, 0.9);
  EXPECT_EQ(read.bond_tensile_strength, 20e6);
  EXPECT_EQ(read.bond_tensile_strength_deviation, 2e6);
  EXPECT_EQ(read.bond_cohesion, 300e6);
  EXPECT_EQ(read.bond_cohesion_deviation, 30e6);
  EXPECT_DOUBLE_EQ(read.bond_friction_angle, std::numbers::pi / 12.0);
  EXPECT_EQ(read.strength_distribution, StrengthDistribution::weibull);
  EXPECT_EQ(read.strength_draw, StrengthDraw::per_contact);
  EXPECT_EQ(read.installation_gap_ratio, 0.07);
  EXPECT_EQ(read.coordination_number, std::nullopt);
  EXPECT_EQ(read.gapped_fraction, 0.1);
  EXPECT_EQ(read.slit_fraction, 0.2);
  EXPECT_DOUBLE_EQ(read.initial_gap, 1e-6);
  EXPECT_DOUBLE_EQ(read.softening_opening, 3e-6);
  EXPECT_EQ(flat_joint(input).n_segments, 4u) << "the section of another law";
  EXPECT_EQ(error_of("a.prm", "subsection Specimen\nset Joint law = softening flat joint\nend\n"
                              "subsection Softening flat joint\nset Softening opening = -1 um\nend"),
            "a.prm:5: Softening flat joint/Softening opening = -1 um: must lie in [0 um, 1000000 um]");
}

TEST(Input, VariantsMayDifferInJointLaw)
{
  const TemporaryFolder folder;
  const Input input = read_input(folder.write("a.prm", R"(subsection Variants
  set Entry = Specimen/Joint law
  set Values = flat joint; parallel bond
end
subsection Flat joint
  set Segments = 3
end
subsection Parallel bond
  set Cohesion = 70 MPa
  set Installation gap ratio = 0.1
end
)"));
  const auto both = variants(input);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].input.specimen.joint_law, "flat joint");
  EXPECT_EQ(both[1].input.specimen.joint_law, "parallel bond");
  EXPECT_EQ(flat_joint(both[0].input).n_segments, 3u);
  EXPECT_EQ(flat_joint(both[0].input).installation_gap_ratio, 0.05);
  EXPECT_EQ(parallel_bond(both[1].input).bond_cohesion, 70e6);
  EXPECT_EQ(parallel_bond(both[1].input).coordination_number, std::nullopt);
  // Each is told with its own section alone, and without smooth joints, minerals and the form of clumps, which neither has.
  for (const Parameter& parameter : parameter_table())
    {
      if (parameter.section == "Smooth joint" || parameter.section == "Softening flat joint" ||
          parameter.name() == "Clumps/Form" || (parameter.section == "Minerals" && parameter.entry != "Table"))
        {
          EXPECT_FALSE(has_use_for(both[0].input, parameter) || has_use_for(both[1].input, parameter));
          continue;
        }
      EXPECT_EQ(has_use_for(both[0].input, parameter), parameter.section != "Parallel bond") << parameter.name();
      EXPECT_EQ(has_use_for(both[1].input, parameter), parameter.section != "Flat joint") << parameter.name();
    }
}

TEST(Input, RefusesWhatNoProgrammeCanBe)
{
  EXPECT_EQ(error_of_entry("Flat joint", "Modulus = 1e300 GPa"),
            "a.prm:2: Flat joint/Modulus = 1e300 GPa: 1e+300 GPa is beyond the range of numbers; write a stress, e.g. "
            "\"22 MPa\"");
  // A number that vanishes in products is 0, which these may not be.
  EXPECT_EQ(error_of_entry("Flat joint", "Modulus = 5e-324 GPa"),
            "a.prm:2: Flat joint/Modulus = 5e-324 GPa: must be > 0 GPa");
  for (const char* const entry : {"Stiffness ratio = 5e-324", "Radius multiplier = 1e-300"})
    EXPECT_EQ(error_of_entry("Flat joint", entry), fmt::format("a.prm:2: Flat joint/{}: must be > 0", entry));
  EXPECT_TRUE(has(error_of_entry("Flat joint", "Modulus = 1e30 GPa"), "is too large; a number is at most 1e+30 in SI"));
  EXPECT_EQ(error_of_entry("Flat joint", "Installation gap ratio = 1.5"),
            "a.prm:2: Flat joint/Installation gap ratio = 1.5: must lie in [0, 1], or be none");
  EXPECT_EQ(error_of_entry("Tests", "Confinements = 5, -10 MPa"),
            "a.prm:2: Tests/Confinements = 5, -10 MPa: must be > 0 MPa each; without confinement it is "
            "uniaxial_compression");
  EXPECT_NE(error_of_entry("Tests", "Confinements = MPa"), "");
  EXPECT_NE(error_of_entry("Tests", "Confinements ="), "");
  EXPECT_TRUE(has(error_of_entry("Tests", "Confinements = 5, 5 MPa"), "given twice"));
  EXPECT_TRUE(has(error_of_entry("Tests", "Grip ratio = 0"), "must lie in (0, 0.4]"));
  EXPECT_TRUE(has(error_of_entry("Tests", "Steps between checkpoints = 0"), "integer > 0"));
  EXPECT_TRUE(has(error_of_entry("Seeds", "Seeds = 1.5"), "1.5"));
  EXPECT_TRUE(has(error_of_entry("Strain path", "Direction = 0, 1"), "there must be 3: xx, yy, xy"));
  EXPECT_TRUE(has(error_of_entry("Strain path", "Direction = free, 0, free"), "other than 0"));
  EXPECT_TRUE(has(error_of_entry("Strain path", "Direction = 0, nan, 0"), "not a decimal number"));
  EXPECT_TRUE(has(error_of_entry("Specimen", "Minimum radius = 0.62 um"), "more than 1e+07 are not packed"));
  EXPECT_TRUE(has(error_of_entry("Strain path", "Largest step = 0"), "must lie in (0, 0.1]"));
  EXPECT_TRUE(has(error_of_entry("Representative volume", "Break rule = worst"), "near worst or only worst"));
  EXPECT_TRUE(has(error_of_entry("Variants", "Entry = Flat joint/Segments"), "go together"));
  EXPECT_EQ(error_of_entry("Variants", "Entry = Segments"),
            "a.prm:2: Variants/Entry = Segments: lacks its section; write Section/Entry: Flat joint/Segments or "
            "Softening flat joint/Segments");
  EXPECT_TRUE(has(error_of_entry("Variants", "Entry = Specimen/Dimension"), "it cannot vary"));
  EXPECT_TRUE(has(error_of_entry("Variants", "Entry = Flat joint/Segmens"), "mean \"Flat joint/Segments\"?"));
  EXPECT_TRUE(has(error_of_entry("Variants", "Entry = Flat joint/Segments\n  set Values = 1, 2"),
                  "values are separated by semicolons"));
  EXPECT_TRUE(has(error_of_entry("Seeds", "Seeds = 1-3"), "\"1-3\": a range is written with two dots, 1..3"));
  EXPECT_TRUE(has(error_of_entry("Tests", "Confinements = 5; 10"), "separated by commas and the unit stands once"));
  EXPECT_TRUE(
    has(error_of_entry("Variants", "Entry = Flat joint/Segments\n  set Values = 2; 0"), "integer in [1, 32]"));
}

TEST(Input, JsonSaysTheSame)
{
  const TemporaryFolder folder;
  const Input from_prm = read_input(folder.write("a.prm", R"(subsection Flat joint
  set Bond tensile strength = 21.5 MPa
  set Segments = 3
  set Friction = 0.35
  set Installation gap ratio = 0.05
end
subsection Seeds
  set Seeds = 1, 2, 18446744073709551615
end
subsection Tests
  set List = uniaxial_compression, direct_tension
  set Stop strain = none
end
)"));
  const Input from_json = read_input(folder.write("a.json", R"({
  "Flat joint": {"Bond tensile strength": "21.5 MPa", "Segments": 3, "Friction": 0.35,
                 "Installation gap ratio": 5e-2},
  "Seeds": {"Seeds": [1, 2, 18446744073709551615]},
  "Tests": {"List": ["uniaxial_compression", "direct_tension"], "Stop strain": null}
})"));
  for (const Parameter& parameter : parameter_table())
    EXPECT_EQ(parameter.write(from_json), parameter.write(from_prm)) << parameter.name();
  EXPECT_EQ(flat_joint(from_json).bond_tensile_strength, 21.5e6);
}

TEST(Input, ReadsTheSameWhereTheDecimalSignIsAComma)
{
  const TemporaryFolder folder;
  const std::filesystem::path prm = write_everything(folder);
  const std::filesystem::path json = folder.write("a.json", R"({"Flat joint": {"Friction": 0.35}})");
  const Input in_c = read_input(prm);

  tests::make_german_locale(folder.path());
  setenv("LOCPATH", folder.path().c_str(), 1);
  ASSERT_NE(std::setlocale(LC_ALL, "de_DE.UTF-8"), nullptr);
  const Input in_german = read_input(prm);
  const Input json_in_german = read_input(json);
  std::setlocale(LC_ALL, "C");
  unsetenv("LOCPATH");

  for (const Parameter& parameter : parameter_table())
    EXPECT_EQ(parameter.write(in_german), parameter.write(in_c)) << parameter.name();
  EXPECT_EQ(flat_joint(in_german).modulus, flat_joint(in_c).modulus);
  EXPECT_EQ(flat_joint(json_in_german).friction, 0.35);
}

TEST(Input, AllowsWindowsLinesAndTheMarkOfUtf8)
{
  const TemporaryFolder folder;
  const Input input =
    read_input(folder.write("a.prm", "\xEF\xBB\xBFsubsection Flat joint\r\n\tset Segments\t=\t5\r\nend\r\n"));
  EXPECT_EQ(flat_joint(input).n_segments, 5u);
}

TEST(Input, ErrorsNameTheLineOnWhichAnEntryStarts)
{
  EXPECT_EQ(error_of("a.prm", "# one\n\nsubsection Flat joint\n  set Bond friction \\\n  angle = \\\n  95 deg\nend\n"),
            "a.prm:4: Flat joint/Bond friction angle = 95 deg: must lie in [0 deg, 90 deg)");
}

TEST(Input, ChecksEveryRange)
{
  const std::vector<std::pair<std::string_view, std::string_view>> mistakes{
    {"Specimen", "Dimension = 4"},
    {"Specimen", "Shape = cylinder"},
    {"Specimen", "Width = 0 mm"},
    {"Specimen", "Height = -1 mm"},
    {"Specimen", "Minimum radius = 0 mm"},
    {"Specimen", "Radius ratio = 0.99"},
    {"Specimen", "Radius ratio = 1e6"},
    {"Specimen", "Porosity = 1"},
    {"Specimen", "Density = 0 kg/m^3"},
    {"Specimen", "Packing stress ratio = 0"},
    {"Specimen", "Packing file = nowhere.txt"},
    {"Specimen", "Specimen file = ."},
    {"Flat joint", "Segments = 0"},
    {"Flat joint", "Segments = 33"},
    {"Flat joint", "Rings = 0"},
    {"Flat joint", "Sectors = 2"},
    {"Flat joint", "Segments = 2.5"},
    {"Flat joint", "Segments = -1"},
    {"Flat joint", "Modulus = 0 GPa"},
    {"Flat joint", "Stiffness ratio = 0"},
    {"Flat joint", "Friction = -0.1"},
    {"Flat joint", "Radius multiplier = 0"},
    {"Flat joint", "Bond tensile strength = -1 MPa"},
    {"Flat joint", "Bond tensile strength standard deviation = -1 MPa"},
    {"Flat joint", "Bond cohesion = -1 MPa"},
    {"Flat joint", "Bond cohesion standard deviation = -1 MPa"},
    {"Flat joint", "Bond friction angle = 90 deg"},
    {"Flat joint", "Bond friction angle = -1 deg"},
    {"Flat joint", "Strength draw = per grain"},
    {"Flat joint", "Installation gap ratio = -0.1"},
    {"Flat joint", "Coordination number = 0"},
    {"Flat joint", "Gapped fraction = 1.1"},
    {"Flat joint", "Slit fraction = -0.1"},
    {"Flat joint", "Initial gap = -1 mm"},
    {"Particle contact", "Modulus = 0 GPa"},
    {"Particle contact", "Stiffness ratio = -1"},
    {"Particle contact", "Friction = -1"},
    {"Dynamics", "Damping = 1"},
    {"Dynamics", "Time step safety = 0"},
    {"Dynamics", "Time step safety = 1.1"},
    {"Tests", "List = shear"},
    {"Tests", "List ="},
    {"Tests", "List = direct_tension, direct_tension"},
    {"Tests", "Compression strain rate = 0 1/s"},
    {"Tests", "Tension strain rate = -1 1/s"},
    {"Tests", "Compression sampling strain = 0"},
    {"Tests", "Compression sampling strain = 1e300"},
    {"Tests", "Seating transits = 1e300"},
    {"Tests", "Tension sampling strain = 0"},
    {"Tests", "Grip ratio = 0.41"},
    {"Tests", "Lateral boundary = oil"},
    {"Tests", "Intermediate stress = 0 MPa"},
    {"Tests", "Brazilian length ratio = 0"},
    {"Specimen", "Shape = cylinder"},
    {"Tests", "Stop strain over peak strain = 1"},
    {"Tests", "Stop strain = 0"},
    {"Tests", "Stop strain = 1e9"},
    {"Tests", "Stop stress over peak = 1"},
    {"Seeds", "Seeds = -1"},
    {"Seeds", "Seeds = 1, 2, 1"},
    {"Seeds", "Seeds = 1, 0..3"},
    {"Seeds", "Seeds = 3..1"},
    {"Seeds", "Seeds = 1..3..5"},
    {"Seeds", "Seeds = 0..18446744073709551615"},
    {"Contact", "Radius 1 = 0 mm"},
    {"Contact", "Radius 2 = -1 mm"},
    {"Contact path", "File = nowhere.csv"},
    {"Report", "Reference file = nowhere.json"}};
  for (const auto& [section, setting] : mistakes)
    EXPECT_EQ(error_of_entry(section, setting)
                .find(fmt::format("a.prm:2: {}/{}: ", section, setting.ends_with('=') ? "List = " : setting)),
              0u)
      << section << "/" << setting << " gave: " << error_of_entry(section, setting);
}

TEST(Input, ADimensionlessEntryHasNoUnit)
{
  EXPECT_EQ(error_of_entry("Flat joint", "Friction = 0.5 MPa"),
            "a.prm:2: Flat joint/Friction = 0.5 MPa: is a number without unit; it must be >= 0");
  EXPECT_EQ(error_of_entry("Tests", "Confinements = 5 MPa, 20 MPa"),
            "a.prm:2: Tests/Confinements = 5 MPa, 20 MPa: \"5 MPa\": the unit stands once, after the last number");
}

TEST(Input, TheInstallationGapFollowsFromOneEntry)
{
  const TemporaryFolder folder;
  const Input by_gap =
    read_input(folder.write("a.prm", "subsection Flat joint\nset Installation gap ratio = 0.1\nend"));
  EXPECT_EQ(flat_joint(by_gap).installation_gap_ratio, 0.1);
  EXPECT_EQ(flat_joint(by_gap).coordination_number, std::nullopt);
  EXPECT_NE(error_of("a.prm", "subsection Flat joint\n"
                              "set Installation gap ratio = 0.1\nset Coordination number = 4.2\nend"),
            "");
  const Input by_number =
    read_input(folder.write("a.prm", "subsection Flat joint\nset Coordination number = 4.2\nend"));
  EXPECT_EQ(flat_joint(by_number).installation_gap_ratio, std::nullopt);
  EXPECT_EQ(flat_joint(by_number).coordination_number, 4.2);
  // Entries in files from before the gap was the default, and in `best.prm` of calibrations.
  EXPECT_EQ(error_of("a.prm", "subsection Flat joint\n"
                              "set Installation gap ratio = none\nset Coordination number = 4.2\nend"),
            "");
  EXPECT_EQ(error_of_entry("Flat joint", "Installation gap ratio = none"),
            "a.prm:2: Flat joint/Installation gap ratio = none: leaves the joints undetermined; give a gap, or "
            "Coordination number");
}

TEST(Input, FractionsAddUpToOneAtMost)
{
  EXPECT_EQ(error_of("a.prm", "subsection Flat joint\nset Gapped fraction = 0.5\nset Slit fraction = 0.5\nend"), "");
  EXPECT_NE(error_of("a.prm", "subsection Flat joint\nset Gapped fraction = 0.5\nset Slit fraction = 0.6\nend"), "");
}

TEST(Input, ASpecimenHasRoomForTwoGrains)
{
  // Two of the largest grains, of 1.66 × 0.62 mm radius, side by side: 4.1168 mm.
  EXPECT_EQ(error_of_entry("Specimen", "Width = 4.2 mm"), "");
  EXPECT_TRUE(has(error_of_entry("Specimen", "Width = 4.1 mm"), "4.1168 mm"));
  EXPECT_NE(error_of_entry("Specimen", "Height = 4.1 mm"), "");
  EXPECT_NE(error_of_entry("Specimen", "Minimum radius = 10 mm"), "");
}

TEST(Input, OneSourceOfGrains)
{
  const TemporaryFolder folder;
  folder.write("grains", "");
  const auto both =
    folder.write("a.prm", "subsection Specimen\nset Packing file = grains\nset Specimen file = grains\nend");
  EXPECT_THROW(read_input(both), InputError);
}

TEST(Input, TellsWhatIsWrongWithTheStructure)
{
  const std::vector<std::pair<std::string_view, std::string_view>> mistakes{
    {"subsection Flat joint\nset Segments = 3\nset Segments = 4\nend", "a.prm:3: Flat joint/Segments: is given twice"},
    {"subsection Flat joint\nset Segments = 3\nend\nsubsection Flat joint\nset Segments = 3\nend",
     "a.prm:5: Flat joint/Segments: is given twice"},
    {"subsection Flat joint\nset Segments = 3\n", "a.prm:1: subsection Flat joint: is not closed"},
    {"subsection Flat joint\nsubsection Seeds\nend\nend", "a.prm:2: subsection Seeds: opens inside Flat joint"},
    {"end", "a.prm:1: end: "},
    {"subsection Seeds\nend\nend", "a.prm:3: end: "},
    {"subsection Seeds\nend of it", "a.prm:2: \"end of it\": "},
    {"set Segments = 3", "a.prm:1: Segments: stands outside"},
    {"subsection Flat joint\nset Segments 3\nend", "a.prm:2: \"set Segments 3\": "},
    {"subsection Flat joint\nSegments = 3\nend", "a.prm:2: \"Segments = 3\": "},
    {"Set Segments = 3", "a.prm:1: \"Set Segments = 3\": "},
    {"include other.prm", "a.prm:1: include: "},
    {"subsection Flat joints\nend", "a.prm:1: Flat joints: no such section; did you mean \"Flat joint\"?"},
    {"subsection Flat joint\nset Bond tensile strenght = 3 MPa\nend",
     "a.prm:2: Flat joint/Bond tensile strenght: no such entry; did you mean \"Bond tensile strength\"?"},
    {"subsection Flat joint\nset segments = 3\nend", "a.prm:2: Flat joint/segments: no such entry"},
    {std::string_view("a\0b", 3), "a.prm: is not a text file"},
    {"subsection Fl\xFF", "a.prm: is not encoded in UTF-8"}};
  for (const auto& [text, error] : mistakes)
    EXPECT_EQ(error_of("a.prm", text).find(error), 0u) << text << "\ngave: " << error_of("a.prm", text);
}

TEST(Input, TellsWhatIsWrongWithJson)
{
  const std::vector<std::pair<std::string_view, std::string_view>> mistakes{
    {R"({"Flat joint": {"Bond tensile strength": 22}})", "a.json: Flat joint/Bond tensile strength = 22: a unit is"},
    {R"({"Flat joint": {"Segments": 0}})", "a.json: Flat joint/Segments = 0: must be"},
    {R"({"Flat joint": {"Segments": 3, "Segments": 4}})", "a.json: Flat joint/Segments: is given twice"},
    {R"({"Flat joint": {}, "Flat joint": {}})", "a.json: Flat joint: is given twice"},
    {R"({"Flat joints": {}})", "a.json: Flat joints: no such section; did you mean \"Flat joint\"?"},
    {R"({"Flat joint": {"Segment": 4}})", "a.json: Flat joint/Segment: no such entry; did you mean \"Segments\"?"},
    {R"({"Flat joint": 4})", "a.json: Flat joint: must be an object"},
    {R"({"Flat joint": {"Segments": {"value": 4}}})", "a.json: Flat joint/Segments: found object"},
    {R"({"Flat joint": {"Segments": true}})", "a.json: Flat joint/Segments: found boolean"},
    {R"({"Flat joint": {"Segments": [[4]]}})", "a.json: Flat joint/Segments: found array"},
    {"{\"Flat joint\":\n  {\"Segments\": 4", "a.json:2:17: is not valid JSON: "},
    {R"({"Flat joint": {"Friction": NaN}})", "a.json:1:29: is not valid JSON: "},
    {R"({"Flat joint": {"Friction": 1e999}})", "a.json: a number is beyond"},
    {"[]", "a.json: the file must be one object"},
    {"", "a.json:1:1: is not valid JSON: "}};
  for (const auto& [text, error] : mistakes)
    EXPECT_EQ(error_of("a.json", text).find(error), 0u) << text << "\ngave: " << error_of("a.json", text);
}

/// The text with a few bytes changed, taken out, doubled or put in from elsewhere in it.
std::string mutated(std::string text, std::mt19937& random)
{
  constexpr std::array<std::string_view, 13> pieces{"-",  "9", "e9",    "nan", "..", ";", "\\\n",
                                                    "# ", "=", "end\n", "}",   "[",  ","};
  const auto any = [&](const std::size_t n) { return std::size_t(random() % n); };
  for (std::size_t n = 1 + any(4); n > 0; --n)
    {
      const std::size_t at = any(text.size());
      const std::size_t length = any(40);
      switch (any(5))
        {
        case 0:
          text[at] = char(any(256));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, std::string(text, any(text.size()), length));
          break;
        case 3:
          text.insert(at, any(5000), text[at]);
          break;
        default:
          text.insert(at, pieces[any(pieces.size())]);
        }
      text.push_back('\n'); // so that there is always something to change
    }
  return text;
}

// A damaged input is read, or refused in one line of bearable length: nothing else comes out of it.
TEST(Input, MutatedFilesAreReadOrRefusedInOneLine)
{
  const TemporaryFolder folder;
  for (const char* name : {"grains.txt", "path.csv", "rock.json", "sample.msh", "summary.json"})
    folder.write(name, "");
  constexpr std::string_view json = R"({"Flat joint": {"Bond tensile strength": "21.5 MPa", "Segments": 3},
    "Seeds": {"Seeds": [1, 2, 18446744073709551615]}, "Tests": {"List": ["direct_tension"], "Stop strain": null}})";
  std::mt19937 random(1);
  std::size_t n_refused = 0;
  for (int k = 0; k < 1500; ++k)
    {
      const bool is_prm = k % 3 != 0;
      const std::string text = mutated(std::string(is_prm ? everything : json), random);
      const auto file = folder.write(is_prm ? "a.prm" : "a.json", text);
      const std::string what = refusal([&] { read_input(file); });
      n_refused += what != "";
      EXPECT_FALSE(has(what, "\n"));
      EXPECT_LT(what.size(), 1500u) << what;
    }
  EXPECT_GT(n_refused, 700u);
}

TEST(Input, TellsWhatIsWrongWithTheFile)
{
  const TemporaryFolder folder;
  EXPECT_THROW(read_input(folder.path() / "missing.prm"), InputError);
  EXPECT_THROW(read_input(folder.path()), InputError);
  EXPECT_THROW(read_input(folder.write("a.txt", "")), InputError);
  EXPECT_THROW(read_input(std::string(5000, 'a') + ".prm"), InputError);
}
TEST(Input, ShapesAreReadInTheWordsOfTheUser)
{
  const auto shapes =
    parse_shapes("hole centre 25, 50 mm semi-axes 6, 3 mm angle 90 deg | slot from 2.5, 0 cm to 2.5, 1.2 "
                 "cm width 1 mm | closed flaw centre 25, 50 mm length 20 mm angle 90 deg | sphere centre "
                 "1, 2, 3 mm radius 4 mm | disc flaw centre 1, 2, 3 mm radius 4 mm dip 90 deg | joint "
                 "set spacing 10 mm persistence 0.5 trace-length 5 mm seed 7 | hole corners 1, 1, 5, 1, "
                 "3, 4 mm");
  ASSERT_EQ(shapes.size(), 7u);
  EXPECT_DOUBLE_EQ(std::get<EllipseHole>(shapes[0]).semi_axes[0], 0.006);
  EXPECT_DOUBLE_EQ(std::get<EllipseHole>(shapes[0]).angle, std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(std::get<Slot>(shapes[1]).to[1], 0.012);
  // Upright: from 40 to 60 mm at x = 25 mm.
  const auto& flaw = std::get<ClosedFlaw>(shapes[2]);
  EXPECT_NEAR(flaw.points[0][0], 0.025, 1e-15);
  EXPECT_NEAR(flaw.points[0][1], 0.040, 1e-15);
  EXPECT_NEAR(flaw.points[1][1], 0.060, 1e-15);
  EXPECT_DOUBLE_EQ(std::get<SphereHole>(shapes[3]).radius, 0.004);
  EXPECT_NEAR(std::get<DiscFlaw>(shapes[4]).normal[0], 1.0, 1e-15);
  EXPECT_EQ(std::get<JointSet>(shapes[5]).seed, 7u);
  EXPECT_EQ(std::get<JointSet>(shapes[5]).persistence, 0.5);
  EXPECT_EQ(std::get<PolygonHole>(shapes[6]).corners.size(), 3u);
}

TEST(Input, FlawsMayHaveSmoothSidesOfTheirOwn)
{
  const auto shapes = parse_shapes("closed flaw from 1, 1 mm to 9, 9 mm smooth | joint set angle 30 deg spacing 10 mm "
                                   "smooth friction 0.8 dilation 5 deg cohesion 2 MPa tensile-strength 1 MPa "
                                   "friction-angle 45 deg normal-stiffness 300 GPa/m shear-stiffness 0.1 GPa/mm | "
                                   "closed flaw from 1, 1 mm to 9, 9 mm");
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(smooth_sides(shapes[2]), nullptr);
  SmoothJointParameters all;
  all.cohesion = 70e6; // of mineral grains
  all.friction = 0.3;
  const SmoothSides* const plain = smooth_sides(shapes[0]);
  ASSERT_NE(plain, nullptr);
  EXPECT_FALSE(plain->are_bonded());
  EXPECT_EQ(plain->among(all).friction, 0.3);
  EXPECT_EQ(plain->among(all).cohesion, 0.0);
  const SmoothSides* const own = smooth_sides(shapes[1]);
  ASSERT_NE(own, nullptr);
  EXPECT_TRUE(own->are_bonded());
  const SmoothJointParameters one = own->among(all);
  EXPECT_EQ(one.friction, 0.8);
  EXPECT_DOUBLE_EQ(one.dilation_angle, 5.0 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(one.cohesion, 2e6);
  EXPECT_DOUBLE_EQ(one.tensile_strength, 1e6);
  EXPECT_DOUBLE_EQ(one.friction_angle.value(), std::numbers::pi / 4.0);
  EXPECT_DOUBLE_EQ(one.normal_stiffness, 300e9);
  EXPECT_DOUBLE_EQ(one.shear_stiffness, 100e9);
  // The flaws of a set are as smooth as it is.
  for (const ClosedFlaw& flaw : traces(std::get<JointSet>(shapes[1]), {0.05, 0.1}))
    EXPECT_EQ(flaw.smooth.value().friction, 0.8);
}

TEST(Input, SmoothJointsThatCannotBeAreNamed)
{
  const auto error = [](const std::string& section, const std::string& entry) {
    const std::string found = error_of_entry(section, entry);
    EXPECT_TRUE(found.starts_with("a.prm:2: " + section + "/")) << found;
    EXPECT_FALSE(has(found, "\n"));
    return found;
  };
  EXPECT_TRUE(has(error("Smooth joint", "Friction = 0.4"), "has no effect: Mineral grains/Mean size is none"));
  EXPECT_TRUE(has(error("Smooth joint", "Normal stiffness = 50 GPa"), "GPa/mm"));
  EXPECT_TRUE(
    has(error("Smooth joint", "Dilation angle = 40 deg\nend\nsubsection Mineral grains\n  set Mean size = 5 mm"),
        "Dilation angle = 40 deg: dilation must be at most the angle of friction, 26.6 deg"));
  EXPECT_TRUE(has(error("Mineral grains", "Mean size = 0 mm"), "must be > 0 mm"));
  EXPECT_TRUE(has(error("Flaws", "Shapes = closed flaw from 1, 1 mm to 9, 9 mm friction 0.4"),
                  "shape 1, closed flaw: friction is of smooth sides; say smooth before it"));
  EXPECT_TRUE(has(error("Flaws", "Shapes = closed flaw from 1, 1 mm to 9, 9 mm smooth very"),
                  "shape 1, closed flaw: smooth stands alone"));
  EXPECT_TRUE(has(error("Flaws", "Shapes = closed flaw from 1, 1 mm to 9, 9 mm smooth cohesion -1 MPa"),
                  "cohesion -1 MPa: must be >= 0"));
  EXPECT_TRUE(has(error("Flaws", "Shapes = closed flaw from 1, 1 mm to 9, 9 mm smooth friction 0.1 dilation 10 deg"),
                  "must be at most the angle of friction, 5.71 deg"));
}

TEST(Input, ShapesThatAreWrongAreNamed)
{
  const auto error = [](const std::string& shapes) { return error_of_entry("Flaws", "Shapes = " + shapes); };
  const std::string begin = "a.prm:2: Flaws/Shapes = ";
  for (const auto& [shapes, why] : std::vector<std::pair<std::string, std::string>>{
         {"cave", "shape 1, \"cave\" is no shape; it begins with one of: hole, sphere, slot, closed flaw"},
         {"hole centre 25, 50 mm radius 5 mm | hole centre 25, 50 mm radius -5 mm",
          "shape 2, hole: radius -5 mm: must be > 0 mm"},
         {"hole centre 25 mm radius 5 mm", "shape 1, hole: centre 25 mm: has 1 coordinate(s); there must be 2"},
         {"hole centre 25, 50 radius 5 mm", "shape 1, hole: centre 25, 50: a unit is missing"},
         {"hole centre 25, 50 mm", "shape 1, hole: is given by \"centre X, Y mm radius R mm\""},
         {"hole center 25, 50 mm radius 5 mm", "shape 1, hole: \"center\" is not one of its words"},
         {"slot from 25, 0 mm to 25, 0 mm width 1 mm", "shape 1, slot: ends where it begins"},
         {"slot from 25, 0 mm to 25, 5 mm", "shape 1, slot: is given by \"from X, Y mm to X, Y mm width W mm\" or"},
         {"closed flaw from 25, 0 mm from 25, 5 mm", "shape 1, closed flaw: from is given twice"},
         {"joint set spacing 5 mm persistence 0.5", "shape 1, joint set: trace-length is missing"},
         {"joint set spacing 5 mm persistence 1.5 trace-length 3 mm",
          "shape 1, joint set: persistence 1.5: must lie in (0, 1]"},
         {"hole centre 49, 50 mm radius 5 mm", "shape 1, hole: (54, 50) mm lies outside of the specimen"},
         {"sphere centre 25, 25, 50 mm radius 5 mm",
          "shape 1, sphere: lies in space; it needs Specimen/Dimension = 3"}})
    {
      const std::string found = error(shapes);
      EXPECT_TRUE(found.starts_with(begin)) << found;
      EXPECT_TRUE(has(found, why));
      EXPECT_FALSE(has(found, "\n"));
    }
}

TEST(Input, ClumpsAreTestedByWhatSaysThatItTakesThem)
{
  const TemporaryFolder folder;
  const auto file = [&](const std::string_view test) {
    return folder.write("a.prm", "subsection Clumps\n  set Diameter = 6 mm\nend\nsubsection Tests\n  set List = " +
                                   std::string(test) + "\nend\n");
  };
  std::size_t n_taken = 0;
  for (const LaboratoryProtocol* protocol : laboratory_protocols())
    if (protocol->takes_clumps)
      {
        EXPECT_NO_THROW(read_input(file(protocol->kind.name))) << protocol->kind.name;
        ++n_taken;
      }
    else if (!protocol->kind.follows_stages) // which asks for its table first
      {
        EXPECT_TRUE(has(refusal([&] { read_input(file(protocol->kind.name)); }), "takes no clumps; take it out"));
      }
  EXPECT_EQ(n_taken, 4u);
}

TEST(Input, PlacesAJointMapAndReadsItsLayers)
{
  const TemporaryFolder folder;
  folder.write("map.csv",
               "layer,from_x_m,from_y_m,to_x_m,to_y_m\nBedding,12,8,13,8\nfaults,12,8,12,9\nfaults,100,100,101,101\n");
  const std::string map =
    "  set Traces file = map.csv\n  set Traces origin = 11000, 8000 mm\n  set Traces angle = 90 deg\n"
    "  set Traces scale = 0.01\n";
  const auto read = [&](const std::string& entries) {
    return read_input(folder.write("a.prm", "subsection Flaws\n" + entries + "end\n"));
  };
  const auto input = read(map + "  set Smooth layers = bedding: smooth friction 0.4 | Faults: smooth cohesion 1 MPa\n");
  const auto shapes = input.flaws.all();
  ASSERT_EQ(shapes.size(), 3u);
  // One metre to the right of the origin, turned upwards, a hundredth as long.
  const auto& bedding = std::get<ClosedFlaw>(shapes[0]);
  EXPECT_LT((bedding.points[0] - Vector<2>(0.0, 0.01)).norm(), 1e-15);
  EXPECT_LT((bedding.points[1] - Vector<2>(0.0, 0.02)).norm(), 1e-15);
  EXPECT_EQ(bedding.smooth->friction, 0.4);
  EXPECT_EQ(std::get<ClosedFlaw>(shapes[1]).smooth->cohesion, 1e6);
  EXPECT_TRUE(has(input.flaws.left_out, "of 3 traces"));

  const auto refused = [&](const std::string& entries, const std::string& words) {
    EXPECT_TRUE(has(refusal([&] { read(entries); }), words));
  };
  refused(map + "  set Smooth layers = veins: smooth\n", "no trace of the map is on a layer \"veins\"");
  refused(map + "  set Smooth layers = bedding: friction 0.4\n", "friction is of smooth sides; say smooth before it");
  refused(map + "  set Smooth layers = bedding smooth\n", "is no layer with smooth sides; write LAYER: smooth");
  refused("  set Traces scale = 2\n", "is of a joint map; give Traces file too");
  refused("  set Traces file = map.csv\n", "no trace of the map lies in the specimen");
  folder.write("map.csv", "colour,from_x_m,from_y_m,to_x_m,to_y_m\nred,0,0,1,1\n");
  refused("  set Traces file = map.csv\n", "map.csv:1: \"colour\" is no column of a joint map");
}

TEST(Input, ATraceFileThatIsWrongIsNamedWithItsLine)
{
  const TemporaryFolder folder;
  folder.write("traces.csv", "from_x_m,from_y_m,to_x_m,to_y_m\n0.01,0.02,0.03,0.04\n0.01,0.02,0.01,0.02\n");
  EXPECT_TRUE(has(error_in(folder, "a.prm", "subsection Flaws\n  set Traces file = traces.csv\nend\n"),
                  "traces.csv:3: the trace ends where it begins"));
}
} // namespace
} // namespace feldspar
