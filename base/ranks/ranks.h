#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// The processes that run one test together: those of a Group (base/ranks/communicator.h), or without one this process
/// alone. Every function but number() and mine() is collective.
namespace feldspar::ranks
{
unsigned int number(); ///< how many there are
unsigned int mine();   ///< from 0
unsigned int number_on_this_machine();
inline bool is_first() { return mine() == 0; }

/// Returns whether it is true of any rank.
bool any(bool here);

std::uint64_t sum(std::uint64_t here);
std::vector<double> sums(const std::vector<double>& here); ///< entry by entry

/// The value of the first rank.
std::string of_first(const std::string& text);

/// The texts of all ranks, one after another by rank, on the first; nothing on others. Any length.
std::string gathered(const std::string& text);

/// The same of bytes.
std::vector<std::byte> gathered_by_first(std::span<const std::byte> own);

/// The bytes of all ranks, one after another by rank, on each. `sizes`: how many each gives, where all know that; else empty, and
/// becomes it.
std::vector<std::byte> gathered_by_all(std::span<const std::byte> own, std::vector<std::size_t>& sizes);

/// Sends to each rank r the values sent[first_sent[r]] … and receives from it received[first_received[r]] …, where there are
/// any; both know how many. first: [number() + 1].
void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
              std::vector<double>& received, const std::vector<std::size_t>& first_received);

/// Work of each rank by itself. What it throws on any rank (of several, the first) is thrown on all: InputError,
/// OutputError (std::system_error too) or, of anything else, std::runtime_error.
void together(const std::function<void()>& work);

/// Work of each rank in its turn, as together(): one at a time of those on a machine, whose memory it may take.
void in_turn(const std::function<void()>& work);

/// Work that only the first rank does; else as together().
void first(const std::function<void()>& work);
} // namespace feldspar::ranks
