#include "app/run/launched.h"

#include "app/processes/mpi_session.h"
#include "base/ranks/ranks.h"
#include "runs/share_out.h"

namespace feldspar
{
namespace
{
RunEnd go(const Run& run, const SharedRun& shared)
{
  Progress progress(run.quiet || !ranks::is_first());
  if (ranks::number() == 1)
    return shared.go_alone(run, progress);
  shared.share_out(run, progress);
  RunEnd end{};
  together_or_interrupted([&] {
    if (ranks::is_first())
      end = shared.go_alone(run, progress);
  });
  end.was_interrupted = ranks::any(end.was_interrupted);
  return end;
}
} // namespace

Processes all_processes() { return {ranks::is_first(), ranks::first, ranks::of_first}; }

int run_shared(const std::string& name,
               const std::function<void(const Input&, const std::filesystem::path& input_file)>& check,
               const SharedRun& plane, const SharedRun& space, const CommonOptions& options)
{
  const auto program = [&] {
    const auto by_dimension = [&](const Run& run) {
      return go(run, run.input.specimen.dimension == 2 ? plane : space);
    };
    return run_command({name, check, by_dimension, all_processes()}, options);
  };
  return is_launched() ? with_mpi(program) : program();
}
} // namespace feldspar
