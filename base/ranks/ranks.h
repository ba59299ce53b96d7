#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// The processes that run one test together: those of a Group (base/ranks/communicator.h), or without one this process
/// alone. Every function but number() and mine() is collective.
namespace feldspar::ranks
{
unsigned int number(); ///< how many there are
unsigned int mine();   ///< from 0
inline bool is_first() { return mine() == 0; }

/// Returns whether it is true of any rank.
bool any(bool here);

std::uint64_t sum(std::uint64_t here);
std::vector<double> sums(const std::vector<double>& here); ///< entry by entry

/// The value of the first rank.
std::string of_first(const std::string& text);

/// The texts of all ranks, one after another by rank, on the first; nothing on others. Any length.
std::string gathered(const std::string& text);

/// Work of each rank by itself. What it throws on any rank (of several, the first) is thrown on all: InputError,
/// OutputError (std::system_error too) or, of anything else, std::runtime_error.
void together(const std::function<void()>& work);

/// Work that only the first rank does; else as together().
void first(const std::function<void()>& work);
} // namespace feldspar::ranks
