#pragma once

#include "app/run/run.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The subcommands. Each returns the exit code; a user's mistake comes as InputError.
namespace feldspar
{
int run_lab(const CommonOptions& options);

int run_rve(const CommonOptions& options);

int run_multiscale(const CommonOptions& options);

int run_calibrate(const CommonOptions& options);

int run_specimen(const CommonOptions& options);

int run_contact(const CommonOptions& options);

/// A subcommand that reads an input file.
struct CommandWithInput
{
  std::string_view name;
  std::string_view description;
  int (*run)(const CommonOptions&);
  bool runs_long; ///< and can be resumed
  bool tests_rock;
  std::string_view examples; ///< for its help
};

/// All of them: a new one is a line here, its check in check_input.cc and a file of its own.
inline constexpr std::array commands_with_input{
  CommandWithInput{"lab", "DEM laboratory tests: genesis, tests, results, report", run_lab, true, true,
                   "feldspar lab granite.prm --output granite --threads 4\n"
                   "  feldspar lab granite.prm --set 'Seeds/Seeds = 1..10'\n"
                   "  feldspar lab --resume granite"},
  CommandWithInput{"rve", "a periodic cell of grains along a path of strain or stress", run_rve, true, true,
                   "feldspar rve cell.prm"},
  CommandWithInput{"multiscale", "laboratory tests on a mesh with a representative volume at every point",
                   run_multiscale, true, true,
                   "feldspar multiscale sample.prm\n  mpirun -np 8 feldspar multiscale sample.prm\n"
                   "  feldspar multiscale sample-results-001 --extract 12:0"},
  CommandWithInput{"calibrate", "micro-parameters of a rock from its laboratory values", run_calibrate, true, true,
                   "feldspar calibrate rock.prm --output rock\n  feldspar lab rock/best.prm\n"
                   "  feldspar calibrate --resume rock"},
  CommandWithInput{"specimen", "genesis only; writes specimen.h5", run_specimen, false, false,
                   "feldspar specimen granite.prm\n"
                   "  feldspar specimen granite.prm --packing yade --packing lammps"},
  CommandWithInput{"contact", "one contact along a displacement path; writes contact.csv", run_contact, false, true,
                   "feldspar contact contact.prm"}};

/// `feldspar parameters --check INPUT`: whether a command would take the input, by the checks that it makes itself before
/// any work. Without a command says of all of them which do, and throws InputError where none that tests rock does.
void check_input(const std::filesystem::path& file, const std::vector<std::string>& settings,
                 const std::string& command);

/// `feldspar multiscale --extract CELL:POINT`: of every test in the folder of a run the RVE at that point, in the state
/// of the last row that was kept. FOLDER/extracted/TEST_cell_C_point_P.h5 is what `feldspar rve` takes as Specimen file,
/// and .xdmf beside it what ParaView shows, in the axes of the sample. Returns the exit code; throws InputError.
int extract_rve(const std::filesystem::path& folder, const std::string& cell_and_point, bool quiet);

/// Returns the output of `feldspar contact`: the response of the joint to its path, as CSV. Throws InputError.
std::string contact_response(const Input& input, const std::filesystem::path& input_file);

struct ReportOptions
{
  std::vector<std::filesystem::path> result_folders;
  std::vector<std::filesystem::path> curves;     ///< measured in a laboratory
  std::vector<std::string> curve_sizes;          ///< of their specimens; one for all, or one for each
  std::vector<std::string> curve_tests;          ///< names of tests; the same
  std::vector<std::filesystem::path> catalogues; ///< of acoustic emission, recorded in a laboratory
  std::optional<std::string> quakeml;            ///< origin of the axes on earth, for events as QuakeML
  std::optional<std::filesystem::path> reference;
  std::optional<std::filesystem::path> output;
  bool film = false;
  bool force = false;
  bool quiet = false;
};

int run_report(const ReportOptions& options);

struct ParametersOptions
{
  std::string section; ///< empty: all
  std::optional<std::filesystem::path> check;
  std::string check_for;             ///< the command that the input is checked for; empty: all
  std::vector<std::string> settings; ///< of the input to be checked, as CommonOptions has them
  bool results = false;              ///< the quantities of results instead of the entries of the input
  bool markdown = false;
};

struct NewOptions
{
  std::string name; ///< of the template
  std::optional<std::filesystem::path> output;
};

/// `feldspar new NAME`: writes NAME.prm and NAME-reference.json, which did not exist. Throws InputError.
int run_new(const NewOptions& options);

std::vector<std::string> names_of_templates();

int run_parameters(const ParametersOptions& options);

/// Prints docs/results.md: the quantities of tests, the properties that a reference may give and the columns of curves,
/// from the tables that results, comparisons and readers use.
void print_results_reference();
} // namespace feldspar
