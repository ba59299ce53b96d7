#pragma once

#include "results/runs/series.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The tests of one kind and under the same pressures in a series: one a seed.
struct TestGroup
{
  TestKind kind;
  double confining_pressure;                 ///< [Pa]
  std::optional<double> intermediate_stress; ///< where it is another [Pa]
  std::vector<const FinishedTest*> tests;

  std::string title() const; ///< Triaxial compression, 5 MPa
  std::string name() const;  ///< for files: triaxial_compression_5_MPa
  EnvelopeRole envelope_role() const { return feldspar::envelope_role(kind, intermediate_stress); }
};

/// The group a test belongs to, without any test in it.
TestGroup group_of(const TestRecord& record);

bool same_conditions(const TestGroup& a, const TestGroup& b);

/// The order of reports.
bool comes_before(const TestGroup& a, const TestGroup& b);

/// The groups of a series in the order of kinds and pressures. The series must outlive them.
std::vector<TestGroup> groups_of(const Series& series);

/// The groups for which a page has room: of the confinements the lowest and the highest.
std::vector<TestGroup> shown(const std::vector<TestGroup>& groups);

/// The first test of a group that has a curve with a peak; null if there is none.
const FinishedTest* typical(const TestGroup& group);

/// A figure over the seeds of a group, where it could be had by a valid test.
std::vector<double> values(const TestGroup& group, Figure TestResults::*figure);

/// The abscissa of a test: the axial strain, positive in the sense of the test, or the time [s]
/// where a table prescribes a strain back and forth.
double abscissa(const TestKind& kind, const CurveSample& row);

/// A quantity along the curves of a group: mean and standard deviation over the tests at the same abscissa, as far as all
/// curves go.
struct Band
{
  std::vector<double> abscissa;
  std::vector<double> mean;
  std::vector<double> deviation; ///< 0 of a single test
};

/// `quantity` of a row, without the sign of the laboratory; `laboratory` puts it on.
Band band(const TestGroup& group, const std::function<double(const CurveSample&)>& quantity, bool laboratory);
} // namespace feldspar
