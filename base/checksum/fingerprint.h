#pragma once

#include <cstdint>
#include <string_view>

namespace feldspar
{
/// A number that different data hardly share (FNV-1a, 64 bits).
class Fingerprint
{
public:
  void add_byte(const std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3u; }
  void add(const std::uint64_t number)
  {
    for (int shift = 0; shift < 64; shift += 8)
      add_byte(number >> shift & 0xffu);
  }
  void add(const std::string_view bytes)
  {
    for (const char byte : bytes)
      add_byte(static_cast<unsigned char>(byte));
  }
  std::uint64_t value() const { return hash; }

private:
  std::uint64_t hash = 0xcbf29ce484222325u;
};
} // namespace feldspar
