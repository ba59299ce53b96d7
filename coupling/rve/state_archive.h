#pragma once

#include "base/input_error.h"
#include "coupling/network/network_state.h"
#include "coupling/network/voigt.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

/// The state of a volume, described once for all archives: HDF5 files (base/hdf5_archive.h) and plain bytes.
namespace feldspar
{
template <typename Archive>
void transfer_flag(Archive& archive, const std::string& name, bool& flag)
{
  std::uint32_t stored = flag;
  archive.value(name, stored);
  flag = stored != 0;
}

template <int dim, typename Archive>
void transfer(Archive& archive, NetworkState<dim>& state)
{
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      archive.value("strain_" + voigt_name<dim>(k), state.strain[k]);
      archive.value("stress_" + voigt_name<dim>(k), state.stress[k]);
    }
  transfer_flag(archive, "intact", state.intact);
  archive.array("motions", state.motions);
  archive.bytes("unbonded", state.unbonded);
  bool has_contact_shear = true;
  if constexpr (requires { archive.has(""); })
    has_contact_shear = archive.has("contact_shear"); // files of version 0.2.0 know flat joints alone
  if (has_contact_shear)
    archive.bytes("contact_shear", state.contact_shear);
  archive.value("n_tension_breaks", state.n_tension_breaks);
  archive.value("n_shear_breaks", state.n_shear_breaks);
  archive.value("boundary_work", state.work.boundary);
  archive.value("slip_work", state.work.slip);
  archive.value("released_work", state.work.released);
  archive.value("settled_work", state.work.settled);
}

/// Values one after another, without their names: for memory of the same program.
class BytesWriter
{
public:
  static constexpr bool reads = false;

  template <typename T>
  void value(const std::string& /*name*/, T& stored)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    all.append(reinterpret_cast<const char*>(&stored), sizeof(T));
  }

  template <typename T>
  void array(const std::string& name, std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t n = values.size();
    value(name, n);
    all.append(reinterpret_cast<const char*>(values.data()), n * sizeof(T));
  }

  void text(const std::string& name, std::string& stored)
  {
    std::vector<char> characters(stored.begin(), stored.end());
    array(name, characters);
  }

  template <typename T>
  void bytes(const std::string& name, std::vector<T>& values)
  {
    array(name, values);
  }

  std::string all;
};

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
    take(name, &stored, sizeof(T));
  }

  template <typename T>
  void array(const std::string& name, std::vector<T>& values)
  {
    std::uint64_t n = 0;
    value(name, n);
    if (n > (all.size() - position) / sizeof(T))
      throw InputError(name + " is cut short");
    values.resize(n);
    if (n > 0)
      take(name, values.data(), n * sizeof(T));
  }

  void text(const std::string& name, std::string& stored)
  {
    std::vector<char> characters;
    array(name, characters);
    stored.assign(characters.begin(), characters.end());
  }

  template <typename T>
  void bytes(const std::string& name, std::vector<T>& values)
  {
    array(name, values);
  }

private:
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
} // namespace feldspar
