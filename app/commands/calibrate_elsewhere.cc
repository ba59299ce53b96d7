#include "app/commands/commands.h"
#include "app/run/other_program.h"

namespace feldspar
{
int run_calibrate(const CommonOptions& /*options*/) { go_on_as("feldspar-calibrate"); }
} // namespace feldspar
