#include "coupling/sample/ranks.h"

#include "base/input_error.h"
#include "base/whole_file.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <numeric>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace feldspar::ranks
{
namespace
{
bool mpi_is_up()
{
  int has_come = 0, has_gone = 0;
  MPI_Initialized(&has_come);
  MPI_Finalized(&has_gone);
  return has_come != 0 && has_gone == 0;
}

int all(const int here, const MPI_Op operation)
{
  int result = here;
  MPI_Allreduce(&here, &result, 1, MPI_INT, operation, MPI_COMM_WORLD);
  return result;
}
} // namespace

unsigned int number()
{
  int n = 1;
  if (mpi_is_up())
    MPI_Comm_size(MPI_COMM_WORLD, &n);
  return unsigned(n);
}

unsigned int mine()
{
  int rank = 0;
  if (mpi_is_up())
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return unsigned(rank);
}

bool any(const bool here) { return mpi_is_up() ? all(here, MPI_MAX) != 0 : here; }

std::uint64_t sum(const std::uint64_t here)
{
  std::uint64_t result = here;
  MPI_Allreduce(&here, &result, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return result;
}

std::vector<double> sums(const std::vector<double>& here)
{
  std::vector<double> result(here.size());
  MPI_Allreduce(here.data(), result.data(), int(here.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return result;
}

namespace
{
constexpr std::size_t most_at_once = std::size_t(1) << 30; // MPI counts with int

std::string of_rank(const unsigned int rank, std::string text)
{
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, int(rank), MPI_COMM_WORLD);
  text.resize(size);
  for (std::size_t begin = 0; begin < size; begin += most_at_once)
    MPI_Bcast(text.data() + begin, int(std::min(most_at_once, size - begin)), MPI_BYTE, int(rank), MPI_COMM_WORLD);
  return text;
}
} // namespace

std::string of_first(const std::string& text) { return number() == 1 ? text : of_rank(0, text); }

std::string gathered(const std::string& text)
{
  const unsigned int n = number();
  std::vector<std::uint64_t> sizes(n);
  const std::uint64_t size = text.size();
  MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  // One message a rank, of those that have anything to say: MPI_Gatherv would count all bytes with int.
  constexpr int tag = 1;
  if (!is_first())
    {
      for (std::size_t begin = 0; begin < size; begin += most_at_once)
        MPI_Send(text.data() + begin, int(std::min(most_at_once, size - begin)), MPI_BYTE, 0, tag, MPI_COMM_WORLD);
      return {};
    }
  std::string all = text;
  all.reserve(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0)));
  for (unsigned int rank = 1; rank < n; ++rank)
    for (std::size_t left = sizes[rank]; left > 0;)
      {
        const std::size_t part = std::min(most_at_once, left);
        all.resize(all.size() + part);
        MPI_Recv(all.data() + (all.size() - part), int(part), MPI_BYTE, int(rank), tag, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        left -= part;
      }
  return all;
}

void together(const std::function<void()>& work)
{
  enum Outcome : int
  {
    done,
    input_error,
    output_error,
    other
  };
  Outcome outcome = done;
  std::string what;
  std::exception_ptr alone;
  const auto note = [&](const Outcome of, const std::string& text) {
    outcome = of;
    what = text;
    alone = std::current_exception();
  };
  try
    {
      work();
    }
  catch (const InputError& error)
    {
      note(input_error, error.what());
    }
  catch (const OutputError& error)
    {
      note(output_error, error.what());
    }
  catch (const std::system_error& error)
    {
      note(output_error, error.what());
    }
  catch (const std::exception& error)
    {
      note(other, error.what());
    }
  if (number() == 1)
    {
      if (alone)
        std::rethrow_exception(alone);
      return;
    }
  const unsigned int first_that_failed = unsigned(all(int(outcome == done ? number() : mine()), MPI_MIN));
  if (first_that_failed == number())
    return;
  int its_outcome = outcome;
  MPI_Bcast(&its_outcome, 1, MPI_INT, int(first_that_failed), MPI_COMM_WORLD);
  what = of_rank(first_that_failed, what);
  if (its_outcome == input_error)
    throw InputError(what);
  if (its_outcome == output_error)
    throw OutputError(what);
  throw std::runtime_error(what);
}

void first(const std::function<void()>& work)
{
  together([&] {
    if (is_first())
      work();
  });
}

namespace
{
/// Returns whether every rank calls this within some seconds. The communicator is of no other use: others may be
/// waiting in another collective call.
bool all_are_here(const MPI_Comm communicator)
{
  using namespace std::chrono_literals;
  MPI_Request request;
  MPI_Ibarrier(communicator, &request);
  const auto end = std::chrono::steady_clock::now() + 10s;
  int done = 0;
  while (done == 0 && std::chrono::steady_clock::now() < end)
    {
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      std::this_thread::sleep_for(10ms);
    }
  return done != 0;
}
} // namespace

int guarded(const std::function<int()>& program)
{
  if (number() == 1)
    return program();
  MPI_Comm of_failures;
  MPI_Comm_dup(MPI_COMM_WORLD, &of_failures);
  try
    {
      const int exit_code = program();
      MPI_Comm_free(&of_failures);
      return is_first() ? exit_code : 0;
    }
  catch (const std::exception& error)
    {
      if (!all_are_here(of_failures))
        {
          std::fputs(
            fmt::format("feldspar: process {} of {} failed and ends all: {}\n", mine(), number(), error.what()).c_str(),
            stderr);
          std::fflush(stderr);
          constexpr int failed = 1;
          MPI_Abort(MPI_COMM_WORLD, failed);
        }
      MPI_Comm_free(&of_failures);
      if (!is_first())
        return 0;
      throw;
    }
}
} // namespace feldspar::ranks
