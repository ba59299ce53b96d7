#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The subcommands. Each returns the exit code; a user's mistake comes as InputError.
namespace feldspar
{
namespace exit_code
{
inline constexpr int internal_error = 1;
inline constexpr int user_error = 2;
inline constexpr int output_error = 3;  // a full disk
inline constexpr int interrupted = 130; // 128 + SIGINT, as shells have it
} // namespace exit_code

/// What `lab`, `rve`, `multiscale`, `specimen` and `contact` have in common on the command line.
struct CommonOptions
{
  std::filesystem::path input;
  std::optional<std::filesystem::path> resume; ///< of `lab`, `rve`, `multiscale`: the folder of a run to be taken up
  std::optional<std::string> extract;          ///< of `multiscale`: CELL:POINT; the input is the folder of a run
  std::optional<std::filesystem::path> output;
  bool force = false;
  bool quiet = false;
};

int run_lab(const CommonOptions& options);

int run_rve(const CommonOptions& options);

int run_multiscale(const CommonOptions& options);

int run_specimen(const CommonOptions& options);

int run_contact(const CommonOptions& options);

struct ReportOptions
{
  std::vector<std::filesystem::path> result_folders;
  std::vector<std::filesystem::path> curves; ///< measured in a laboratory
  std::optional<std::filesystem::path> reference;
  std::optional<std::filesystem::path> output;
  bool force = false;
  bool quiet = false;
};

int run_report(const ReportOptions& options);

struct ParametersOptions
{
  std::string section; ///< empty: all
  std::optional<std::filesystem::path> check;
  bool markdown = false;
};

int run_parameters(const ParametersOptions& options);
} // namespace feldspar
