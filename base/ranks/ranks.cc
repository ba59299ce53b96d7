#include "base/ranks/ranks.h"

#include "base/input_error.h"
#include "base/ranks/communicator.h"
#include "base/whole_file.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <stdexcept>
#include <system_error>

namespace feldspar::ranks
{
namespace
{
// Collective calls are of the process as a whole, as its standard output is.
MPI_Comm of_group = MPI_COMM_NULL, of_machine = MPI_COMM_NULL;

bool is_alone() { return of_group == MPI_COMM_NULL; }

/// Size or rank in a group, by MPI; `alone` without one.
int asked(int (*const of)(MPI_Comm, int*), const MPI_Comm& group, int alone)
{
  if (!is_alone())
    of(group, &alone);
  return alone;
}

int all(const int here, const MPI_Op operation)
{
  int result = here;
  MPI_Allreduce(&here, &result, 1, MPI_INT, operation, of_group);
  return result;
}
} // namespace

Group::Group(const MPI_Comm communicator, const MPI_Comm on_this_machine)
{
  of_group = communicator;
  of_machine = on_this_machine == MPI_COMM_NULL ? communicator : on_this_machine;
}
Group::~Group() { of_group = of_machine = MPI_COMM_NULL; }

MPI_Comm communicator() { return of_group; }

unsigned int number() { return unsigned(asked(MPI_Comm_size, of_group, 1)); }

unsigned int mine() { return unsigned(asked(MPI_Comm_rank, of_group, 0)); }

unsigned int number_on_this_machine() { return unsigned(asked(MPI_Comm_size, of_machine, 1)); }

bool any(const bool here) { return is_alone() ? here : all(here, MPI_MAX) != 0; }

std::uint64_t sum(const std::uint64_t here)
{
  std::uint64_t result = here;
  if (!is_alone())
    MPI_Allreduce(&here, &result, 1, MPI_UINT64_T, MPI_SUM, of_group);
  return result;
}

std::vector<double> sums(const std::vector<double>& here)
{
  if (is_alone())
    return here;
  std::vector<double> result(here.size());
  MPI_Allreduce(here.data(), result.data(), int(here.size()), MPI_DOUBLE, MPI_SUM, of_group);
  return result;
}

namespace
{
constexpr std::size_t most_at_once = std::size_t(1) << 30; // MPI counts with int

std::string of_rank(const unsigned int rank, std::string text)
{
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, int(rank), of_group);
  text.resize(size);
  for (std::size_t begin = 0; begin < size; begin += most_at_once)
    MPI_Bcast(text.data() + begin, int(std::min(most_at_once, size - begin)), MPI_BYTE, int(rank), of_group);
  return text;
}

/// Gathers the bytes of all ranks on the first; nothing on others.
template <typename Bytes>
Bytes gathered_on_first(const std::span<const typename Bytes::value_type> own)
{
  const unsigned int n = number();
  if (n == 1)
    return {own.begin(), own.end()};
  std::vector<std::uint64_t> sizes(n);
  const std::uint64_t size = own.size();
  MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, 0, of_group);
  // One message a rank, of those that have anything to say: MPI_Gatherv would count all bytes with int.
  constexpr int tag = 1;
  if (!is_first())
    {
      for (std::size_t begin = 0; begin < size; begin += most_at_once)
        MPI_Send(own.data() + begin, int(std::min(most_at_once, size - begin)), MPI_BYTE, 0, tag, of_group);
      return {};
    }
  Bytes all;
  all.reserve(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0)));
  all.assign(own.begin(), own.end());
  for (unsigned int rank = 1; rank < n; ++rank)
    for (std::size_t left = sizes[rank]; left > 0;)
      {
        const std::size_t part = std::min(most_at_once, left);
        all.resize(all.size() + part);
        MPI_Recv(all.data() + (all.size() - part), int(part), MPI_BYTE, int(rank), tag, of_group, MPI_STATUS_IGNORE);
        left -= part;
      }
  return all;
}
} // namespace

std::string of_first(const std::string& text) { return number() == 1 ? text : of_rank(0, text); }

