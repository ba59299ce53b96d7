#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace feldspar
{
/// The processes that compute one body together, each with its own grains. Every function but number() and mine() is called
/// by all of them at once.
class Partners
{
public:
  virtual ~Partners() = default;
  virtual unsigned int number() const = 0; ///< how many there are
  virtual unsigned int mine() const = 0;   ///< from 0

  /// The bytes of all, one process after another, on each. `sizes`: how many each gives, where all know that, which is faster;
  /// else empty, and becomes it.
  virtual std::vector<std::byte> gathered(std::span<const std::byte> own, std::vector<std::size_t>& sizes) = 0;
  /// The bytes of all, one process after another, on the first; nothing on others.
  virtual std::vector<std::byte> gathered_by_first(std::span<const std::byte> own) = 0;
  /// Sends to each process p the values sent[first_sent[p]] … and receives from it received[first_received[p]] …; both know
  /// how many. first: [number() + 1].
  virtual void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
                        std::vector<double>& received, const std::vector<std::size_t>& first_received) = 0;
};

template <typename T>
std::vector<T> values_of(const std::vector<std::byte>& bytes)
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty())
    std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// The same of values, `counts` of each process.
template <typename T>
std::vector<T> gathered(Partners& partners, const std::vector<T>& own, std::vector<std::size_t>& counts)
{
  std::vector<std::size_t> sizes(counts.size());
  std::ranges::transform(counts, sizes.begin(), [](const std::size_t n) { return n * sizeof(T); });
  std::vector<T> all = values_of<T>(partners.gathered(std::as_bytes(std::span(own)), sizes));
  counts.resize(sizes.size());
  std::ranges::transform(sizes, counts.begin(), [](const std::size_t n) { return n / sizeof(T); });
  return all;
}
} // namespace feldspar
