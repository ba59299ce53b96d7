#pragma once

#include "results/fits/hoek_brown.h"

#include <string>

namespace feldspar
{
/// The name of a form as readers see it, by the parameters that are free; a rock need have no paper.
inline std::string title(const HoekBrownForm form)
{
  switch (form)
    {
    case HoekBrownForm::as_paper:
      return "s and a free";
    case HoekBrownForm::intact:
      return "intact";
    case HoekBrownForm::regressed:
      return "intact, regression"; // of (σ_1 - σ_3)²
    default:
      return "a free";
    }
}

/// The same by the name of an envelope in result files.
inline std::string title_of_form(const std::string& name_in_files)
{
  for (const auto form :
       {HoekBrownForm::as_paper, HoekBrownForm::intact, HoekBrownForm::general, HoekBrownForm::regressed})
    if (name_in_files == name(form))
      return title(form);
  return "Mohr–Coulomb";
}
} // namespace feldspar
