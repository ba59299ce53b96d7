#pragma once

#include "base/body.h"
#include "dem/lab/laboratory_protocol.h"
#include "laboratory/kinds.h"

#include <string>
#include <string_view>
#include <vector>

/// The laboratory tests: each is one constant in the file of its name. To add one: its file, its line here and in the
/// list of protocols.cc, its file in CMakeLists.txt.
namespace feldspar
{
/// Two rigid grips, each at half the strain rate times the free length between them. docs/theory.md §4.2.
extern const LaboratoryProtocol direct_tension;
/// Two platens, each at half the strain rate times the height; no side walls. docs/theory.md §4.1.
extern const LaboratoryProtocol uniaxial_compression;
/// Side walls that hold the pressure, platens as in uniaxial compression. docs/theory.md §4.3.
extern const LaboratoryProtocol triaxial_compression;
/// A disc cut out of the specimen, pressed together by pads of its own grains. docs/theory.md §4.4.
extern const LaboratoryProtocol brazilian;

/// A beam with a notch on two rollers, pressed by a third: K_IC by Srawley's formula. docs/theory.md §4.8.
extern const LaboratoryProtocol three_point_bending;
/// A half disc with a notch, bent in the same way: K_IC by the suggested method of the ISRM. docs/theory.md §4.8.
extern const LaboratoryProtocol semicircular_bending;
/// A plate with a crack in its middle, pulled by grips: K_IC by the formula of Feddersen and Tada. docs/theory.md §4.8.
extern const LaboratoryProtocol centre_cracked_plate;
/// Two halves of a box that move past each other under a constant normal stress. docs/theory.md §4.9.
extern const LaboratoryProtocol direct_shear;
/// Platens and side walls that follow a table of stages. docs/theory.md §4.11.
extern const LaboratoryProtocol own_loading;

/// A body on a rough plate that is tilted until it slides by its weight. docs/theory.md §4.12.
extern const LaboratoryProtocol tilt;

/// All of them.
const std::vector<const LaboratoryProtocol*>& laboratory_protocols();

/// The entries of section Tests: those of single protocols, each once, then those of all.
std::vector<Entry<TestParameters>> test_entries();

/// The tests that alone take an entry of section Tests; none named where all do.
std::vector<TestKind> kinds_that_take(std::string_view entry);

/// Kinds of the tests, in the same order.
const std::vector<TestKind>& test_kinds();

/// The protocol of a kind. Throws std::logic_error for a kind that is not in the list.
const LaboratoryProtocol& protocol_of(const TestKind& kind);

/// Throws InputError where a body of this width and height [m] would not be pressed on the plate of the tilt test by its
/// weight, or would slide or topple at once.
void check_tilt(const TestParameters& wanted, double width, double height);

/// Why this test cannot be made on finite elements, and which can, in the words of an error of the input; empty if it
/// can.
std::string objection_to_finite_elements(const TestKind& kind);
/// The same for a specimen of clumps.
std::string objection_to_clumps(const TestKind& kind);
/// The same for a specimen of grains of this shape.
std::string objection_to_grains(const TestKind& kind, Body body);
} // namespace feldspar
