#include "interfaces/answer_log.h"

#include <feldspar/feldspar.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace feldspar::interfaces
{
namespace
{
constexpr double mark[6] = {70.0, 69.0, 76.0, 68.0, 83.0, 80.0}; // FELDSP
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

AnswerLog::AnswerLog(std::string its_file, const std::uint64_t identity, const bool is_needed)
  : file(std::move(its_file))
  , descriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644))
  , pieces(most_pieces)
{
  AnswerRecord head{{}, identity, {}};
  std::copy(std::begin(mark), std::end(mark), head.strain);
  AnswerRecord found{};
  const bool is_there = pread(descriptor, &found, sizeof found, 0) > 0;
  const bool is_own = std::memcmp(&found, &head, sizeof head) == 0;
  if (is_needed && !is_there)
    throw Error(file +
                ": is missing; a restarted job needs the file .feldspar of the job that it goes on with, under its own "
                "name");
  if (is_needed && !is_own)
    throw Error(file + ": is of another input, mode or version of Feldspar than this job");
  struct stat about = {};
  if ((!is_own && ftruncate(descriptor, 0) != 0) || fstat(descriptor, &about) != 0)
    throw Error(file + ": cannot be written; it keeps what a restart needs");
  at(0) = head;
  // The last piece of a killed job ends with zeros.
  const AnswerRecord none{};
  for (std::uint64_t n = std::uint64_t(about.st_size) / sizeof none; n > 1 && n_records == 0; --n)
    if (std::memcmp(&at(n - 1), &none, sizeof none) != 0)
      n_records = n - 1;
  for (std::uint64_t token = 1; token <= n_records; ++token)
    earlier[at(token).name.number()].push_back(token);
}

AnswerLog::~AnswerLog()
{
  for (AnswerRecord* const piece : pieces)
    if (piece != nullptr)
      munmap(piece, records_of_piece * sizeof(AnswerRecord));
  if (ftruncate(descriptor, off_t((n_records + 1) * sizeof(AnswerRecord))) == 0)
    close(descriptor);
}

AnswerRecord& AnswerLog::at(const std::uint64_t place)
{
  std::atomic<AnswerRecord*>& piece = pieces.at(place / records_of_piece);
  if (piece.load(std::memory_order_acquire) == nullptr)
    {
      const std::lock_guard lock(growing);
      if (piece == nullptr)
        {
          constexpr std::uint64_t size = records_of_piece * sizeof(AnswerRecord);
          const auto begin = off_t(place / records_of_piece * size);
          // Room that is not there would end the job at the first write, without a word.
          void* const memory =
            posix_fallocate(descriptor, begin, off_t(size)) == 0
              ? mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor, begin)
              : MAP_FAILED;
          if (memory == MAP_FAILED)
            throw Error(file + ": cannot be written: no space is left");
          piece.store(static_cast<AnswerRecord*>(memory), std::memory_order_release);
        }
    }
  return piece.load(std::memory_order_acquire)[place % records_of_piece];
}

std::uint64_t AnswerLog::add(const AnswerRecord& record)
{
  const std::uint64_t token = ++n_records;
  at(token) = record;
  return token;
}

const AnswerRecord& AnswerLog::operator[](const std::uint64_t token)
{
  if (token == 0 || token > n_records)
    throw Error(file + ": has no answer " + std::to_string(token) + "; the job uses a state that was never handed out");
  return at(token);
}

std::vector<std::uint64_t> AnswerLog::way_to(std::uint64_t token)
{
  std::vector<std::uint64_t> way;
  for (; token != 0; token = (*this)[token].parent)
    way.push_back(token);
  std::ranges::reverse(way);
  return way;
}

std::vector<std::uint64_t> AnswerLog::way_to(const PointName name, const std::span<const double> strain)
{
  if (const auto known = earlier.find(name.number()); known != earlier.end())
    for (auto token = known->second.rbegin(); token != known->second.rend(); ++token)
      if (is_same_strain(strain, (*this)[*token].strain))
        return way_to(*token);
  throw Error(file + ": has no strain from which element " + std::to_string(name.element) + ", point " +
              std::to_string(name.point) + " goes on; it is of another job than the restart file");
}
} // namespace feldspar::interfaces
