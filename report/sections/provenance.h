#pragma once

#include "report/page/table.h"
#include "results/runs/run.h"

#include <string>

namespace feldspar
{
/// Program, input and machine in a sentence.
std::string sentence_of(const Provenance& made_by);

/// The input as it was understood, under a name for its file. For a series beside another one, `first` under `label`,
/// only the entries in which the two differ.
Table input_table(const Provenance& made_by, const std::string& name);
Table input_table(const Provenance& made_by, const std::string& name, const Provenance& first,
                  const std::string& label);

/// Client, specimen, author and date as the input has them, in a line; empty where it has none of them.
std::string labels_of(const Provenance& made_by);

/// Rock, date and specimen for the top of each printed page; empty where the input has no text for the head of a report.
std::string paper_head_of(const Provenance& made_by, const std::string& rock);
} // namespace feldspar
