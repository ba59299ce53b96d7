#include "app/input/parameter_table.h"

#include "app/input/quantity.h"
#include "base/input_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::string_view none = "none";
constexpr std::string_view free_component = "free";
constexpr std::size_t most_seeds = 10000;

/// An interval as it is written in books: '[' and ']' take the bound in, '(' and ')' leave it out.
struct Range
{
  char left;
  double lower;
  double upper;
  char right;

  bool contains(const double value) const
  {
    return (left == '[' ? value >= lower : value > lower) && (right == ']' ? value <= upper : value < upper);
  }

  /// With `unit` (led by a space, or empty) behind each number.
  std::string text(const std::string_view unit) const
  {
    if (upper == infinity)
      return fmt::format("{} {}{}", left == '[' ? ">=" : ">", lower, unit);
    return fmt::format("{}{}{}, {}{}{}", left, lower, unit, upper, unit, right);
  }

  /// What an error says.
  std::string demand(const std::string_view unit) const
  {
    return fmt::format("must {} {}", upper == infinity ? "be" : "lie in", text(unit));
  }
};

constexpr Range above_zero{'(', 0.0, infinity, ')'};
constexpr Range from_zero{'[', 0.0, infinity, ')'};
constexpr Range fraction{'[', 0.0, 1.0, ']'};

std::uint64_t parse_count(const std::string_view text)
{
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("\"{}\" is not a non-negative integer below 2^64", text));
  return value;
}

/// `member` gives the path in an Input.
template <typename Member>
Parameter file_parameter(const std::string_view section, const std::string_view entry, const std::string_view meaning,
                         const Member& member)
{
  return {section,
          entry,
          "",
          "none, or a file",
          meaning,
          [=](Input& input, const std::string_view text) {
            const std::filesystem::path path = text.empty() || text == none ? "" : input.folder / text;
            std::error_code ignored;
            if (!path.empty() && !std::filesystem::exists(path, ignored))
              throw InputError(fmt::format("there is no file {}", path.string()));
            if (std::filesystem::is_directory(path, ignored))
              throw InputError(fmt::format("{} is a folder; a file is needed", path.string()));
            member(input) = path.string();
          },
          [=](const Input& input) { return member(input).empty() ? std::string(none) : member(input); }};
}

/// The members of one part of Input under the heading of one section. Each function makes one kind of parameter.
template <typename Part>
struct Section
{
  std::string_view name;
  Part Input::*part;

  Parameter quantity(const std::string_view entry, double Part::*const member, const Dimension& dimension,
                     const std::string_view unit, const Range& range, const std::string_view meaning) const
  {
    const std::string spaced_unit = fmt::format(" {}", unit);
    return make(
      entry, std::string(unit), range.text(spaced_unit), meaning, member,
      [=](const std::string_view text) {
        const double value = parse_quantity(text, dimension);
        const Range si_range{range.left, to_si(range.lower, unit, dimension), to_si(range.upper, unit, dimension),
                             range.right};
        if (!si_range.contains(value))
          throw InputError(range.demand(spaced_unit));
        return value;
      },
      [=](const double value) { return format_quantity(value, unit, dimension); });
  }

  Parameter number(const std::string_view entry, double Part::*const member, const Range& range,
                   const std::string_view meaning) const
  {
    return make(
      entry, "", range.text(""), meaning, member,
      [=](const std::string_view text) { return read_number(text, range, range.demand("")); }, format_number);
  }

  Parameter optional_number(const std::string_view entry, std::optional<double> Part::*const member, const Range& range,
                            const std::string_view meaning) const
  {
    return make(
      entry, "", fmt::format("none, or {}", range.text("")), meaning, member,
      [=](const std::string_view text) -> std::optional<double> {
        if (text == none)
          return std::nullopt;
        return read_number(text, range, fmt::format("{}, or be none", range.demand("")));
      },
      [](const std::optional<double>& value) { return value ? format_number(*value) : std::string(none); });
  }

