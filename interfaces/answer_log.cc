#include "interfaces/answer_log.h"

#include <feldspar/feldspar.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace feldspar::interfaces
{
namespace
{
struct Head
{
  char mark[8];
  std::uint64_t identity;
};

constexpr char mark[8] = {'f', 'e', 'l', 'd', 's', 'p', 'a', 'r'};

std::uint64_t key_of(const PointName name) { return (std::uint64_t(name.element) << 32U) | name.point; }

} // namespace

// Both may be sums of the same strains by other ways.
bool is_same_strain(const std::span<const double> one, const std::span<const double> other)
{
  constexpr double round_off = 1e-13;
  if (other.size() < one.size())
    return false;
  double largest = 0.0;
  double apart = 0.0;
  for (std::size_t c = 0; c < one.size(); ++c)
    {
      largest = std::max(largest, std::abs(one[c]));
      apart = std::max(apart, std::abs(one[c] - other[c]));
    }
  return apart <= round_off * largest;
}

AnswerLog::AnswerLog(std::string its_file, const std::uint64_t identity, const bool goes_on)
  : file(std::move(its_file))
  , descriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | (goes_on ? 0 : O_TRUNC), 0644))
{
  Head head{};
  std::memcpy(head.mark, mark, sizeof mark);
  head.identity = identity;
  struct stat about
  {
  };
  if (descriptor < 0 || fstat(descriptor, &about) != 0)
    throw Error(file + ": cannot be written; it keeps what a restart needs");
  if (about.st_size == 0)
    {
      if (goes_on)
        throw Error(file +
                    ": is missing; a restarted job needs the file .feldspar of the job that it goes on with, under "
                    "its own name");
      if (pwrite(descriptor, &head, sizeof head, 0) != ssize_t(sizeof head))
        throw Error(file + ": cannot be written; it keeps what a restart needs");
      return;
    }
  Head found{};
  if (pread(descriptor, &found, sizeof found, 0) != ssize_t(sizeof found) ||
      std::memcmp(&found, &head, sizeof head) != 0)
    throw Error(file + ": is of another input, mode or version of Feldspar than this job");
  n_records = (std::uint64_t(about.st_size) - sizeof head) / sizeof(AnswerRecord);
  for (std::uint64_t token = 1; token <= n_records; ++token)
    earlier[key_of((*this)[token].name)].push_back(token);
}

AnswerLog::~AnswerLog() { close(descriptor); }

std::uint64_t AnswerLog::add(const AnswerRecord& record)
{
  const std::uint64_t before = n_records++;
  if (pwrite(descriptor, &record, sizeof record, off_t(sizeof(Head) + before * sizeof record)) !=
      ssize_t(sizeof record))
    throw Error(file + ": cannot be written: no space is left, or the folder is gone");
  return before + 1;
}

AnswerRecord AnswerLog::operator[](const std::uint64_t token) const
{
  AnswerRecord record{};
  if (token == 0 || token > n_records ||
      pread(descriptor, &record, sizeof record, off_t(sizeof(Head) + (token - 1) * sizeof record)) !=
        ssize_t(sizeof record))
    throw Error(file + ": has no answer " + std::to_string(token) + "; the job uses a state that was never handed out");
  return record;
}

std::vector<std::uint64_t> AnswerLog::way_to(std::uint64_t token) const
{
  std::vector<std::uint64_t> way;
  for (; token != 0; token = (*this)[token].parent)
    way.push_back(token);
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<std::uint64_t> AnswerLog::way_to(const PointName name, const std::span<const double> strain) const
{
  if (const auto known = earlier.find(key_of(name)); known != earlier.end())
    for (auto token = known->second.rbegin(); token != known->second.rend(); ++token)
      if (is_same_strain(strain, (*this)[*token].strain))
        return way_to(*token);
  throw Error(file + ": has no strain from which element " + std::to_string(name.element) + ", point " +
              std::to_string(name.point) + " goes on; it is of another job than the restart file");
}
} // namespace feldspar::interfaces
