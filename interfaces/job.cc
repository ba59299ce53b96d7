#include "interfaces/points.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace feldspar::interfaces
{
std::string input_file_of(const std::string& material)
{
  std::string small = material;
  std::ranges::transform(small, small.begin(), [](const unsigned char c) { return char(std::tolower(c)); });
  for (const std::string& name : {small, material})
    for (const char* const ending : {".prm", ".json"})
      if (std::filesystem::exists(name + ending))
        return name + ending;
  throw Error("material " + material + ": there is no input " + small + ".prm or .json in the folder of the job");
}
} // namespace feldspar::interfaces
