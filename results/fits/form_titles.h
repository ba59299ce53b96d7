#pragma once

#include "results/fits/hoek_brown.h"

#include <string>

namespace feldspar
{
/// The name of a form as readers see it, by the parameters that are free; a rock need have no paper.
inline std::string title(const HoekBrownForm form)
{
  constexpr const char* titles[] = {"s and a free", "intact", "a free", "intact, regression"}; // by their enumerators
  return titles[std::size_t(form)];
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
