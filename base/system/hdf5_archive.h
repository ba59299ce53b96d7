#pragma once

#include "base/input_error.h"

#include <H5Cpp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Writing and reading HDF5 by one description: `transfer(archive, object)` names each value once and serves both.
namespace feldspar
{
/// Numbers as files hold them; all else is plain structs, for files that return to the same program.
template <typename T>
concept StoredNumber = std::is_same_v<T, double> || std::is_same_v<T, std::uint64_t> ||
  std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::uint8_t>;

template <StoredNumber T>
const H5::PredType& stored_type()
{
  return std::is_same_v<T, double>          ? H5::PredType::NATIVE_DOUBLE
         : std::is_same_v<T, std::uint64_t> ? H5::PredType::NATIVE_UINT64
         : std::is_same_v<T, std::uint32_t> ? H5::PredType::NATIVE_UINT32
                                            : H5::PredType::NATIVE_UINT8;
}

/// Leaves out the time at which an array was made: equal results have equal files.
inline void forget_times(const H5::DSetCreatPropList& of_array) { H5Pset_obj_track_times(of_array.getId(), false); }

class Hdf5Writer
{
public:
  static constexpr bool reads = false;

  explicit Hdf5Writer(const H5::Group& where)
    : group(where)
  {
  }

  template <typename T>
  void value(const std::string& name, T& stored)
  {
    group.createAttribute(name, stored_type<T>(), H5::DataSpace(H5S_SCALAR)).write(stored_type<T>(), &stored);
  }

  void text(const std::string& name, std::string& stored)
  {
    const H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
    group.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, stored);
  }

  /// Writes an array with a checksum: a change by a disk or a broken write is seen when it is read. `n_columns` values
  /// make a row. Pieces have a checksum each, because the library copies a piece twice and takes none of 4 GB.
  template <StoredNumber T, typename Allocator>
  void array(const std::string& name, std::vector<T, Allocator>& values, const std::size_t n_columns = 1)
  {
    const std::array<hsize_t, 2> shape{values.size() / n_columns, n_columns};
    constexpr hsize_t largest_piece = 1 << 23; // bytes
    const hsize_t n_pieces = values.size() * sizeof(T) / largest_piece + 1;
    const std::array<hsize_t, 2> piece{(shape[0] + n_pieces - 1) / n_pieces, n_columns};
    const int rank = n_columns > 1 ? 2 : 1;
    H5::DSetCreatPropList checked;
    forget_times(checked);
    if (!values.empty())
      {
        checked.setChunk(rank, piece.data());
        checked.setFletcher32();
      }
    group.createDataSet(name, stored_type<T>(), H5::DataSpace(rank, shape.data()), checked)
      .write(values.data(), stored_type<T>());
  }

  /// Plain structs as they lie in memory.
  template <typename T>
  requires(!StoredNumber<T>) void array(const std::string& name, std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(values.data());
    std::vector<std::uint8_t> raw(begin, begin + values.size() * sizeof(T));
    array(name, raw);
  }

  Hdf5Writer subgroup(const std::string& name) { return Hdf5Writer(group.createGroup(name)); }

private:
  H5::Group group;
};

class Hdf5Reader
{
public:
  static constexpr bool reads = true;

  /// Reads a file of so many bytes: no array in it is longer. `copy`: a group that takes all that is read.
  Hdf5Reader(const H5::Group& where, const std::uint64_t size_of_file, std::optional<H5::Group> copy_of_it = {})
    : group(where)
    , file_size(size_of_file)
    , copy(std::move(copy_of_it))
  {
  }

  template <typename T>
  void value(const std::string& name, T& stored)
  {
    single(name).read(stored_type<T>(), &stored);
    if (copy && !copy->attrExists(name))
      Hdf5Writer(*copy).value(name, stored);
  }

  void text(const std::string& name, std::string& stored)
  {
    const H5::Attribute attribute = single(name);
    const H5::StrType type = attribute.getStrType();
    if (!type.isVariableStr())
      throw InputError("{} is no text", name);
    attribute.read(type, stored);
    if (copy && !copy->attrExists(name))
      Hdf5Writer(*copy).text(name, stored);
  }

  /// Returns the number of values of an array.
  std::size_t size_of(const std::string& name) const { return size_of(name, group.openDataSet(name)); }

  template <StoredNumber T, typename Allocator>
  void array(const std::string& name, std::vector<T, Allocator>& values)
  {
    const H5::DataSet set = group.openDataSet(name);
    values.resize(size_of(name, set));
    set.read(values.data(), stored_type<T>());
    if constexpr (std::is_same_v<T, double>)
      if (!std::ranges::all_of(values, [](const double v) { return std::isfinite(v); }))
        throw InputError("{} holds a value that is not finite", name);
    if (copy && !copy->nameExists(name))
      Hdf5Writer(*copy).array(name, values);
  }

  template <typename T>
  requires(!StoredNumber<T>) void array(const std::string& name, std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::uint8_t> raw;
    array(name, raw);
    if (raw.size() % sizeof(T) != 0)
      throw InputError("{} has another layout", name);
    values.resize(raw.size() / sizeof(T));
    std::ranges::copy(raw, reinterpret_cast<std::uint8_t*>(values.data()));
  }

  bool has(const std::string& name) const { return group.nameExists(name); }
  bool has_attribute(const std::string& name) const { return group.attrExists(name); }

  Hdf5Reader subgroup(const std::string& name)
  {
    const H5::Group inner = group.openGroup(name);
    if (!copy)
      return {inner, file_size};
    return {inner, file_size, copy->nameExists(name) ? copy->openGroup(name) : copy->createGroup(name)};
  }

private:
  /// An attribute of one value: what it is read into has no room for more.
  H5::Attribute single(const std::string& name) const
  {
    H5::Attribute attribute = group.openAttribute(name);
    if (attribute.getSpace().getSimpleExtentNpoints() != 1)
      throw InputError("{} is not one value", name);
    return attribute;
  }

  /// Nothing is stored compressed: each value lies in the file.
  std::size_t size_of(const std::string& name, const H5::DataSet& set) const
  {
    const hssize_t n = set.getSpace().getSimpleExtentNpoints();
    if (n < 0 || std::uint64_t(n) > file_size / set.getDataType().getSize())
      throw InputError("{} is longer than the file", name);
    return std::size_t(n);
  }

  H5::Group group;
  std::uint64_t file_size;
  std::optional<H5::Group> copy;
};

/// Writes a file whole or not at all, with a seal (base/checksum/seal.h), an array at a time. Throws OutputError, which names file
/// and cause.
void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write);

/// Writes a file of arrays that another library wrote once more: without their times, and with a seal. Throws OutputError.
void seal_hdf5(const std::filesystem::path& file);

/// Reads a file that write_hdf5() wrote. Whatever is wrong with it is an InputError, which says so and that `expected` was
/// expected.
void read_hdf5(const std::filesystem::path& file, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& read);

/// The same of a file that may be older than seals, or another program's, of which `read` must check every number that it
/// uses. The HDF5 library itself may crash or search without end in a file that nobody vouches for: a child process of
/// limited time and memory reads it first, and copies what `read` reads, which is then read from the copy. `read` therefore
/// runs twice and keeps nothing outside of what it fills. `check` is called while the child works and may throw to end it.
void read_foreign_hdf5(
  const std::filesystem::path& file, const std::string& expected, const std::function<void(Hdf5Reader&)>& read,
  const std::function<void()>& check = [] {});
} // namespace feldspar
