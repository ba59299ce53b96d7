#pragma once

#include "report/page/picture_book.h"
#include "report/sections/findings.h"
#include "results/folder/calibration_record.h"

/// The sections of the page, a file each; those with pictures keep them in the book, which draws them all at the end.
namespace feldspar
{
/// Verdict on whether the model agrees with the rock, each series beside the reference, and every warning.
PageSection verdict_section(const Findings& findings);

/// Results over the entries that take several numbers; nothing where there are none.
PageSection study_section(const Findings& findings, PictureBook& book);

/// Targets and micro-parameters of a calibration.
PageSection calibration_section(const CalibrationRecord& record, PictureBook& book);

/// Strengths under confinement with the envelopes fitted to them.
PageSection envelope_section(const Findings& findings, PictureBook& book);

/// Stress, cracks and energies over strain.
PageSection curve_section(const Findings& findings, PictureBook& book);

/// Samples of finite elements at the end of their tests; nothing of specimens and of samples without grains.
PageSection sample_section(const Findings& findings, PictureBook& book);

/// Positions and directions of cracks, and the fragments.
PageSection crack_section(const Findings& findings, PictureBook& book);

/// Checks of the method, specimens, provenance and input, and every test.
PageSection trust_section(const Findings& findings);
} // namespace feldspar