std::string gathered(const std::string& text) { return gathered_on_first<std::string>(text); }

std::vector<std::byte> gathered_by_first(const std::span<const std::byte> own)
{
  return gathered_on_first<std::vector<std::byte>>(own);
}

std::vector<std::byte> gathered_by_all(const std::span<const std::byte> own, std::vector<std::size_t>& sizes)
{
  const std::size_t n = number(), size = own.size();
  const bool are_known = !sizes.empty();
  sizes.resize(n, size);
  if (n == 1)
    return {own.begin(), own.end()};
  if (!are_known)
    MPI_Allgather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, of_group);
  std::vector<std::size_t> first(n + 1, 0);
  std::partial_sum(sizes.begin(), sizes.end(), first.begin() + 1);
  std::vector<std::byte> all(first.back());
  const std::size_t most = most_at_once / n, longest = *std::ranges::max_element(sizes);
  std::vector<int> counts(n), places(n);
  for (std::size_t begin = 0; begin < longest; begin += most) // in rounds, of a part of each
    {
      for (std::size_t r = 0; r < n; ++r)
        counts[r] = int(std::min(most, sizes[r] - std::min(sizes[r], begin)));
      std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
      std::vector<std::byte> round(longest > most ? std::size_t(places.back() + counts.back()) : 0);
      std::byte* const to = longest > most ? round.data() : all.data();
      MPI_Allgatherv(own.data() + std::min(size, begin), counts[mine()], MPI_BYTE, to, counts.data(), places.data(),
                     MPI_BYTE, of_group);
      for (std::size_t r = 0; r < n && longest > most; ++r)
        std::copy_n(to + places[r], counts[r], all.data() + first[r] + std::min(sizes[r], begin));
    }
  return all;
}

void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
              std::vector<double>& received, const std::vector<std::size_t>& first_received)
{
  constexpr int tag = 2;
  std::vector<MPI_Request> requests;
  requests.reserve(2 * number());
  const auto with_each = [&](const std::vector<std::size_t>& first, const auto& begin) {
    for (unsigned int r = 0; r < number(); ++r)
      if (const std::size_t n = first[r + 1] - first[r]; n > 0)
        begin(first[r], int(n), int(r), &requests.emplace_back());
  };
  with_each(first_received, [&](const std::size_t at, const int n, const int from, MPI_Request* const request) {
    MPI_Irecv(received.data() + at, n, MPI_DOUBLE, from, tag, of_group, request);
  });
  with_each(first_sent, [&](const std::size_t at, const int n, const int to, MPI_Request* const request) {
    MPI_Isend(sent.data() + at, n, MPI_DOUBLE, to, tag, of_group, request);
  });
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
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
  try
    {
      work();
    }
  catch (const std::exception& error)
    {
      outcome = dynamic_cast<const InputError*>(&error)          ? input_error
                : dynamic_cast<const OutputError*>(&error)       ? output_error
                : dynamic_cast<const std::system_error*>(&error) ? output_error
                                                                 : other;
      what = error.what();
      alone = std::current_exception();
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
  MPI_Bcast(&its_outcome, 1, MPI_INT, int(first_that_failed), of_group);
  what = of_rank(first_that_failed, what);
  if (its_outcome == input_error)
    throw InputError(what);
  if (its_outcome == output_error)
    throw OutputError(what);
  throw std::runtime_error(what);
}

void in_turn(const std::function<void()>& work)
{
  together([&] {
    const int own_turn = asked(MPI_Comm_rank, of_machine, 0);
    std::exception_ptr failure;
    for (int turn = 0, n = int(number_on_this_machine()); turn < n; ++turn)
      {
        if (turn == own_turn)
          try
            {
              work();
            }
          catch (...)
            {
              failure = std::current_exception();
            }
        if (!is_alone())
          MPI_Barrier(of_machine);
      }
    if (failure)
      std::rethrow_exception(failure);
  });
}

void first(const std::function<void()>& work)
{
  together([&] {
    if (is_first())
      work();
  });
}
} // namespace feldspar::ranks
