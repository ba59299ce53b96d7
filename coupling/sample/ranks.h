#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// The processes that run one test together: all that mpirun started. Every function but number() and mine() is
/// collective. Where MPI is not up there is one process, and only sum(), sums() and gathered() cannot be asked.
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

/// Work of each rank by itself. An exception on any rank (of several, the first) is thrown on all: InputError,
/// OutputError (std::system_error too) or, for anything else, std::runtime_error.
void together(const std::function<void()>& work);

/// Work that only the first rank does; else as together().
void first(const std::function<void()>& work);

/// Runs a program of all ranks, and leaves none waiting for another. An exception on all of them is thrown again by the
/// first; where a rank is alone with it, it says so and ends all. The exit code is that of the first, 0 on others:
/// mpirun ends all once one has another.
int guarded(const std::function<int()>& program);
} // namespace feldspar::ranks
