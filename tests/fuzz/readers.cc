#include "tests/fuzz/readers.h"

#include "app/input/curves/laboratory_curve.h"
#include "app/input/input.h"
#include "app/input/input_entries.h"
#include "app/input/maps/mineral_files.h"
#include "app/input/maps/traces.h"
#include "app/input/strain_path.h"
#include "app/programme/reference_body.h"
#include "base/checksum/seal.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/system/hdf5_archive.h"
#include "base/table/csv.h"
#include "calibration/responses.h"
#include "calibration/unknowns.h"
#include "dem/flaws/apply.h"
#include "dem/genesis/genesis.h"
#include "dem/genesis/packing_file.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "fem/mesh/gmsh_mesh.h"
#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"
#include "results/sample_fields.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <type_traits>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

constexpr std::size_t most_characters_of_message = 2000; // main.cc cuts there

fs::path write(const fs::path& file, const std::string_view content)
{
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string objection_to(const std::string& words)
{
  if (words.empty())
    return "no words";
  if (printable(words) != words)
    return "not one printable line";
  return words.size() > most_characters_of_message ? "too long" : "";
}

void read_any_input(const fs::path& file)
{
  const Input input = read_input(file);
  expected_grains(input.specimen);
  variants(input);
}

/// Reads in both dimensions; what one refuses may be right for the other.
template <typename Read>
void read_in_plane_or_space(const Read& read_as)
{
  try
    {
      read_as(std::integral_constant<int, 2>());
    }
  catch (const InputError&)
    {
      read_as(std::integral_constant<int, 3>());
    }
}

/// A table of minerals as the input has it, or else one of boundaries or points.
void read_mineral_tables(const std::string& content, const fs::path& folder)
{
  const fs::path file = write(folder / "minerals.csv", content);
  try
    {
      read_minerals(file);
    }
  catch (const InputError&)
    {
      if (content.find("mineral_1") != std::string::npos)
        read_mineral_boundaries(file);
      else
        read_mineral_map(file);
    }
}

/// Several files as one text: each begins after a line `@@ NAME`. A file that is not in the text is not in the folder.
void write_files(const std::string& content, const std::vector<std::string>& names, const fs::path& folder)
{
  for (const std::string& name : names)
    {
      const std::string mark = "@@ " + name + "\n";
      const std::size_t at = content.find(mark);
      if (at == std::string::npos)
        {
          fs::remove(folder / name);
          continue;
        }
      const std::size_t begin = at + mark.size();
      const std::size_t end = std::min(content.find("@@ ", begin), content.size());
      write(folder / name, std::string_view(content).substr(begin, end - begin));
    }
}

/// A result folder.
void read_results(const std::string& content, const fs::path& folder)
{
  const fs::path results = folder / "results";
  for (const char* part : {"curves", "grains", "fields"})
    fs::create_directories(results / part);
  write_files(content, {"summary.json", "curves/a.csv", "grains/a.csv", "cracks.csv", "emission.csv", "fields/a.xdmf"},
              results);
  for (const Series& series : read_result_folder(results, test_kinds()))
    for (const std::string& problem : series.problems)
      if (const std::string objection = objection_to(problem); !objection.empty())
        throw std::logic_error("a problem of a result folder is " + objection + ": " + problem);
}

/// The body of other results, without the files beside their summary.
void read_reference_results(const std::string& content, const fs::path& folder)
{
  Input input;
  input.reference_results = write(folder / "summary.json", content).string();
  const auto body = reference_body(input);
  if (const std::string words = as_text(*body); printable(words) != words)
    throw std::logic_error("the words of a reference body are not one printable line: " + words);
}

/// Reads the files that `feldspar calibrate` leaves.
void read_calibration_folder(const std::string& content, const fs::path& folder)
{
  write_files(content, {"calibration.json", "posterior.csv"}, folder);
  read_calibration(folder);
}

/// ROCK.prm of `feldspar calibrate`, beside a reference that is as it should be: its targets and unknowns.
void read_calibrated_rock(const std::string& content, const fs::path& folder)
{
  static const std::string figures =
    R"({"rock": "granite", "experiment": {"label": "laboratory", "tensile_strength_MPa": 10,
    "uniaxial_compressive_strength_MPa": 160, "youngs_modulus_GPa": 60, "poissons_ratio": 0.2,
    "crack_initiation_stress_MPa": 80, "strength_at_5_MPa": 220}})";
  const fs::path reference_file = folder / "reference.json";
  if (!fs::exists(reference_file))
    write(reference_file, figures);
  const Input input = read_input(write(folder / "rock.prm", content));
  const auto possible = calibration::responses(test_cases(input.test_list, input.confinements), input.calibration);
  calibration::targets(possible, read_reference(reference_file, test_kinds()), input.calibration);
  calibration::unknowns(input.calibration);
}

