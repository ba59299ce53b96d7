#pragma once

#include "app/input/input.h"
#include "base/entries.h"

#include <string>
#include <string_view>
#include <vector>

/// The entries that fill the structs of app/input/input.h, lists and paths among them.
namespace feldspar
{
std::vector<Entry<Input>> test_list_entries();
std::vector<Entry<SpecimenParameters>> sieve_curve_entries();
/// The entries of section Minerals that name files, and the others.
std::vector<Entry<Input>> mineral_file_entries();
std::vector<Entry<MineralParameters>> mineral_entries();
/// The entries of section Flaws, and those on the place and the layers of a joint map.
std::vector<Entry<Input>> flaw_entries();
std::vector<Entry<MapParameters>> map_entries();
/// Shapes as the user writes them, between upright bars: `hole centre 25, 50 mm radius 5 mm | slot from 25, 0 mm to 25, 12 mm
/// width 1 mm`. Throws InputError, which names the shape and its word.
std::vector<Shape> parse_shapes(std::string_view text);
/// Checkpoints, and the processes of a body.
std::vector<Entry<Input>> progress_entries();
/// Gravity and the laboratory's rate, of all tests.
std::vector<Entry<TestParameters>> tests_text_entries();
std::vector<Entry<VariantParameters>> variant_entries();
/// An entry of several values by its name, Section/Entry; throws InputError for one that cannot vary.
std::string varied_entry(std::string_view text);
std::vector<Entry<Input>> seeds_entries();
std::vector<Entry<ContactParameters>> contact_entries();
std::vector<Entry<ContactParameters>> contact_path_entries();
std::vector<Entry<StrainPathParameters>> strain_path_entries();
std::vector<Entry<SampleParameters>> mesh_names_entries();
std::vector<Entry<CalibrationParameters>> calibration_list_entries();
std::vector<Entry<ReportLabels>> label_entries();
std::vector<Entry<Input>> report_entries();
} // namespace feldspar
