#include "results/test_quantity.h"

#include <fmt/format.h>

namespace feldspar
{
std::string with_unit(const std::string_view title, const std::string_view unit)
{
  return unit.empty() ? std::string(title) : fmt::format("{} [{}]", title, unit);
}

bool gives(const PropertySource source, const TestKind& kind)
{
  switch (source)
    {
    case PropertySource::tension:
      return kind.envelope_role == EnvelopeRole::tension;
    case PropertySource::compression:
      return kind.envelope_role == EnvelopeRole::compression && !kind.takes_confining_pressure;
    case PropertySource::indirect_tension:
      return kind.envelope_role == EnvelopeRole::indirect_tension;
    case PropertySource::notch:
      return kind.has_notch;
    case PropertySource::tilt:
      return kind.tilts;
    case PropertySource::given:
    case PropertySource::fit:
      break;
    }
  return false;
}
} // namespace feldspar
