#pragma once

#include "base/random.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace feldspar::tests
{
/// Damage to a file, the same from the same seed: what disks, transfers and editors do to bytes.
class Mutations
{
public:
  explicit Mutations(const std::uint64_t seed)
    : random(seed, RandomStream::positions)
  {
  }

  /// Another content than the one given, which is not empty.
  std::string of(const std::string& content)
  {
    for (;;)
      if (std::string mutated = once(content); mutated != content)
        return mutated;
  }

private:
  std::size_t below(const std::size_t n) { return std::min(n - 1, std::size_t(random.uniform() * double(n))); }

  std::string once(std::string content)
  {
    const std::size_t begin = below(content.size());
    // Short pieces are as frequent as long ones.
    const std::size_t length = std::min(content.size() - begin, std::size_t(1) << below(16));
    switch (below(8))
      {
      case 0: // one bit
        content[begin] = char(content[begin] ^ 1 << below(8));
        break;
      case 1: // many bits
        for (std::size_t n = 2 + below(30); n > 0; --n)
          {
            char& byte = content[below(content.size())];
            byte = char(byte ^ 1 << below(8));
          }
        break;
      case 2:
        content.resize(begin);
        break;
      case 3: // a piece twice
        content.insert(begin, content.substr(begin, length));
        break;
      case 4: // a piece lost
        content.erase(begin, length);
        break;
      case 5: // a piece in another's place
        content.replace(below(content.size()), length, content.substr(begin, length));
        break;
      case 6: // a block of zeros or of ones
        content.replace(begin, length, std::string(length, below(2) == 0 ? '\0' : '\xff'));
        break;
      default: // noise
        for (std::size_t i = begin; i < begin + length; ++i)
          content[i] = char(below(256));
      }
    return content;
  }

  Random random;
};
} // namespace feldspar::tests