/// Rows of grains in contact, in a box of some 10 x 12 mm, each with a face to its neighbours: a genesis, or more
/// grains, would take most of the time under a sanitizer.
template <int dim>
Specimen<dim> lattice()
{
  constexpr double radius = 1e-3;
  constexpr int n_across = 5;
  constexpr int n_up = 6;
  std::string lines;
  for (int up = 0; up < n_up; ++up)
    for (int deep = 0; deep < (dim == 3 ? n_across : 1); ++deep)
      for (int across = 0; across < n_across; ++across)
        {
          lines += std::to_string((2 * across + 1) * radius) + " ";
          if (dim == 3)
            lines += std::to_string((2 * deep + 1) * radius) + " ";
          lines += std::to_string((2 * up + 1) * radius) + " " + std::to_string(radius) + "\n";
        }
  const TemporaryFolder folder;
  SpecimenParameters wanted;
  wanted.dimension = dim;
  wanted.width = 2 * n_across * radius;
  wanted.height = 2 * n_up * radius;
  wanted.packing_file = folder.write("packing.txt", lines).string();
  FlatJointParameters flat_joint;
  flat_joint.installation_gap_ratio = 0.05;
  return make_specimen<dim>(wanted, flat_joint, {}, 1);
}

void put_into_small_specimen(const std::vector<Shape>& shapes)
{
  static const Specimen<2> plane = lattice<2>();
  static const Specimen<3> space = lattice<3>();
  read_in_plane_or_space([&](const auto dim) {
    auto specimen = [&] {
      if constexpr (dim() == 2)
        return plane;
      else
        return space;
    }();
    if (const std::string why = objection<dim()>(shapes, specimen.size); !why.empty())
      throw InputError(why);
    put_in_flaws(specimen, shapes);
  });
}

/// A table that an entry names.
Input read_input_with(const std::string& section, const std::string& entry, const std::string& content,
                      const fs::path& folder)
{
  const fs::path input = folder / "input.prm";
  if (!fs::exists(input))
    write(input, "subsection " + section + "\n  set " + entry + " = table.csv\nend\n");
  write(folder / "table.csv", content);
  return read_input(input);
}

/// A content as numbers, one after the other; zeros when it is used up.
class Numbers
{
public:
  explicit Numbers(const std::string& of)
    : content(of)
  {
  }

  bool is_used_up() const { return at >= content.size(); }

  template <typename Number>
  Number next()
  {
    Number number{};
    for (std::size_t k = 0; k < sizeof(Number); ++k, ++at)
      reinterpret_cast<unsigned char*>(&number)[k] = at < content.size() ? static_cast<unsigned char>(content[at]) : 0;
    return number;
  }

private:
  const std::string& content;
  std::size_t at = 0;
};

