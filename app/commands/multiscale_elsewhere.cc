#include "app/commands/commands.h"
#include "app/run/other_program.h"

namespace feldspar
{
int run_multiscale(const CommonOptions& /*options*/) { go_on_as("feldspar-multiscale"); }

void check_input(const std::filesystem::path& /*file*/, const std::vector<std::string>& /*settings*/,
                 const std::string& /*command*/)
{
  go_on_as("feldspar-multiscale"); // the input may be of a sample, with a mesh
}
} // namespace feldspar
