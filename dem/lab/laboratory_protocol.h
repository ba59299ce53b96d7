#pragma once

#include "base/vector.h"
#include "laboratory/kinds.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace feldspar
{
struct DynamicsParameters;
struct TestParameters;
template <typename Parameters>
struct Entry;
template <int dim>
struct Specimen;
template <int dim>
struct SetUpTest;

/// Stands a specimen between walls or grips; the pressure [Pa] is 0 for a test that takes none. Throws InputError for a
/// specimen on which the test cannot be made.
template <int dim>
using SetUp = SetUpTest<dim> (*)(Specimen<dim>, double confining_pressure, const TestParameters&,
                                 const DynamicsParameters&);

/// The size of the body that a test cuts out of a specimen [m].
template <int dim>
using BodySize = Vector<dim> (*)(const Specimen<dim>&, const TestParameters&);

/// The magnitude of the rate of CurveSample::axial_strain [1/s].
using Rate = double (*)(const TestParameters&);

/// The rate where it is a member of a protocol's own parameters.
template <typename Own, typename Tests = TestParameters>
double rate_of(const Tests& tests)
{
  return tests.template of<Own>().strain_rate;
}

/// Entries of parameters that some protocols alone have.
using OwnEntries = std::vector<Entry<TestParameters>> (*)();

/// The strain at the peak by that of another test, for the time left while the curve itself shows too little.
struct PeakForecast
{
  enum class With
  {
    nothing, ///< no forecast
    tension,
    compression ///< at the pressure of the test
  };

  With with = With::nothing;
  double factor = 1.0; ///< over the strain at the peak of that test
};

/// A laboratory test: all there is to know about it. docs/theory.md §4.
struct LaboratoryProtocol
{
  TestKind kind;
  // Optional instead of null: the sanitizers' null checks keep an address from being compared in a constant.
  std::optional<Rate> strain_rate = {};
  std::array<OwnEntries, 5> own_entries = {}; ///< up to the first null
  PeakForecast forecast = {};
  bool takes_cylinders = false; ///< in space; boxes are taken by all
  bool takes_clumps = false;    ///< in the plane: specimens of rigid groups of grains
  /// In the plane and in space; none where the test is not made there.
  std::tuple<std::optional<SetUp<2>>, std::optional<SetUp<3>>> set_ups = {};
  /// None where the specimen itself is tested.
  std::tuple<std::optional<BodySize<2>>, std::optional<BodySize<3>>> body_sizes = {};

  template <int dim>
  constexpr const std::optional<SetUp<dim>>& set_up() const
  {
    return std::get<dim - 2>(set_ups);
  }

  template <int dim>
  constexpr const std::optional<BodySize<dim>>& body_size() const
  {
    return std::get<dim - 2>(body_sizes);
  }
};

/// The protocol itself if it says what every test must; a constant made of another does not compile.
constexpr LaboratoryProtocol complete(const LaboratoryProtocol& protocol)
{
  const TestKind& kind = protocol.kind;
  if (kind.name.empty() || kind.title.empty() || kind.strength.empty())
    throw std::logic_error("a laboratory test needs a name, a title and a name of its strength");
  if (kind.sign != 1.0 && kind.sign != -1.0)
    throw std::logic_error("a laboratory test pulls, sign = 1, or presses, sign = -1");
  if (!protocol.strain_rate)
    throw std::logic_error("a laboratory test needs the entry of its strain rate");
  if (!protocol.set_up<2>() && !protocol.set_up<3>())
    throw std::logic_error("a laboratory test needs a set-up");
  return protocol;
}
} // namespace feldspar
