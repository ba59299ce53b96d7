#pragma once

#include "tests/app/result_files.h"

#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

/// Committed results (scripts/keep-results.py): a key that is not there does not apply.
namespace feldspar::tests
{
inline Json json_of(const std::string& path) { return read_json(FELDSPAR_SOURCE_DIR "/" + path); }

/// Results of an example by the names of its folder and of the file.
inline Json results_of(const std::string& example, const std::string& study)
{
  return json_of("examples/" + example + "/results/" + study + ".json");
}

/// Tests or RVEs of EXAMPLE/STUDY: of a group (a kind, with its pressure), and of a variant with these words at its end.
inline std::vector<Json> tests_of(const std::string& study, const std::string& group = "",
                                  const std::string& variant = "")
{
  const std::size_t slash = study.find('/');
  const Json results = results_of(study.substr(0, slash), study.substr(slash + 1));
  std::vector<Json> found;
  for (const Json& test : results.at(results.contains("tests") ? "tests" : "rves"))
    if ((group.empty() || (test.at("name").get<std::string>() + "_").starts_with(group + "_")) &&
        test.value("variant", "").ends_with(variant))
      found.push_back(test);
  if (found.empty())
    throw std::runtime_error(study + " has no " + group + " " + variant);
  return found;
}

inline std::vector<double> values_of(const std::vector<Json>& tests, const std::string& key = "peak_stress_Pa")
{
  std::vector<double> values;
  for (const Json& test : tests)
    if (test.contains(key))
      values.push_back(test[key]);
  return values;
}

inline double mean(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

inline const Json& test_of(const Json& study, const std::string& name)
{
  for (const Json& test : study["tests"])
    if (test["name"] == name)
      return test;
  throw std::runtime_error("no test " + name);
}
} // namespace feldspar::tests
