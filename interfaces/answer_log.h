#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

/// The strains that a job asked of its points, in a file beside it: what a job needs that goes on from a restart file, which
/// has strains, but no tokens.
namespace feldspar::interfaces
{
/// A point of a foreign mesh.
struct PointName
{
  std::uint32_t element;
  std::uint32_t point;

  std::uint64_t number() const { return (std::uint64_t(element) << 32U) | point; }
};

/// Returns whether two strains differ by round-off alone; an empty one is that of no point.
bool is_same_strain(std::span<const double> one, std::span<const double> other);

/// An answer. Its token is its place in the file, counted from 1; token 0 is a point at rest. In the place 0 the file has its
/// mark and identity.
struct AnswerRecord
{
  PointName name;
  std::uint64_t parent; ///< token of the state from which it was asked
  double strain[6];     ///< Voigt, engineering shear; the first three in the plane
};

/// The file is memory that the system writes to the disk, so that a killed job loses no answer. Any number of threads.
class AnswerLog
{
public:
  /// Goes on with a file that is there: the first point that a restarted job asks may be at rest. identity: of program, input
  /// and mode. A file of other ones is begun anew, unless a restart needs it. Throws Error where a file that is needed is
  /// missing or another's, or where it cannot be written.
  AnswerLog(std::string file, std::uint64_t identity, bool is_needed);
  AnswerLog(const AnswerLog&) = delete;
  AnswerLog& operator=(const AnswerLog&) = delete;
  ~AnswerLog();

  /// Writes an answer. Returns its token.
  std::uint64_t add(const AnswerRecord& record);

  /// The answers that led to a strain of a point, the first one first: the last of the file at that strain within round-off.
  /// Throws Error where the file has none.
  std::vector<std::uint64_t> way_to(PointName name, std::span<const double> strain);
  /// The same to a token.
  std::vector<std::uint64_t> way_to(std::uint64_t token);
  /// Throws Error for a token that was never handed out.
  const AnswerRecord& operator[](std::uint64_t token);

private:
  static constexpr std::uint64_t records_of_piece = 1U << 16U; ///< 4 MiB
  static constexpr std::size_t most_pieces = 1U << 14U;        ///< 64 GiB

  AnswerRecord& at(std::uint64_t place);

  std::string file;
  int descriptor;
  std::mutex growing;
  std::vector<std::atomic<AnswerRecord*>> pieces;
  std::atomic<std::uint64_t> n_records = 0;
  /// Tokens of the answers that were in the file when it was opened.
  std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> earlier;
};
} // namespace feldspar::interfaces