  Parameter optional_quantity(const std::string_view entry, std::optional<double> Part::*const member,
                              const Dimension& dimension, const std::string_view unit, const Range& range,
                              const std::string_view meaning) const
  {
    const std::string spaced_unit = fmt::format(" {}", unit);
    return make(
      entry, std::string(unit), fmt::format("none, or {}", range.text(spaced_unit)), meaning, member,
      [=](const std::string_view text) -> std::optional<double> {
        if (text == none)
          return std::nullopt;
        const double value = parse_quantity(text, dimension);
        const Range si_range{range.left, to_si(range.lower, unit, dimension), to_si(range.upper, unit, dimension),
                             range.right};
        if (!si_range.contains(value))
          throw InputError(fmt::format("{}, or be none", range.demand(spaced_unit)));
        return value;
      },
      [=](const std::optional<double>& value) {
        return value ? format_quantity(*value, unit, dimension) : std::string(none);
      });
  }

  Parameter integer(const std::string_view entry, unsigned int Part::*const member, const Range& range,
                    const std::string_view meaning) const
  {
    return make(
      entry, "", fmt::format("integer in {}", range.text("")), meaning, member,
      [=](const std::string_view text) {
        unsigned int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !range.contains(value))
          throw InputError(fmt::format("must be an integer in {}", range.text("")));
        return value;
      },
      [](const unsigned int value) { return std::to_string(value); });
  }

  template <typename T>
  Parameter choice(const std::string_view entry, T Part::*const member,
                   const std::vector<std::pair<std::string, T>>& options, const std::string_view meaning) const
  {
    std::string range = options.front().first;
    if (options.size() == 1)
      range += " (the only choice in this version)";
    for (std::size_t i = 1; i < options.size(); ++i)
      range += " or " + options[i].first;
    return make(
      entry, "", range, meaning, member,
      [=](const std::string_view text) {
        for (const auto& [option, value] : options)
          if (option == text)
            return value;
        throw InputError(fmt::format("must be {}", range));
      },
      [=](const T& wanted) {
        for (const auto& [option, value] : options)
          if (value == wanted)
            return option;
        return std::string();
      });
  }

  Parameter file(const std::string_view entry, std::string Part::*const member, const std::string_view meaning) const
  {
    return file_parameter(
      name, entry, meaning, [ =, part = part ](auto& input) -> auto& { return (input.*part).*member; });
  }

private:
  static double read_number(const std::string_view text, const Range& range, const std::string& demand)
  {
    if (text.find(' ') != std::string_view::npos)
      throw InputError(fmt::format("is a number without unit; it {}", demand));
    const double value = parse_number(text);
    if (!range.contains(value))
      throw InputError(demand);
    return value;
  }

  template <typename T, typename Read, typename Write>
  Parameter make(const std::string_view entry, const std::string& unit, const std::string& range,
                 const std::string_view meaning, T Part::*const member, const Read& read, const Write& write) const
  {
    return {name,
            entry,
            unit,
            range,
            meaning,
            [=, part = part](Input& input, const std::string_view text) { (input.*part).*member = read(text); },
            [=, part = part](const Input& input) { return write((input.*part).*member); }};
  }
};

std::vector<TestKind> read_tests(const std::string_view text)
{
  const std::vector<TestKind>& known = test_kinds();
  std::vector<TestKind> tests;
  for (const std::string_view piece : split_at_commas(text))
    {
      const auto kind = std::find_if(known.begin(), known.end(), [&](const TestKind& k) { return k.name == piece; });
      if (kind == known.end())
        throw InputError(fmt::format("\"{}\" is not a test; list one or more of {}", piece, names(known)));
      if (std::find(tests.begin(), tests.end(), *kind) != tests.end())
        throw InputError(fmt::format("{} is listed twice", piece));
      tests.push_back(*kind);
    }
  return tests;
}

std::vector<double> read_confinements(const std::string_view text)
{
  const std::vector<double> pressures = parse_quantities(text, stress);
  for (auto p = pressures.begin(); p != pressures.end(); ++p)
    {
      if (*p <= 0.0)
        throw InputError(
          fmt::format("must be > 0 MPa each; without confinement it is {}", uniaxial_compression.kind.name));
      if (std::find(pressures.begin(), p, *p) != p)
        throw InputError(fmt::format("{} is given twice", format_quantity(*p, "MPa", stress)));
    }
  return pressures;
}

