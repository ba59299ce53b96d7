#include "app/input/joint_sections.h"
#include "dem/rock/rock.h"
#include "dem/specimen/specimen_file.h"
#include "library/states.h"
#include "results/quantities.h"

#include <fmt/format.h>

namespace feldspar::v1
{
Specimen::Specimen(std::shared_ptr<const SpecimenState> state)
  : of(std::move(state))
{
}

Specimen::Specimen(const Input& input, const std::uint64_t seed, const Check& check)
  : Specimen(guarded([&]() -> std::shared_ptr<const SpecimenState> {
    const feldspar::Input wanted = input.state().read();
    const auto checks = interrupting(check);
    const auto make = [&]<int dim>() {
      return std::make_shared<const SpecimenState>(
        SpecimenState{make_rock<dim>(rock_of(wanted), seed, checks, checks)});
    };
    return wanted.specimen.dimension == 2 ? make.template operator()<2>() : make.template operator()<3>();
  }))
{
}

Specimen Specimen::load(const std::string& file, const Check& check)
{
  return guarded([&] {
    const auto checks = interrupting(check);
    return head_of_specimen(file, checks).dimension == 2
             ? Specimen(std::make_shared<const SpecimenState>(SpecimenState{read_specimen<2>(file, checks)}))
             : Specimen(std::make_shared<const SpecimenState>(SpecimenState{read_specimen<3>(file, checks)}));
  });
}

void Specimen::save(const std::string& file) const
{
  guarded([&] { std::visit([&](const auto& body) { write_specimen(body, file); }, of->body); });
}

int Specimen::dimension() const { return of->body.index() == 0 ? 2 : 3; }

std::uint64_t Specimen::seed() const
{
  return std::visit([](const auto& body) { return body.seed; }, of->body);
}

std::vector<double> Specimen::size() const
{
  return std::visit([](const auto& body) { return std::vector<double>(body.size.begin(), body.size.end()); }, of->body);
}

bool Specimen::is_periodic() const
{
  return std::visit([](const auto& body) { return body.is_periodic(); }, of->body);
}

Table Specimen::grains() const
{
  return std::visit(
    [](const auto& body) {
      Table table;
      std::size_t axis = 0;
      for (const auto& component : body.grains.position)
        table.push_back({fmt::format("{}_m", "xyz"[axis++]), {component.begin(), component.end()}});
      table.push_back({"radius_m", body.grains.radius});
      if (!body.mineral.empty())
        for (const auto& [name, numbers] :
             {std::pair("mineral", &body.mineral), std::pair("mineral_grain", &body.groups)})
          {
            auto& column = table.emplace_back(Column{name, {}, true});
            for (const std::uint32_t number : *numbers)
              column.values.push_back(number + 1.0);
          }
      return table;
    },
    of->body);
}

Table Specimen::joints() const
{
  return std::visit(
    [](const auto& body) {
      const auto& joints = body.joints;
      Table table;
      const auto row = [&](const char* name, const auto& values, const bool is_count = false) {
        table.push_back({name, {values.begin(), values.end()}, is_count});
      };
      row("grain_1", joints.grain_1, true);
      row("grain_2", joints.grain_2, true);
      row("half_length_m", joints.half_length);
      row("gap_m", joints.opening);
      row("normal_stiffness_Pa_per_m", joints.normal_stiffness);
      row("shear_stiffness_Pa_per_m", joints.shear_stiffness);
      return table;
    },
    of->body);
}

std::vector<std::pair<std::string, double>> Specimen::report() const
{
  std::vector<std::pair<std::string, double>> figures;
  const SpecimenReport& report =
    std::visit([](const auto& body) -> const SpecimenReport& { return body.report; }, of->body);
  for (const TestQuantity& quantity : test_quantities)
    std::visit(
      [&](const auto member) {
        if constexpr (requires { report.*member; })
          figures.emplace_back(quantity.name, double(report.*member));
      },
      quantity.member);
  return figures;
}
} // namespace feldspar::v1
