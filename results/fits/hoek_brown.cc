#include "results/fits/hoek_brown.h"

#include "base/contains.h"
#include "base/mapped.h"
#include "base/prefixes.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/jet.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace feldspar
{
namespace
{
constexpr double lowest_a = 0.05;
constexpr double highest_a = 1.0;
constexpr double least = 1e-9; ///< stands for the open bounds, "> 0" and, of a share, "< 1"

/// Stresses in units of the largest, so that all variables are of order one to a hundred.
struct Task
{
  HoekBrownForm form;
  double reference; ///< sigma_r <= 0, the lowest sigma_3 that the envelope must reach
  double sigma_ci;  ///< where it is given
};

/// The envelope written from its reference,
///   sigma_1 = sigma_3 + sigma_ci (m (sigma_3 - sigma_r)/sigma_ci + b)^a,  b = u^(1/a),
/// in which u >= 0 is its deviator at sigma_r over sigma_ci. b is the bracket there; for any u >= 0 and m > 0 the
/// bracket is admissible at every point, and the deviator at sigma_r, whose slope in b is infinite at b = 0, is linear
/// in u.
template <typename T>
struct Envelope
{
  T sigma_ci;
  T m;
  T a;
  T u;
  T b;
  double reference;

  T s() const { return b - m * reference / sigma_ci; }

  T sigma_1(const double sigma_3) const
  {
    using std::pow;
    if (sigma_3 == reference)
      return sigma_3 + sigma_ci * u;
    return sigma_3 + sigma_ci * pow(m * (sigma_3 - reference) / sigma_ci + b, a);
  }
};

/// The variables x of the optimiser: as_paper (m, u, a); intact (sigma_ci, v) and general (sigma_ci, v, a), where s = 1
/// leaves one of m and u free: v is m if the envelope need not reach tension, where u = 1, else u.
template <typename T>
Envelope<T> envelope(const Task& task, const T* const x)
{
  using std::pow;
  if (task.form == HoekBrownForm::as_paper)
    return {T(task.sigma_ci), x[0], x[2], x[1], pow(x[1], 1.0 / x[2]), task.reference};
  const T a = task.form == HoekBrownForm::intact ? T(0.5) : x[2];
  if (task.reference == 0.0)
    return {x[0], x[1], a, T(1.0), T(1.0), task.reference};
  const T b = pow(x[1], 1.0 / a);
  return {x[0], (1.0 - b) * x[0] / -task.reference, a, x[1], b, task.reference};
}

struct Bounds
{
  double lower;
  double upper;
};

template <int n>
std::array<Bounds, n> bounds(const Task& task)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<Bounds, n> result;
  result[0] = {least, infinity};
  result[1] = {least, task.form != HoekBrownForm::as_paper && task.reference < 0.0 ? 1.0 - least : infinity};
  if constexpr (n > 2)
    result[2] = {lowest_a, highest_a};
  return result;
}

bool is_on(const double bound, const double value)
{
  return std::isfinite(bound) && std::abs(value - bound) <= 1e-7 * std::max(1.0, std::abs(bound));
}

/// Curved and straight, steep and flat; through the tension point and above it.
template <int n>
std::vector<std::array<double, n>> starting_points(const Task& task, const std::vector<EnvelopePoint>& points)
{
  const auto lowest = *std::ranges::min_element(
    points, [](const auto& one, const auto& other) { return std::abs(one.sigma_3) < std::abs(other.sigma_3); });
  const double strength = std::max(lowest.sigma_1 - lowest.sigma_3, 1e-3);
  const double through_tension = std::min(-task.reference / strength, 0.9);
  std::vector<std::array<double, n>> starts;
  for (const double a : {0.5, 0.25, 0.8})
    for (const double m : {8.0, 30.0})
      {
        std::array<double, n> x;
        if (task.form == HoekBrownForm::as_paper)
          x[0] = m, x[1] = task.reference < 0.0 ? through_tension : 1.0;
        else
          {
            x[0] = m < 10.0 ? strength : 1.5 * strength;
            x[1] = task.reference < 0.0 ? (m < 10.0 ? through_tension : 0.3) : m;
          }
        if constexpr (n > 2)
          x[2] = a;
        starts.push_back(x);
      }
  return starts;
}

template <int n>
struct Residual
{
  Task task;
  EnvelopePoint point;

  template <typename T>
  bool operator()(const T* const x, T* const residual) const
  {
    *residual = envelope(task, x).sigma_1(point.sigma_3) - point.sigma_1;
    return true;
  }
};

/// The variables that sit on a bound.
template <int n>
std::vector<int> held_by_bounds(const Task& task, const std::array<double, n>& x)
{
  const auto limits = bounds<n>(task);
  std::vector<int> held;
  for (int i = 0; i < n; ++i)
    if (is_on(limits[std::size_t(i)].lower, x[std::size_t(i)]) ||
        is_on(limits[std::size_t(i)].upper, x[std::size_t(i)]))
      held.push_back(i);
  return held;
}

template <int n>
struct Descent
{
  std::array<double, n> x;
  double cost;
};

/// Descends to the next minimum from x; infinite cost if there is none.
template <int n>
Descent<n> descend(const Task& task, const std::vector<EnvelopePoint>& points, std::array<double, n> x,
                   const std::vector<int>& held)
{
  ceres::Problem problem;
  for (const auto& point : points)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual<n>, 1, n>(new Residual<n>{task, point}), nullptr,
                             x.data());
  const auto limits = bounds<n>(task);
  for (int i = 0; i < n; ++i)
    {
      problem.SetParameterLowerBound(x.data(), i, limits[std::size_t(i)].lower);
      if (std::isfinite(limits[std::size_t(i)].upper))
        problem.SetParameterUpperBound(x.data(), i, limits[std::size_t(i)].upper);
    }
  if (!held.empty())
    problem.SetManifold(x.data(), new ceres::SubsetManifold(n, held));

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 2000;
  options.max_num_consecutive_invalid_steps = 2000; // the usual 5 ends with a message on stderr, however silent
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {x, summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity()};
}

