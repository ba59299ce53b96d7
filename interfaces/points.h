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
#include <unordered_map>
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

/// Numbers that a code keeps at a point: the token, then the fields of Damage.
inline constexpr std::size_t n_state_variables = 11;

/// In arrays, as a job asks many points in turn: what lies in one place is read at once.
struct Answer
{
  /// Else the increment is to be cut: token and stress are those of the state before, the tangent is the intact volume's.
  bool in_equilibrium = false;
  std::array<double, n_state_variables> states{}; ///< the token, and the damage of the state from which it was asked
  std::array<double, 6> stress{};                 ///< [n_voigt]
  std::array<double, 36> tangent{};               ///< rows first, [n_voigt²]

  std::uint64_t token() const { return std::uint64_t(states[0]); }
};

/// The points of a job that consist of one rock. Any number of threads, each with a point of its own.
class Points
{
public:
  /// Packs the volumes of an input (Sample/Realisations of them, by the first of Seeds/Seeds). log: name of the file that a
  /// restart needs.
  Points(const std::string& input_file, std::string log, Breaking breaking);

  int dimension() const { return n_components == 3 ? 2 : 3; }

  /// The response of a point to a strain (Voigt, engineering shear), from the state of a token, at `before`. Token 0 with a
  /// strain that is not zero is that of a restarted job: the point goes on from its strain in the log. The
  /// answer stands until the next one of the point. Throws Error.
  const Answer& respond(PointName name, std::uint64_t parent, std::span<const double> before,
                        std::span<const double> strain);

private:
  struct Point
  {
    Rve accepted; ///< with what broke at its strain
    std::uint64_t accepted_token = 0;
    std::array<double, 6> accepted_strain = {}; ///< of the answer
    std::optional<Trial> tried = {};
    std::array<double, 6> tried_strain = {};
    Answer answer = {}; ///< the last one
  };

  Point at_rest(PointName name) const;
  /// The damage of the accepted state among the state variables.
  static void tell_damage(Point& point);
  /// Tries a strain that was not accepted yet; without an equilibrium nothing stays tried.
  void attempt(Point& point, std::span<const double> strain) const;
  /// The point, and the log that is there from the first call on.
  Point& point_of(PointName name, bool is_restarted);
  void accept_tried(Point& point) const;
  /// Brings a point to the end of a way of answers.
  void go(Point& point, PointName name, const std::vector<std::uint64_t>& way) const;

  Input input;
  Breaking breaking;
  std::vector<Rve> rocks;
  std::size_t n_components = 0; ///< of strain and stress
  std::uint64_t seed;
  std::string log_file;
  std::unique_ptr<AnswerLog> log;
  std::mutex of_points;
  /// Neighbours in the mesh are neighbours in the table, whatever the size of their numbers.
  struct Place
  {
    std::size_t operator()(const std::uint64_t number) const { return 8 * (number >> 32U) + (number & 0xffffffffU); }
  };
  std::unordered_map<std::uint64_t, Point, Place> points;
};

/// The input of a material in the working folder; names in the input of a job may have lost their case. Throws Error.
std::string input_file_of(const std::string& material);
} // namespace feldspar::interfaces
