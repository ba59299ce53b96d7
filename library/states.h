#pragma once

#define FELDSPAR_IMPLEMENTS_FACE
#include <feldspar/feldspar.h>

#include "app/input/given_entries.h"
#include "app/input/input.h"
#include "base/input_error.h"
#include "base/parallel.h"
#include "base/whole_file.h"
#include "coupling/rve/representative_volume.h"
#include "dem/specimen/specimen.h"
#include "laboratory/column.h"
#include "runs/observer.h"

#include <utility>
#include <variant>
#include <vector>

/// States behind the objects of the face.
namespace feldspar::v1
{
class InputState
{
public:
  std::vector<std::pair<std::string, std::string>> given;
  std::filesystem::path folder; ///< to which its relative paths refer

  feldspar::Input read() const;
};

class SpecimenState
{
public:
  std::variant<feldspar::Specimen<2>, feldspar::Specimen<3>> body;
};

class TrialState
{
public:
  std::variant<feldspar::Trial<2>, feldspar::Trial<3>> trial;
  const void* network; ///< of the volume that was tried
};

/// Runs work of the library, whose errors become those of the face.
template <typename Work>
auto guarded(const Work& work)
{
  try
    {
      return work();
    }
  catch (const InputError& error)
    {
      throw Error(error.what());
    }
  catch (const OutputError& error)
    {
      throw Error(error.what());
    }
  catch (const Interrupted&)
    {
      throw Stopped();
    }
  catch (const GivenUp&)
    {
      throw Stopped();
    }
}

/// The same question as the library asks it.
inline std::function<void()> interrupting(const Check& check)
{
  if (!check)
    return [] {};
  return [check] {
    if (check())
      throw Interrupted();
  };
}

/// A table of rows; `sign`: of columns that are positive in the sense of the test.
template <typename Row, typename Columns>
Table table_of(const std::vector<Row>& rows, const Columns& columns, const double sign = 1.0,
               const std::size_t from = 0)
{
  Table table;
  for (const feldspar::Column<Row>& one : columns)
    {
      const double factor = one.is(positive_in_test) ? sign : 1.0;
      v1::Column& column = table.emplace_back(v1::Column{std::string(one.name), {}, one.most > 0.0});
      for (std::size_t k = from; k < rows.size(); ++k)
        column.values.push_back(factor * one.get(rows[k]));
    }
  return table;
}
} // namespace feldspar::v1