/// A specimen that is whole as a file but wrong in some of its numbers, which the content names: field, place, value. The
/// seal, which any change of the bytes would break, is right.
void read_changed_specimen(const std::string& content, const fs::path& folder)
{
  static const Specimen<2> whole = lattice<2>();
  Specimen<2> changed = whole;
  Numbers numbers(content);
  for (int n = 0; n < 16 && !numbers.is_used_up(); ++n)
    {
      const auto field = numbers.next<std::uint8_t>();
      const auto place = numbers.next<std::uint16_t>();
      const auto value = numbers.next<double>();
      int k = 0;
      const auto change = [&](auto& of) {
        if (k++ == field)
          of = static_cast<std::remove_reference_t<decltype(of)>>(value);
      };
      const auto change_count = [&](auto& of) {
        if (k++ == field)
          of = static_cast<std::remove_reference_t<decltype(of)>>(std::bit_cast<std::uint64_t>(value));
      };
      const auto change_one = [&](auto& values) {
        if (k++ == field)
          values[place % values.size()] = value;
      };
      const auto change_one_count = [&](auto& values) {
        if (k++ == field && !values.empty())
          values[place % values.size()] = std::uint32_t(std::bit_cast<std::uint64_t>(value));
      };
      change(changed.size[0]);
      change(changed.size[1]);
      change(changed.thickness);
      change(changed.bulk_density);
      change(changed.particle_contact.modulus);
      change(changed.particle_contact.stiffness_ratio);
      change(changed.particle_contact.friction);
      change(changed.report.mean_radius);
      change_count(changed.report.n_grains);
      change_count(changed.report.n_joints);
      for (int c = 0; c < 2; ++c)
        change_one(changed.grains.position[c]);
      change_one(changed.grains.radius);
      change_one(changed.grains.mass);
      change_one(changed.grains.moment_of_inertia);
      change_one_count(changed.joints.grain_1);
      change_one_count(changed.joints.grain_2);
      change_one_count(changed.joints.number);
      change_one_count(changed.joints.division);
      const auto visit = [&](const std::string&, auto& values) { change_one(values); };
      changed.joints.visit_per_joint(visit);
      changed.joints.visit_per_segment(visit);
    }
  const fs::path file = folder / "specimen.h5";
  write_specimen(changed, file);
  // Whoever is let in must be fit to be tested.
  Dynamics<2> dynamics(read_specimen<2>(file), {}, ZeroForce::as_placed);
  for (int n = 0; n < 3; ++n)
    dynamics.step();
}

/// A file of which the content changes bytes: place, what to add to it.
std::string changed_by(const std::string& content, std::string file)
{
  Numbers numbers(content);
  for (int n = 0; n < 64 && !numbers.is_used_up(); ++n)
    {
      char& byte = file[numbers.next<std::uint32_t>() % file.size()];
      byte = char(byte + numbers.next<char>());
    }
  return file;
}

/// A changed specimen as another program leaves it, without a seal that shows the change.
void read_changed_foreign_specimen(const std::string& content, const fs::path& folder)
{
  const fs::path file = folder / "foreign.h5";
  static const std::string whole = [&] {
    write_specimen(lattice<2>(), file);
    std::string unsealed = tests::content(file);
    unsealed.resize(unsealed.size() - seal_of("").size());
    const std::string another(seal_notice.size(), 'a');
    for (std::size_t at = 0; (at = unsealed.find(seal_notice, at)) != std::string::npos;)
      unsealed.replace(at, seal_notice.size(), another);
    return unsealed;
  }();
  read_specimen<2>(write(file, changed_by(content, whole)));
}

/// The index of fields beside the file that it names.
void read_fields(const std::string& content, const fs::path& folder)
{
  const fs::path file = folder / "a.h5";
  if (!fs::exists(file))
    write_hdf5(file, [](Hdf5Writer& root) {
      std::vector<double> nodes{0, 0, 1, 0, 1, 1, 0, 1};
      std::vector<double> displacement(12, 0.5);
      std::vector<std::uint32_t> cells{0, 1, 2, 3};
      root.array("nodes", nodes, 2);
      root.array("cells", cells, 4);
      root.array("displacement", displacement, 3);
    });
  write(folder / "a.xdmf", content);
  read_sample_fields(folder, "a");
}