template <int n>
std::optional<std::array<double, n>> optimum(const Task& task, const std::vector<EnvelopePoint>& points)
{
  Descent<n> best{{}, std::numeric_limits<double>::infinity()};
  const auto keep_if_better = [&](const Descent<n>& other) {
    if (other.cost < best.cost)
      best = other;
  };
  for (const auto& start : starting_points<n>(task, points))
    keep_if_better(descend<n>(task, points, start, {}));
  if (!std::isfinite(best.cost))
    return std::nullopt;

  // Steps cut off at a bound can end short of the minimum along it: go on with those variables held, then free again.
  for (int round = 0; round < 2; ++round)
    {
      const auto held = held_by_bounds<n>(task, best.x);
      if (held.empty() || held.size() == n)
        break;
      keep_if_better(descend<n>(task, points, best.x, held));
      keep_if_better(descend<n>(task, points, best.x, {}));
    }
  return best.x;
}

/// n: number of free parameters.
template <int n>
FitOrReason<HoekBrownFit> fit(const Task& task, const std::vector<EnvelopePoint>& points, const double unit)
{
  const auto x = optimum<n>(task, points);
  if (!x)
    return {std::nullopt, "the least-squares solver found no envelope"};

  // Values and derivatives at the optimum; a variable on its bound is held there.
  using Jet = ceres::Jet<double, n>;
  std::array<Jet, n> variables;
  std::vector<Eigen::Index> free;
  const auto held = held_by_bounds<n>(task, *x);
  for (int i = 0; i < n; ++i)
    {
      variables[std::size_t(i)] = Jet((*x)[std::size_t(i)], i);
      if (!contains(held, i))
        free.push_back(i);
    }
  const auto at_optimum = envelope(task, variables.data());
  Eigen::MatrixXd jacobian(Eigen::Index(points.size()), Eigen::Index(free.size()));
  std::vector<double> fitted;
  std::vector<EnvelopePoint> in_pascal;
  double sum_of_squares = 0.0;
  for (const auto& point : points)
    {
      const Jet sigma_1 = at_optimum.sigma_1(point.sigma_3);
      jacobian.row(Eigen::Index(fitted.size())) = sigma_1.v(free).transpose();
      sum_of_squares += (point.sigma_1 - sigma_1.a) * (point.sigma_1 - sigma_1.a);
      fitted.push_back(sigma_1.a * unit);
      in_pascal.push_back({point.sigma_3 * unit, point.sigma_1 * unit});
    }

  const Jet s = at_optimum.s();
  const std::array<Jet, 6> quantities{at_optimum.sigma_ci * unit,
                                      at_optimum.m,
                                      s,
                                      at_optimum.a,
                                      at_optimum.sigma_ci * pow(s, at_optimum.a) * unit,
                                      -s * at_optimum.sigma_ci / at_optimum.m * unit};
  Eigen::MatrixXd gradients(Eigen::Index(quantities.size()), Eigen::Index(free.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    gradients.row(Eigen::Index(i)) = quantities[i].v(free).transpose();
  const auto half_width = half_widths(jacobian, sum_of_squares, n, gradients);

  HoekBrownFit result;
  result.form = task.form;
  result.with_tension_point = false;
  const auto estimate = [&](const std::size_t i, const std::string& reason) -> Estimate {
    return {quantities[i].a, reason.empty() ? half_width[i] : Figure{std::nullopt, reason}};
  };
  const bool as_paper = task.form == HoekBrownForm::as_paper;
  const auto on_zero = [](const double value) { return value <= 1e-6 ? "it sits on its bound, 0" : ""; };
  result.sigma_ci =
    estimate(0, as_paper ? "it is the measured uniaxial compressive strength" : on_zero(at_optimum.sigma_ci.a));
  result.m = estimate(1, on_zero(at_optimum.m.a));
  result.s = estimate(2, as_paper ? on_zero(s.a) : "it is 1 by definition");
  const double a = at_optimum.a.a;
  result.a = estimate(3, task.form == HoekBrownForm::intact ? "it is 0.5 by definition"
                         : is_on(lowest_a, a)               ? fmt::format("it sits on its bound, {}", lowest_a)
                         : is_on(highest_a, a)              ? fmt::format("it sits on its bound, {}", highest_a)
                                                            : "");
  result.uniaxial_compressive_strength = estimate(4, "");
  result.tensile_cut_off = estimate(5, result.m.half_width.value ? "" : result.m.half_width.reason);
  result.quality = quality(in_pascal, fitted, n);
  return {result, ""};
}

struct FormWords
{
  std::string_view name, title;
};

constexpr FormWords words_of_forms[] = {{"as_paper", "s and a free"}, // by their enumerators
                                        {"intact", "intact"},
                                        {"general", "a free"},
                                        {"intact_by_regression", "intact, regression"}};
} // namespace

std::string name(const HoekBrownForm form) { return std::string(words_of_forms[std::size_t(form)].name); }

std::string title(const HoekBrownForm form) { return std::string(words_of_forms[std::size_t(form)].title); }

std::string title_of_form(const std::string& name_in_files)
{
  const auto* const form = std::ranges::find(words_of_forms, name_in_files, &FormWords::name);
  return form == std::end(words_of_forms) ? "Mohr–Coulomb" : std::string(form->title);
}

double hoek_brown_sigma_1(const double sigma_3, const double sigma_ci, const double m, const double s, const double a)
{
  const double bracket = m * sigma_3 / sigma_ci + s;
  return bracket < 0.0 ? std::numeric_limits<double>::quiet_NaN() : sigma_3 + sigma_ci * std::pow(bracket, a);
}

double HoekBrownFit::sigma_1(const double sigma_3) const
{
  return hoek_brown_sigma_1(sigma_3, sigma_ci.value, m.value, s.value, a.value);
}

FitOrReason<HoekBrownFit> fit_hoek_brown(const StrengthData& data, const HoekBrownForm form,
                                         const bool with_tension_point)
{
  auto points = data.points;
  if (data.uniaxial_compressive_strength)
    if (const auto objection = objection_to("uniaxial compressive strength", *data.uniaxial_compressive_strength);
        !objection.empty())
      return {std::nullopt, objection};
  if (form == HoekBrownForm::as_paper && !data.uniaxial_compressive_strength)
    return {std::nullopt, "sigma_ci is the measured uniaxial compressive strength, and none was measured"};
  if (with_tension_point)
    {
      if (!data.tensile_strength)
        return {std::nullopt, "no tensile strength was measured"};
      if (const auto objection = objection_to("tensile strength", *data.tensile_strength); !objection.empty())
        return {std::nullopt, objection};
      points.push_back({-*data.tensile_strength, 0.0});
    }
  const int n_parameters = form == HoekBrownForm::intact ? 2 : 3;
  if (const auto objection = objection_to(points, n_parameters); !objection.empty())
    return {std::nullopt, objection};

  double unit = 0.0;
  double reference = 0.0;
  for (const auto& point : points)
    {
      unit = std::max({unit, std::abs(point.sigma_1), std::abs(point.sigma_3)});
      reference = std::min(reference, point.sigma_3);
    }
  for (auto& point : points)
    point = {point.sigma_3 / unit, point.sigma_1 / unit};
  const Task task{form, reference / unit, data.uniaxial_compressive_strength.value_or(unit) / unit};
  auto result = n_parameters == 2 ? fit<2>(task, points, unit) : fit<3>(task, points, unit);
  if (result.fit)
    result.fit->with_tension_point = with_tension_point;
  return result;
}

FitOrReason<HoekBrownFit> regress_hoek_brown(const StrengthData& data)
{
  constexpr int n_parameters = 2;
  if (const auto objection = objection_to(data.points, n_parameters); !objection.empty())
    return {std::nullopt, objection};
  const auto n = Eigen::Index(data.points.size());
  Eigen::MatrixXd jacobian(n, n_parameters);
  Eigen::VectorXd squares(n); // in MPa, so that both columns are of like size
  for (Eigen::Index i = 0; i < n; ++i)
    {
      const auto& [sigma_3, sigma_1] = data.points[std::size_t(i)];
      jacobian.row(i) << sigma_3 / mega, 1.0;
      squares[i] = std::pow((sigma_1 - sigma_3) / mega, 2);
    }
  const Eigen::VectorXd line = jacobian.colPivHouseholderQr().solve(squares);
  const double slope = line[0];
  const double sigma_ci = std::sqrt(line[1]);
  if (!(slope > 0.0 && sigma_ci > 0.0))
    return {std::nullopt,
            fmt::format("the line through (sigma_1 - sigma_3)² over sigma_3 has the slope {:.3g} MPa and begins "
                        "at {:.3g} MPa²; both must be above 0",
                        slope, line[1])};

  Eigen::MatrixXd gradients(3, n_parameters);
  gradients.row(0) << 0.0, 0.5 / sigma_ci;
  gradients.row(1) << 1.0 / sigma_ci, -0.5 * slope / std::pow(sigma_ci, 3);
  gradients.row(2) << line[1] / (slope * slope), -1.0 / slope;
  const auto half_width = half_widths(jacobian, (squares - jacobian * line).squaredNorm(), n_parameters, gradients);
  const auto in_pascal = [](Figure figure) {
    if (figure.value)
      *figure.value *= mega;
    return figure;
  };
  HoekBrownFit fit;
  fit.form = HoekBrownForm::regressed;
  fit.with_tension_point = false;
  fit.sigma_ci = fit.uniaxial_compressive_strength = {sigma_ci * mega, in_pascal(half_width[0])};
  fit.m = {slope / sigma_ci, half_width[1]};
  fit.s = {1.0, {std::nullopt, "it is 1 by definition"}};
  fit.a = {0.5, {std::nullopt, "it is 0.5 by definition"}};
  fit.tensile_cut_off = {-line[1] / slope * mega, in_pascal(half_width[2])};
  const auto fitted = mapped<double>(data.points, [&](const auto& point) { return fit.sigma_1(point.sigma_3); });
  if (std::ranges::any_of(fitted, [](const double sigma_1) { return std::isnan(sigma_1); }))
    return {std::nullopt, "a point lies beyond the tensile cut-off of the regression"};
  fit.quality = quality(data.points, fitted, n_parameters);
  return {fit, ""};
}

RockMassConstants rock_mass_constants(const double m_i, const double strength_index, const double disturbance)
{
  return {m_i * std::exp((strength_index - 100.0) / (28.0 - 14.0 * disturbance)),
          std::exp((strength_index - 100.0) / (9.0 - 3.0 * disturbance)),
          0.5 + (std::exp(-strength_index / 15.0) - std::exp(-20.0 / 3.0)) / 6.0};
}

std::optional<double> rock_constant(const std::vector<EnvelopePoint>& in_compression)
{
  const auto is_confined = [](const EnvelopePoint& point) { return point.sigma_3 > 0.0; };
  const auto uniaxial = std::ranges::find_if_not(in_compression, is_confined);
  if (uniaxial == in_compression.end() || std::ranges::none_of(in_compression, is_confined))
    return std::nullopt;
  const auto answer = fit_hoek_brown({in_compression, uniaxial->sigma_1, std::nullopt}, HoekBrownForm::intact, false);
  // No curve goes through a confined strength that exceeds the uniaxial one by its pressure or less.
  constexpr double on_its_bound = 1e-6;
  return answer.fit && answer.fit->m.value > on_its_bound ? std::optional(answer.fit->m.value) : std::nullopt;
}
} // namespace feldspar
