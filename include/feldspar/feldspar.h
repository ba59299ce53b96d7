#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Feldspar as a library: input, specimens, laboratory tests, representative volumes. SI throughout; tension positive, but for
/// what says "compression positive". Docs: docs/library.md.
///
/// Each function throws Error, one line for the user, for what cannot be done. Objects of different threads are independent;
/// one object serves one thread at a time, and others wait.
#define FELDSPAR_PUBLIC __attribute__((visibility("default")))

namespace feldspar
{
// The name of the first face; the library itself has internal classes of the same names.
#ifdef FELDSPAR_IMPLEMENTS_FACE
namespace v1
#else
inline namespace v1
#endif
{
/// The user's mistake, in one line: what is wrong, where, what is allowed.
class FELDSPAR_PUBLIC Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// Work that its Check ended.
class FELDSPAR_PUBLIC Stopped : public std::exception
{
public:
  ~Stopped() override;
  const char* what() const noexcept override;
};

/// Asked again and again while the library works; where it returns true, the work ends with Stopped. May be empty.
using Check = std::function<bool()>;

/// A column of numbers; its name ends in its SI unit, as in the files of a run.
struct Column
{
  std::string name;
  std::vector<double> values;
  bool is_count = false; ///< whole numbers: counts, and numbers of something
};

using Table = std::vector<Column>;

/// The version, as 0.3.0.
FELDSPAR_PUBLIC std::string version();

/// The number of threads of this process that the library may work on from now on; 0: all.
FELDSPAR_PUBLIC void set_threads(std::size_t n);

/// An SI value of a text such as "22 MPa". `quantity`: stress, length, angle, density, rate, duration.
FELDSPAR_PUBLIC double in_si(std::string_view text, std::string_view quantity);

/// An entry of the input, for reference.
struct EntryDescription
{
  std::string name; ///< Section/Entry
  std::string unit;
  std::string range;
  std::string preset; ///< the value of an input that does not name it
  std::string meaning;
};

/// Every entry, in the order of the reference.
FELDSPAR_PUBLIC std::vector<EntryDescription> entries();

/// Hoek–Brown and Mohr–Coulomb envelopes of strengths, compression positive [Pa], as `fits` in summary.json. The uniaxial
/// strength is the point at sigma_3 = 0.
FELDSPAR_PUBLIC std::string fit_envelopes(std::span<const double> sigma_3, std::span<const double> sigma_1,
                                          std::optional<double> tensile_strength = {});

class InputState;
class SpecimenState;
class TestState;
class RveState;
class VolumesState;
class TrialState;

/// An input: what an input file says, entry by entry.
class FELDSPAR_PUBLIC Input
{
public:
  Input();
  /// Reads a .prm or .json file.
  explicit Input(const std::string& file);
  Input(const Input&);
  Input& operator=(const Input&);
  ~Input();

  /// Gives an entry, "Flat joint/Modulus", a value as a file would have it, "70 GPa". Conditions between entries are checked
  /// where the input is used, and by check().
  void set(std::string_view entry, std::string_view value);
  /// The value of an entry: as given, or else its preset.
  std::string get(std::string_view entry) const;
  /// Takes an entry back to its preset.
  void unset(std::string_view entry);
  /// The entries that were given, in their order.
  const std::vector<std::pair<std::string, std::string>>& given() const;
  void check() const;

  const InputState& state() const { return *of; }

private:
  std::shared_ptr<InputState> of;
};

/// A specimen of grains and joints, free of stress. Copies share it: nothing changes it.
class FELDSPAR_PUBLIC Specimen
{
public:
  /// Makes the specimen of an input. The seed fixes every bit.
  explicit Specimen(const Input& input, std::uint64_t seed = 1, const Check& check = {});
  /// Reads what save() or a run wrote: specimen.h5.
  static Specimen load(const std::string& file, const Check& check = {});
  void save(const std::string& file) const;

  int dimension() const;
  std::uint64_t seed() const;
  /// Width, (depth,) height [m]; [dimension].
  std::vector<double> size() const;
  bool is_periodic() const;
  /// x_m, y_m, (z_m,) radius_m; of a rock of minerals also the numbers mineral and mineral_grain, from 1.
  Table grains() const;
  Table joints() const; ///< grain_1, grain_2, as rows of grains(), and the installation gap gap_m
  /// Counts, porosity, coordination, installation gap: the name as in summary.json, and the value.
  std::vector<std::pair<std::string, double>> report() const;

  const SpecimenState& state() const { return *of; }

private:
  explicit Specimen(std::shared_ptr<const SpecimenState> state);
  std::shared_ptr<const SpecimenState> of;
};

/// A stage of a test of one's own, as a row of a loading table; docs/theory.md §4.11. Compression positive. Strain, stress or
/// duration says where it ends.
struct Stage
{
  std::optional<double> axial_strain;
  std::optional<double> axial_stress; ///< with a duration: held throughout [Pa]
  std::optional<double> lateral_strain;
  std::optional<double> duration;    ///< [s]
  double confining_pressure = 0.0;   ///< at its end [Pa]
  std::optional<double> strain_rate; ///< magnitude; none: Tests/Compression strain rate [1/s]
};

/// A laboratory test, row by row of its curve.
class FELDSPAR_PUBLIC Test
{
public:
  /// A test of a kind (direct_tension, triaxial_compression, …) on a copy of the specimen, by the entries of the input that
  /// are about tests. Confining pressure: compression positive [Pa].
  Test(const Specimen& specimen, const Input& input, std::string_view kind, double confining_pressure = 0.0);
  /// A test of one's own between platens and side walls, which begins at a confining pressure with this stage.
  Test(const Specimen& specimen, const Input& input, double confining_pressure, const Stage& first);
  Test(Test&&) noexcept;
  Test& operator=(Test&&) noexcept;
  ~Test();

  /// Appends a stage, which begins where the test stands. Of a test of one's own only.
  void follow(const Stage& stage);
  const std::string& kind() const;
  /// All stages so far, of a test of one's own.
  const std::vector<Stage>& stages() const;

  /// Writes the state of the test, with which load() goes on to the same bits.
  void save(const std::string& file) const;
  /// The test that save() wrote, by the same version, of the same specimen and the same entries. Others are refused.
  static Test load(const Specimen& specimen, const Input& input, const std::string& file);

  /// Runs to the next row of the curve. Returns false once the test, or its last stage, has ended. After Stopped the next
  /// call goes on; a seating cannot be gone on with.
  bool advance(const Check& check = {});
  bool has_ended() const;

  std::uint64_t n_rows() const;
  std::vector<std::string> columns() const;
  /// The last row of the curve, in the order of columns(); none before the first advance().
  std::vector<double> last_row() const;
  /// The rows from one on. Stress and strain are positive in the sense of the test, as in curves/*.csv.
  Table curve(std::uint64_t from = 0) const;
  /// One row a broken segment, with in_tension 1 or 0; else as cracks.csv.
  Table cracks() const;
  /// Positions of the grains at the seating and now, as grains/*.csv.
  Table grains() const;
  /// The test as an element of `tests` in summary.json.
  std::string summary() const;

private:
  std::unique_ptr<TestState> of;
};

/// The response of a representative volume to a strain.
class FELDSPAR_PUBLIC Trial
{
public:
  bool in_equilibrium() const;        ///< false: none was found, and stress and strain are where the search ended
  std::vector<double> strain() const; ///< Voigt, engineering shear; [n_voigt]
  std::vector<double> stress() const; ///< [Pa]; [n_voigt]
  /// [Pa]; rows first, [n_voigt²]; empty where it was not asked for.
  std::vector<double> tangent() const;
  std::size_t n_breaks() const;

private:
  friend class Rve;
  Trial() = default;
  std::shared_ptr<TrialState> of;
};

/// The damage of a representative volume: the fields of a point in a sample.
struct Damage
{
  double broken_share = 0.0;             ///< of all segments
  double broken_in_shear_share = 0.0;    ///< the same
  double dissipation = 0.0;              ///< [J/m³]
  double crack_density = 0.0;            ///< area (in the plane length) of the cracks over the volume [1/m]
  std::vector<double> crack_orientation; ///< sum of their areas and normals n⊗n over the volume, Voigt [1/m]; [n_voigt]
};

/// A representative volume: a periodic specimen that answers a strain by a stress, without time; docs/theory.md §9. Strains and
/// stresses in Voigt's order, xx, yy, xy or xx, yy, zz, yz, xz, xy, with engineering shear. Trying changes nothing; accept()
/// does.
class FELDSPAR_PUBLIC Rve
{
public:
  /// The boundary is that of the input, Representative volume/Boundary.
  Rve(const Specimen& specimen, const Input& input);
  Rve(const Rve&);
  Rve& operator=(const Rve&);
  ~Rve();

  int dimension() const;
  std::vector<double> stiffness() const; ///< of the intact cell [Pa]; rows first, [n_voigt²]
  std::vector<double> strain() const;
  std::vector<double> stress() const;
  bool is_intact() const;
  std::size_t n_broken() const; ///< segments
  Damage damage() const;

  /// The response with all bonds kept.
  Trial trial(std::span<const double> strain, bool with_tangent = false, const Check& check = {}) const;
  /// The response with bonds that break until none is overloaded.
  Trial relax(std::span<const double> strain, bool with_tangent = false, const Check& check = {}) const;
  /// Takes a trial of this volume, or of one that shares its cell, as the state.
  void accept(const Trial& trial);
  /// The factor of the direction at which the first segment of the intact cell breaks, in closed form; infinity if none does.
  double first_break(std::span<const double> direction) const;

  /// The state as bytes, for restore() of the same version and the same cell. Others are refused, and so are changed bytes.
  std::string state() const;
  void restore(const std::string& state);

private:
  std::unique_ptr<RveState> of;
};

/// Many representative volumes, answered on all threads by one call.
///
/// A state of all volumes has a number, its token; 0 is at rest. update() answers from the state of a token and keeps the
/// outcome under a new one. A token that is given as parent is accepted by that: its siblings, and what came before it, go.
class FELDSPAR_PUBLIC Volumes
{
public:
  /// `n` volumes, each on one of the specimens: those with the numbers `assigned` [n], or the first where there are none.
  Volumes(std::span<const Specimen> specimens, const Input& input, std::size_t n,
          std::span<const std::size_t> assigned = {});
  Volumes(Volumes&&) noexcept;
  Volumes& operator=(Volumes&&) noexcept;
  ~Volumes();

  std::size_t size() const;
  int dimension() const;
  /// Fills stresses [n × n_voigt] from strains [n × n_voigt], and tangents [n × n_voigt²] unless that is empty. Bonds break
  /// until none is overloaded, or all are kept. Returns the token. Throws Error, and keeps nothing, where a volume finds no
  /// equilibrium.
  std::uint64_t update(std::span<const double> strains, std::uint64_t parent, std::span<double> stresses,
                       std::span<double> tangents = {}, bool bonds_break = true, const Check& check = {});
  /// Broken segments of each volume in the state of a token; [n].
  std::vector<std::size_t> n_broken(std::uint64_t token) const;

private:
  std::unique_ptr<VolumesState> of;
};
} // namespace v1
} // namespace feldspar
