#pragma once

#include "app/input/input.h"
#include "base/entries.h"

#include <vector>

/// The entries that fill the structs of app/input/input.h, lists and paths among them.
namespace feldspar
{
std::vector<Entry<Input>> test_list_entries();
Entry<SpecimenParameters> sieve_curve_entry();
/// The entries of section Minerals that name files, and the others.
std::vector<Entry<Input>> mineral_file_entries();
std::vector<Entry<MineralParameters>> mineral_entries();
Entry<Input> checkpoint_entry();
Entry<Input> shared_body_entry();
/// Gravity and the laboratory's rate, of all tests.
std::vector<Entry<TestParameters>> tests_text_entries();
std::vector<Entry<VariantParameters>> variant_entries();
/// An entry of several values by its name, Section/Entry; throws InputError for one that cannot vary.
std::string varied_entry(std::string_view text);
Entry<Input> seeds_entry();
std::vector<Entry<ContactParameters>> contact_entries();
Entry<ContactParameters> contact_path_entry();
std::vector<Entry<StrainPathParameters>> strain_path_entries();
Entry<SampleParameters> mesh_names_entry();
std::vector<Entry<CalibrationParameters>> calibration_list_entries();
std::vector<Entry<ReportLabels>> label_entries();
std::vector<Entry<Input>> report_entries();
} // namespace feldspar
