#pragma once

#include "app/input/input.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// Figures that came out of one piece of work; none where a test has not given its own. They are kept in calibration/NAME.json of
/// a run's folder.
class KeptValues
{
public:
  using Values = std::vector<std::optional<double>>;

  KeptValues(const std::filesystem::path& folder, const std::string& name, const Input& rock);

  /// n values, if the file is there and was written under the identity of this rock (run_identity()). Else the work is to be
  /// done again. Throws InputError for a file that was changed since: its seal (base/checksum/seal.h) tells.
  std::optional<Values> read(std::size_t n) const;

  /// All or nothing, to the last bit, with a seal.
  void write(const Values& values) const;

private:
  std::filesystem::path file;
  std::string identity;
};
} // namespace feldspar::calibration
