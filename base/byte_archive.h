#pragma once

#include "base/input_error.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// States as plain bytes, by the description that HDF5 files take too (base/system/hdf5_archive.h): `transfer(archive, state)` names
/// each value once and serves writing and reading.
namespace feldspar
{
/// Archives know numbers alone.
template <typename Archive>
void transfer_flag(Archive& archive, const std::string& name, bool& flag)
{
  std::uint32_t stored = flag;
  archive.value(name, stored);
  flag = stored != 0;
}

/// Bytes of the values as they lie in memory, for processes of the same program.
template <typename T>
std::string bytes_of(const std::vector<T>& values)
{
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The values that bytes_of() was given.
template <typename T>
std::vector<T> values_of(const std::string& bytes)
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::ranges::copy(bytes, reinterpret_cast<char*>(values.data()));
  return values;
}

/// Values one after another, without their names: for memory of the same program.
class BytesWriter
{
public:
  static constexpr bool reads = false;

  template <typename T>
  void value(const std::string& /*name*/, const T& stored)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    all.append(reinterpret_cast<const char*>(&stored), sizeof(T));
  }

  template <typename T>
  void array(const std::string& name, const std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    value(name, std::uint64_t(values.size()));
    all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  void text(const std::string& name, const std::string& stored)
  {
    value(name, std::uint64_t(stored.size()));
    all += stored;
  }

  std::string all;
};

/// Throws InputError where the bytes end before the values do.
class BytesReader
{
public:
  static constexpr bool reads = true;

  explicit BytesReader(const std::string& bytes)
    : all(bytes)
  {
  }

  template <typename T>
  void value(const std::string& name, T& stored)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    take(name, &stored, sizeof(T));
  }

  template <typename T>
  void array(const std::string& name, std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    values.resize(length(name, sizeof(T)));
    if (!values.empty())
      take(name, values.data(), values.size() * sizeof(T));
  }

  void text(const std::string& name, std::string& stored)
  {
    stored.resize(length(name, 1));
    take(name, stored.data(), stored.size());
  }

  bool has_ended() const { return position == all.size(); }

private:
  std::size_t length(const std::string& name, const std::size_t size_of_one)
  {
    std::uint64_t n = 0;
    value(name, n);
    if (n > (all.size() - position) / size_of_one)
      throw InputError(name + " is cut short");
    return std::size_t(n);
  }

  void take(const std::string& name, void* const place, const std::size_t n)
  {
    if (n > all.size() - position)
      throw InputError(name + " is cut short");
    std::memcpy(place, all.data() + position, n);
    position += n;
  }

  const std::string& all;
  std::size_t position = 0;
};

/// Writes nothing: for a description that does more than name its values.
class NothingWriter
{
public:
  static constexpr bool reads = false;

  void value(const std::string& /*name*/, const auto& /*stored*/) {}
  void array(const std::string& /*name*/, const auto& /*values*/) {}
};

/// A copy is described, because one description serves both ways, and reading changes the state.
template <typename State>
std::string to_bytes(State state)
{
  BytesWriter writer;
  transfer(writer, state);
  return std::move(writer.all);
}

/// Throws InputError where the bytes are not those of such a state.
template <typename State>
State from_bytes(const std::string& bytes)
{
  BytesReader reader(bytes);
  State state;
  transfer(reader, state);
  if (!reader.has_ended())
    throw InputError("a stored state is longer than it can be");
  return state;
}
} // namespace feldspar