std::string write_confinements(const std::vector<double>& pressures)
{
  std::string text;
  for (const double p : pressures)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", format_number(p / 1e6));
  return text + " MPa";
}

/// Any entry of a number or a choice; a list of lists, or of files, would not be understood.
std::string read_variant_entry(const std::string_view text)
{
  if (text == none)
    return "";
  const std::size_t slash = text.find('/');
  const Parameter* parameter =
    slash == std::string_view::npos ? nullptr : find_parameter(text.substr(0, slash), text.substr(slash + 1));
  const bool one_value =
    parameter != nullptr &&
    (parameter->section == "Specimen" || parameter->section == "Flat joint" ||
     parameter->section == "Particle contact" || parameter->section == "Dynamics" || parameter->section == "Tests" ||
     parameter->section == "Strain path" || parameter->section == "Representative volume") &&
    !parameter->entry.ends_with("file") && parameter->entry != "File" && parameter->entry != "List" &&
    parameter->entry != "Confinements" && parameter->entry != "Steps between checkpoints" &&
    parameter->entry != "Dimension" && parameter->entry != "Shape";
  if (!one_value)
    throw InputError("is not an entry that can vary; write Section/Entry, e.g. Flat joint/Segments");
  return std::string(text);
}

std::vector<std::string> read_variant_values(std::string_view text)
{
  std::vector<std::string> values;
  if (text == none)
    return values;
  for (;;)
    {
      const std::size_t semicolon = text.find(';');
      values.emplace_back(trim(text.substr(0, semicolon)));
      if (semicolon == std::string_view::npos)
        return values;
      text.remove_prefix(semicolon + 1);
    }
}

std::vector<std::uint64_t> read_seeds(const std::string_view text)
{
  std::vector<std::uint64_t> seeds;
  for (const std::string_view piece : split_at_commas(text))
    {
      const std::size_t dots = piece.find("..");
      const std::uint64_t first = parse_count(piece.substr(0, dots));
      const std::uint64_t last = dots == std::string_view::npos ? first : parse_count(piece.substr(dots + 2));
      if (last < first)
        throw InputError(fmt::format("the range {} runs backwards", piece));
      if (last - first >= most_seeds - seeds.size())
        throw InputError(fmt::format("must be at most {} seeds", most_seeds));
      for (std::uint64_t i = 0; i <= last - first; ++i)
        seeds.push_back(first + i);
    }
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : seeds)
    if (!seen.insert(seed).second)
      throw InputError(fmt::format("seed {} is given twice", seed));
  return seeds;
}

std::vector<std::optional<double>> read_direction(const std::string_view text)
{
  std::vector<std::optional<double>> direction;
  if (text == none)
    return direction;
  for (const std::string_view piece : split_at_commas(text))
    direction.push_back(piece == free_component ? std::nullopt : std::optional(parse_number(piece)));
  if (direction.size() != 3 && direction.size() != 6)
    throw InputError(fmt::format("{} component(s); there must be 3: xx, yy, xy; in three dimensions 6: xx, yy, zz, yz, "
                                 "xz, xy",
                                 direction.size()));
  if (std::none_of(direction.begin(), direction.end(), [](const auto& entry) { return entry.value_or(0.0) != 0.0; }))
    throw InputError("at least one component must be a number other than 0");
  return direction;
}

std::string write_direction(const std::vector<std::optional<double>>& direction)
{
  std::string text;
  for (const auto& component : direction)
    text += (text.empty() ? "" : ", ") + (component ? format_number(*component) : std::string(free_component));
  return text.empty() ? std::string(none) : text;
}

