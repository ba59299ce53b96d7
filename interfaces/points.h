#pragma once

#include "interfaces/answer_log.h"

#include <feldspar/feldspar.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Representative volumes at the points of a foreign mesh, which asks point by point and keeps one number a point, the token of
/// its state. docs/material.md.
namespace feldspar::interfaces
{
/// Moment at which bonds break.
enum class Breaking
{
  lagged,        ///< at the strain that was accepted, when the next increment begins
  each_iteration ///< at each strain that is tried
};

struct Answer
{
  bool in_equilibrium =
    false; ///< else the increment is to be cut: stress of the state before, tangent of the intact volume
  std::uint64_t token = 0;
  std::vector<double> stress;  ///< [n_voigt]
  std::vector<double> tangent; ///< rows first, [n_voigt²]
  Damage damage;               ///< of the state from which it was asked
};

/// The points of a job that consist of one rock. Any number of threads, each with a point of its own.
class Points
{
public:
  /// Packs the volumes of an input (Sample/Realisations of them, by the first of Seeds/Seeds). log: name of the file that a
  /// restart needs.
  Points(const std::string& input_file, std::string log, Breaking breaking);

  int dimension() const { return rocks.front().dimension(); }

  /// The response of a point to a strain (Voigt, engineering shear), from the state of a token, at `before`. Token 0 with a
  /// strain that is not zero is that of a restarted job: the point goes on from its strain in the log. Throws Error.
  Answer respond(PointName name, std::uint64_t parent, std::span<const double> before, std::span<const double> strain);

private:
  struct Point
  {
    Rve accepted; ///< with what broke at its strain
    std::uint64_t accepted_token = 0;
    std::vector<double> accepted_strain = {}; ///< of the answer; empty at rest
    std::optional<Trial> tried = {};
    std::uint64_t tried_token = 0;
    std::vector<double> tried_strain = {};
  };

  Point at_rest(PointName name) const;
  Trial answer(const Point& point, std::span<const double> strain) const
  {
    return breaking == Breaking::lagged ? point.accepted.trial(strain, true) : point.accepted.relax(strain, true);
  }
  /// The point, and the log that is there from the first call on.
  Point& point_of(PointName name, bool is_restarted);
  void accept_tried(Point& point) const;
  /// Brings a point to the end of a way of answers.
  void go(Point& point, PointName name, const std::vector<std::uint64_t>& way) const;

  Input input;
  Breaking breaking;
  std::vector<Rve> rocks;
  std::uint64_t seed;
  std::string log_file;
  std::unique_ptr<AnswerLog> log;
  std::mutex of_points;
  std::vector<std::vector<std::unique_ptr<Point>>> points; ///< by element and point
};
} // namespace feldspar::interfaces
