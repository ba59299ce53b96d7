#pragma once

#include "app/run/run.h"

#include <filesystem>
#include <optional>
#include <string>
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

/// Returns the output of `feldspar contact`: the response of the joint to its path, as CSV. Throws InputError.
std::string contact_response(const Input& input, const std::filesystem::path& input_file);

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
  std::string check_for;             ///< the command that the input is checked for; empty: all
  std::vector<std::string> settings; ///< of the input to be checked, as CommonOptions has them
  bool results = false;              ///< the quantities of results instead of the entries of the input
  bool markdown = false;
};

int run_parameters(const ParametersOptions& options);
} // namespace feldspar