/// Every change of a checkpoint must be seen.
void read_changed_checkpoint(const std::string& content, const fs::path& folder)
{
  static const Specimen<2> specimen = lattice<2>();
  static LabTest<2> test({uniaxial_compression}, specimen, {}, {});
  const fs::path file = folder / "checkpoint.h5";
  const auto written = [&] {
    LabTest<2> begun({uniaxial_compression}, specimen, {}, {});
    begun.advance();
    begun.write_checkpoint(file, "this one");
    return tests::content(file);
  };
  static const std::string whole = written();
  const std::string changed = changed_by(content, whole);
  test.read_checkpoint(write(file, changed), "this one");
  if (changed != whole)
    throw std::logic_error("damage to a checkpoint was not seen");
}
} // namespace

const std::vector<FuzzedReader>& fuzzed_readers()
{
  using Content = const std::string&;
  using Folder = const fs::path&;
  static const std::vector<FuzzedReader> readers{
    {"prm", [](Content content, Folder folder) { read_any_input(write(folder / "input.prm", content)); }},
    {"json", [](Content content, Folder folder) { read_any_input(write(folder / "input.json", content)); }},
    {"reference",
     [](Content content, Folder folder) { read_reference(write(folder / "r.json", content), test_kinds()); }},
    {"table", [](Content content, Folder folder) { read_csv(write(folder / "t.csv", content), "normal_m,shear_m"); }},
    {"curve",
     [](Content content, Folder folder) {
       const fs::path file = write(folder / "c.csv", content);
       read_laboratory_curves({{file, CylinderSize{0.05, 0.1}}});
     }},
    {"catalogue", [](Content content, Folder folder) { read_emission_catalogue(write(folder / "e.csv", content)); }},
    {"path",
     [](Content content, Folder folder) {
       StrainPathParameters path;
       path.path_file = write(folder / "p.csv", content).string();
       read_in_plane_or_space([&](const auto dim) { path_legs<dim()>(path); });
     }},
    {"packing",
     [](Content content, Folder folder) {
       SpecimenParameters wanted;
       wanted.packing_file = write(folder / "packing.txt", content).string();
       read_in_plane_or_space([&](const auto dim) { read_packing<dim()>(wanted); });
       wanted.shape = BodyShape::periodic;
       read_in_plane_or_space([&](const auto dim) { read_packing<dim()>(wanted); });
     }},
    {"mesh",
     [](Content content, Folder folder) {
       const fs::path file = write(folder / "mesh.msh", content);
       try
         {
           fem::read_gmsh_mesh(file, 2);
         }
       catch (const InputError&)
         {
           fem::read_gmsh_mesh(file, 3);
         }
     }},
    {"traces",
     [](Content content, Folder folder) {
       put_into_small_specimen(read_input_with("Flaws", "Traces file", content, folder).flaws.all());
     }},
    {"drawing", [](Content content,
                   Folder folder) { put_into_small_specimen(read_traces(write(folder / "map.dxf", content)).shapes); }},
    {"minerals", read_mineral_tables},
    {"picture", [](Content content, Folder folder) { read_mineral_map(write(folder / "map.png", content)); }},
    {"shapes", [](Content content, Folder) { put_into_small_specimen(parse_shapes(content)); }},
    {"variants",
     [](Content content, Folder folder) { variants(read_input_with("Variants", "Table", content, folder)); }},
    {"rock", read_calibrated_rock},
    {"calibration", read_calibration_folder},
    {"reference_results", read_reference_results},
    {"results", read_results},
    {"fields", read_fields},
    {"foreign", read_changed_foreign_specimen},
    {"specimen", read_changed_specimen},
    {"checkpoint", read_changed_checkpoint}};
  return readers;
}

Reading read(const FuzzedReader& reader, const std::string& content, const fs::path& folder)
{
  try
    {
      reader.read(content, folder);
    }
  catch (const InputError& error)
    {
      return {false, error.what(), objection_to(error.what())};
    }
  return {true, "", ""};
}
} // namespace feldspar::tests
