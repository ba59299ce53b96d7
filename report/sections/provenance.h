#pragma once

#include "report/page/table.h"
#include "results/run.h"

#include <string>

namespace feldspar
{
/// Program, input and machine in a sentence.
std::string sentence_of(const Provenance& made_by);

/// The input as it was understood, under a name for its file.
Table input_table(const Provenance& made_by, const std::string& name);
} // namespace feldspar
