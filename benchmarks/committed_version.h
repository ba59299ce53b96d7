#pragma once

#include "feldspar_version.h"

#include <fmt/core.h>

#include <cstdlib>
#include <string>

namespace feldspar
{
/// For results that are committed, as scripts/provenance.sh has it for the command: the version of this build. Ends the
/// program, with a line that says why, if that is of a changed work tree or of no commit.
inline std::string committed_version()
{
  if (commit.empty() || version.ends_with(".modified"))
    {
      fmt::print(stderr, "this program ({}) is of no commit: commit, build again, and make the results with that\n",
                 version);
      std::exit(1);
    }
  return std::string(version);
}
} // namespace feldspar