std::vector<Parameter> make_parameter_table()
{
  using S = SpecimenParameters;
  using F = FlatJointParameters;
  using P = ParticleContactParameters;
  using D = DynamicsParameters;
  using T = TestParameters;
  using C = ContactParameters;
  using R = StrainPathParameters;
  using E = EquilibriumParameters;
  using M = SampleParameters;
  using K = ContinuumParameters;
  const Section<S> specimen{"Specimen", &Input::specimen};
  const Section<F> flat_joint{"Flat joint", &Input::flat_joint};
  const Section<P> particle_contact{"Particle contact", &Input::particle_contact};
  const Section<D> dynamics{"Dynamics", &Input::dynamics};
  const Section<T> tests{"Tests", &Input::tests};
  const Section<C> contact{"Contact", &Input::contact};
  const Section<C> contact_path{"Contact path", &Input::contact};
  const Section<R> strain_path{"Strain path", &Input::strain_path};
  const Section<E> equilibrium{"Representative volume", &Input::equilibrium};
  const Section<M> sample{"Sample", &Input::sample};
  const Section<K> continuum{"Continuum", &Input::continuum};

  return {
    specimen.choice<unsigned int>("Dimension", &S::dimension, {{"2", 2}, {"3", 3}},
                                  "2: discs in the plane, one metre thick; 3: spheres"),
    specimen.choice<std::string>(
      "Shape", &S::shape, {{"box", "box"}, {"cylinder", "cylinder"}, {"periodic", "periodic"}},
      "box or, in three dimensions, upright cylinder with the width as diameter: between "
      "walls, for laboratory tests; periodic: a cell that repeats itself, for `feldspar rve`"),
    specimen.quantity("Width", &S::width, length, "mm", above_zero,
                      "of the box or cell, across the axis of the tests; at least four radii of the largest grain"),
    specimen.quantity("Height", &S::height, length, "mm", above_zero,
                      "of the box or cell, along the axis of the tests; at least four radii of the largest grain"),
    specimen.quantity("Minimum radius", &S::minimum_radius, length, "mm", above_zero, "of the grains"),
    specimen.number("Radius ratio", &S::radius_ratio, {'[', 1.0, infinity, ')'},
                    "largest over smallest radius; radii are drawn uniformly between them"),
    specimen.number(
      "Porosity", &S::porosity, {'(', 0.0, 1.0, ')'},
      "of the finished packing; with the radii it gives the number of grains; in three dimensions 0.36 unless "
      "it is given"),
    specimen.quantity("Density", &S::bulk_density, density, "kg/m^3", above_zero,
                      "of the rock as a body; a grain's is this over (1 - Porosity)"),
    specimen.number("Packing stress ratio", &S::packing_stress_ratio, {'(', 0.0, 0.1, ']'},
                    "mean stress in the packing over Particle contact/Modulus, before the joints are installed"),
    specimen.file("Packing file", &S::packing_file,
                  "grains packed elsewhere, a line `x y radius` in metres each; none makes a packing"),
    specimen.file("Specimen file", &S::specimen_file,
                  "a finished specimen.h5 to be tested, or, for `feldspar rve`, a volume of `feldspar multiscale "
                  "--extract`, whose path begins in the state it is in; none makes a specimen"),

    flat_joint.integer("Segments", &F::n_segments, {'[', 1.0, 32.0, ']'},
                       "of a face in two dimensions, each of which breaks by itself"),
    flat_joint.integer("Rings", &F::n_rings, {'[', 1.0, 16.0, ']'}, "of a face in three dimensions, of equal width"),
    flat_joint.integer("Sectors", &F::n_sectors, {'[', 3.0, 32.0, ']'},
                       "of each ring, of equal angle; each of Rings x Sectors elements breaks by itself"),
    flat_joint.quantity("Modulus", &F::modulus, stress, "GPa", above_zero,
                        "E; the normal stiffness is E over the sum of both radii"),
    flat_joint.number("Stiffness ratio", &F::stiffness_ratio, above_zero, "normal over shear stiffness"),
    flat_joint.number("Friction", &F::friction, from_zero, "coefficient, of broken segments"),
    flat_joint.number("Radius multiplier", &F::radius_multiplier, above_zero,
                      "half length of the face over the radius of the smaller grain"),
    flat_joint.quantity("Bond tensile strength", &F::bond_tensile_strength, stress, "MPa", from_zero,
                        "mean; a segment breaks in tension beyond it"),
    flat_joint.quantity("Bond tensile strength standard deviation", &F::bond_tensile_strength_deviation, stress, "MPa",
                        from_zero, "of the normal distribution, redrawn while negative"),
    flat_joint.quantity("Bond cohesion", &F::bond_cohesion, stress, "MPa", from_zero,
                        "mean; shear strength of a bond without normal stress"),
    flat_joint.quantity("Bond cohesion standard deviation", &F::bond_cohesion_deviation, stress, "MPa", from_zero,
                        "of the normal distribution, redrawn while negative"),
    flat_joint.quantity("Bond friction angle", &F::bond_friction_angle, angle, "deg", {'[', 0.0, 90.0, ')'},
                        "by which compression adds to the shear strength of a bond"),
    flat_joint.choice<StrengthDraw>(
      "Strength draw", &F::strength_draw,
      {{"per segment", StrengthDraw::per_segment}, {"per contact", StrengthDraw::per_contact}},
      "whether the segments of a face draw their strengths one by one or together"),
    flat_joint.optional_number("Installation gap ratio", &F::installation_gap_ratio, from_zero,
                               "largest gap that gets a joint, over the mean radius; instead of Coordination number"),
    flat_joint.optional_number("Coordination number", &F::coordination_number, above_zero,
                               "mean number of joints of a grain, from which the gap follows; the default holds in two "
                               "dimensions unless Installation gap ratio is given; in three that is 0.05 instead"),
    flat_joint.number("Gapped fraction", &F::gapped_fraction, fraction,
                      "share of the joints without bonds and with an initial gap"),
    flat_joint.number("Slit fraction", &F::slit_fraction, fraction,
                      "share of the joints without bonds whose faces touch; with Gapped fraction at most 1"),
    flat_joint.quantity("Initial gap", &F::initial_gap, length, "mm", from_zero, "of the gapped joints"),

    particle_contact.quantity("Modulus", &P::modulus, stress, "GPa", above_zero,
                              "of grains that touch without a face, and of the packing"),
    particle_contact.number("Stiffness ratio", &P::stiffness_ratio, above_zero, "normal over shear stiffness"),
    particle_contact.number("Friction", &P::friction, from_zero, "coefficient"),

    dynamics.number("Damping", &D::damping, {'[', 0.0, 1.0, ')'},
                    "local non-viscous: share of the unbalanced force set against the motion"),
    dynamics.number("Time step safety", &D::time_step_safety, {'(', 0.0, 1.0, ']'},
                    "time step over the least root of mass over stiffness"),

    {"Tests", "List", "", names(test_kinds()), "the tests to be made, separated by commas",
     [](Input& input, const std::string_view text) { input.test_list = read_tests(text); },
     [](const Input& input) { return names(input.test_list); }},
    {"Tests", "Confinements", "MPa", "> 0 MPa each", "pressures of the triaxial tests, separated by commas",
     [](Input& input, const std::string_view text) { input.confinements = read_confinements(text); },
     [](const Input& input) { return write_confinements(input.confinements); }},
    tests.quantity("Compression strain rate", &T::compression_strain_rate, rate, "1/s", above_zero, "magnitude"),
    tests.quantity("Tension strain rate", &T::tension_strain_rate, rate, "1/s", above_zero, "magnitude"),
    tests.quantity("Brazilian strain rate", &T::brazilian_strain_rate, rate, "1/s", above_zero,
                   "of the loaded diameter; magnitude"),
    tests.number("Compression sampling strain", &T::compression_sampling_strain, above_zero,
                 "axial strain between two rows of the curve"),
    tests.number("Tension sampling strain", &T::tension_sampling_strain, above_zero,
                 "axial strain between two rows of the curve"),
    tests.number("Brazilian sampling strain", &T::brazilian_sampling_strain, above_zero,
                 "strain of the diameter between two rows of the curve"),
    tests.number("Platen friction", &T::platen_friction, from_zero, "coefficient of the platens in compression"),
    tests.number("Seating transits", &T::seating_transits, above_zero,
                 "travel times of a wave along the specimen over which the confinement is raised"),
    tests.choice<LateralBoundary>("Lateral boundary", &T::lateral_boundary,
                                  {{"wall", LateralBoundary::wall}, {"membrane", LateralBoundary::membrane}},
                                  "of a cylinder in triaxial compression: a rigid wall held at the pressure, or the "
                                  "pressure itself on the outer grains"),
    tests.optional_quantity(
      "Intermediate stress", &T::intermediate_stress, stress, "MPa", above_zero,
      "on the second pair of sides of a box in three dimensions (true triaxial compression); none: the "
      "confinement"),
    tests.number("Brazilian length ratio", &T::brazilian_length_ratio, above_zero,
                 "length of the disc over its diameter, in three dimensions"),
    tests.number("Grip ratio", &T::grip_ratio, {'(', 0.0, 0.4, ']'}, "height of each grip over that of the specimen"),
    tests.number("Stop strain over peak strain", &T::stop_strain_over_peak_strain, {'(', 1.0, infinity, ')'},
                 "a test stops at this many times its strain at peak"),
    tests.optional_number("Stop strain", &T::stop_strain, above_zero,
                          "a test stops at this axial strain, instead of the rule above"),
    tests.optional_number("Stop stress over peak", &T::stop_stress_over_peak, {'(', 0.0, 1.0, ')'},
                          "a test stops when its deviator has fallen to this share of the peak's, instead of at a "
                          "multiple of the strain there; with Stop strain too, whichever comes first"),

    {"Tests", "Steps between checkpoints", "", "integer > 0", "after which `lab --resume` can take up a test",
     [](Input& input, const std::string_view text) {
       input.steps_between_checkpoints = parse_count(text);
       if (input.steps_between_checkpoints == 0)
         throw InputError("must be an integer > 0");
     },
     [](const Input& input) { return std::to_string(input.steps_between_checkpoints); }},

    {"Variants", "Entry", "", "none, or Section/Entry", "an entry that takes one value after the other",
     [](Input& input, const std::string_view text) { input.variant_entry = read_variant_entry(text); },
     [](const Input& input) { return input.variant_entry.empty() ? std::string(none) : input.variant_entry; }},
    {"Variants", "Values", "", "none, or values of that entry", "each of them, separated by semicolons",
     [](Input& input, const std::string_view text) { input.variant_values = read_variant_values(text); },
     [](const Input& input) {
       return input.variant_values.empty() ? std::string(none)
                                           : fmt::format("{}", fmt::join(input.variant_values, "; "));
     }},

    {"Seeds", "Seeds", "", "non-negative integers and ranges, such as 1, 5..7", "one specimen for each seed",
     [](Input& input, const std::string_view text) { input.seeds = read_seeds(text); },
     [](const Input& input) { return fmt::format("{}", fmt::join(input.seeds, ", ")); }},

    contact.quantity("Radius 1", &C::radius_1, length, "mm", above_zero, "of grain 1 of `feldspar contact`"),
    contact.quantity("Radius 2", &C::radius_2, length, "mm", above_zero, "of grain 2 of `feldspar contact`"),
    contact_path.file(
      "File", &C::path_file,
      "displacements since rest, a CSV with the columns normal_m,shear_m,rotation_rad; in three dimensions "
      "normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad"),

    strain_path.file(
      "File", &R::path_file,
      "points of the path of `feldspar rve`, a CSV with a column for each of xx,yy,xy (in three dimensions "
      "xx,yy,zz,yz,xz,xy): strain_xx (tensor shear) or stress_xx_Pa, tension positive; straight ways between; instead "
      "of Direction"),
    {"Strain path", "Direction", "", "none, or a number or free for each of xx, yy, xy (or xx, yy, zz, yz, xz, xy)",
     "of the strain (tensor shear, tension positive); a free component stays at the stress of the confinement",
     [](Input& input, const std::string_view text) { input.strain_path.direction = read_direction(text); },
     [](const Input& input) { return write_direction(input.strain_path.direction); }},
    strain_path.number("Size", &R::size, {'(', 0.0, largest_strain, ']'}, "of the strain at the end, over Direction"),
    strain_path.quantity("Confining pressure", &R::confining_pressure, stress, "MPa", from_zero,
                         "compression positive, on all sides before the strain begins; strains of Direction count from "
                         "there"),
    strain_path.number("Largest step", &R::largest_step, {'(', 0.0, largest_strain, ']'},
                       "of any component of the strain in one increment"),
    strain_path.choice<PathSolver>(
      "Solver", &R::solver,
      {{"event by event", PathSolver::event_by_event}, {"explicit", PathSolver::explicit_dynamics}},
      "from break to break without a rate, or explicit dynamics as in the laboratory"),
    strain_path.integer("Steps per millistrain", &R::steps_per_millistrain, {'[', 1.0, 1e8, ']'},
                        "of explicit dynamics, for 1e-3 of the largest component of the strain"),

    equilibrium.number("Event tolerance", &E::event_tolerance, {'[', 1e-12, 0.1, ']'},
                       "largest unbalanced over mean contact force, between breaks"),
    equilibrium.number("Final tolerance", &E::final_tolerance, {'[', 1e-12, 0.1, ']'},
                       "the same, of the stress that is handed out"),
    equilibrium.choice<BreakRule>("Break rule", &E::break_rule,
                                  {{"near worst", BreakRule::near_worst}, {"only worst", BreakRule::only_worst}},
                                  "whether segments with 0.98 of the worst overload break together with it"),
    equilibrium.integer("Most iterations", &E::most_iterations, {'[', 1.0, 1e6, ']'},
                        "by Newton's method in search of one equilibrium, before damped motion brings it nearer"),

    sample.choice<SampleGeometry>(
      "Geometry", &M::geometry,
      {{"plane", SampleGeometry::plane},
       {"plane strain", SampleGeometry::plane_strain},
       {"axisymmetric", SampleGeometry::axisymmetric},
       {"cylinder", SampleGeometry::cylinder}},
      "plane: volumes of discs, one metre thick; the others have volumes of spheres (Dimension = 3): plane strain "
      "lets nothing strain across the plane, axisymmetric is a cylinder by half of its section, cylinder the whole"),
    sample.choice<SampleMaterial>(
      "Material", &M::material,
      {{"grains", SampleMaterial::grains},
       {"linear elasticity", SampleMaterial::linear_elasticity},
       {"Mohr-Coulomb", SampleMaterial::mohr_coulomb}},
      "at the points of the sample of `feldspar multiscale`: the representative volume, or, "
      "for comparison, what Continuum says"),
    sample.file("Mesh file", &M::mesh_file,
                "of Gmsh (format 2 or 4, text), in metres, instead of Width, Height and both Elements: quadrilaterals "
                "with the lines of the physical groups left, right, bottom and top, in r-z axis, side, bottom and top "
                "with the axis at x = 0, or hexahedra about x = y = 0 along z with the surfaces side, bottom and top"),
    sample.quantity("Width", &M::width, length, "mm", above_zero,
                    "of the sample of `feldspar multiscale`; of a cylinder its diameter"),
    sample.quantity("Height", &M::height, length, "mm", above_zero, "of the sample, along the axis of the tests"),
    sample.integer("Elements across", &M::elements_across, {'[', 1.0, 10000.0, ']'},
                   "over the width; axisymmetric: over the radius; in a cylinder at least 3"),
    sample.integer("Elements along", &M::elements_along, {'[', 1.0, 10000.0, ']'}, "over the height"),
    sample.integer("Order", &M::order, {'[', 1.0, 2.0, ']'}, "of the elements"),
    sample.choice<bool>("Quadrature", &M::reduced_quadrature, {{"full", false}, {"reduced", true}},
                        "full: order + 1 points each way; reduced: as many as the order, which must be 2"),
    sample.choice<bool>("Platens", &M::rough_platens, {{"smooth", false}, {"rough", true}},
                        "whether the ends are held sideways"),
    sample.choice<bool>(
      "Control past the peak", &M::widened_past_peak, {{"axial strain", false}, {"lateral strain", true}},
      "of a compression test, from the first avalanche of breaks or fall of the stress on; lateral "
      "strain: the sample widens by Compression step from row to row and the platens follow (class II)"),
    sample.choice<bool>(
      "Softening", &M::scaled_softening, {{"scaled", true}, {"as it is", false}},
      "of the representative volume of a point once its stress has begun to fall; scaled: by the size of its element over "
      "its own, so that the curve after the peak does not depend on the mesh where the fall can be followed (not in an "
      "avalanche)"),
    sample.integer("Realisations", &M::n_realisations, {'[', 1.0, 1000.0, ']'},
                   "packings of the volume, dealt to the points by the seed"),
    sample.choice<bool>("Orientation", &M::random_orientation, {{"random", true}, {"fixed", false}},
                        "whether the volume at each point is turned by an angle of its own"),
    sample.choice<WeakSeed>(
      "Weak seed", &M::weak_seed, {{"none", WeakSeed::none}, {"row", WeakSeed::row}, {"element", WeakSeed::element}},
      "where the sample is to break first: the volumes of the row of elements just above mid-height, or of the outermost "
      "element of that row, to the right, have weaker bonds"),
    sample.number("Weak seed strength", &M::weak_seed_strength, {'(', 0.0, 1.0, ']'},
                  "share of their tensile strength and cohesion that the bonds there have"),
    sample.number("Compression step", &M::compression_step, {'(', 0.0, 0.01, ']'},
                  "axial strain between two rows of the curve"),
    sample.number("Tension step", &M::tension_step, {'(', 0.0, 0.01, ']'}, "the same in direct tension"),
    sample.number("Most broken share", &M::most_broken_share, {'(', 0.0, 1.0, ']'},
                  "of all segments in one step; a step that breaks more is cut"),
    sample.number("Smallest step share", &M::smallest_step_share, {'(', 0.0, 1.0, ']'},
                  "of a step, below which there is said to be no equilibrium"),
    sample.number("Newton tolerance", &M::newton_tolerance, {'[', 1e-12, 0.1, ']'},
                  "unbalanced over internal force of the sample"),

    continuum.quantity("Modulus", &K::modulus, stress, "GPa", above_zero,
                       "Young's; as a test in the plane shows it (free across the plane)"),
    continuum.number("Poisson ratio", &K::poissons_ratio, {'[', 0.0, 1.0, ')'}, "as a test in the plane shows it"),
    continuum.quantity("Cohesion", &K::cohesion, stress, "MPa", above_zero, "of Mohr-Coulomb; there is no softening"),
    continuum.quantity("Friction angle", &K::friction_angle, angle, "deg", {'(', 0.0, 90.0, ')'}, "of Mohr-Coulomb"),
    continuum.quantity("Dilation angle", &K::dilation_angle, angle, "deg", {'[', 0.0, 90.0, ')'},
                       "of Mohr-Coulomb; at most Friction angle"),

    file_parameter(
      "Report", "Reference file", "figures of the rock and of other models (JSON) to set the results beside",
      [](auto& input) -> auto& { return input.reference_file; }),
  };
}
} // namespace

std::string Parameter::name() const { return fmt::format("{}/{}", section, entry); }

std::string Parameter::default_text() const { return write(Input()); }

const std::vector<Parameter>& parameter_table()
{
  static const std::vector<Parameter> table = make_parameter_table();
  return table;
}

std::vector<std::string_view> section_names()
{
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameter_table())
    if (names.empty() || names.back() != parameter.section)
      names.push_back(parameter.section);
  return names;
}

std::vector<std::string_view> entry_names(const std::string_view section)
{
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section)
      names.push_back(parameter.entry);
  return names;
}

const Parameter* find_parameter(const std::string_view section, const std::string_view entry)
{
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section && parameter.entry == entry)
      return &parameter;
  return nullptr;
}
} // namespace feldspar
