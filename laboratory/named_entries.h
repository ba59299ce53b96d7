#pragma once

#include <string>

/// Entries of the input that results are read by or that remarks on results advise, as the files of a run name them.
/// tests/unit/input_words_test.cc compares them with the entries that the input has.
namespace feldspar::input_entries
{
struct EntryName
{
  const char* section;
  const char* entry;

  std::string text() const { return std::string(section) + '/' + entry; }
};

inline constexpr EntryName elastic_modulus{"Calibration", "Youngs modulus"};
inline constexpr EntryName lateral_ratio{"Calibration", "Poissons ratio"};
inline constexpr EntryName targets{"Calibration", "Targets"};
inline constexpr EntryName most_packings{"Calibration", "Most packings"};
inline constexpr EntryName tolerance{"Calibration", "Tolerance"};
inline constexpr EntryName installation_gap{"Flat joint", "Installation gap ratio"};
inline constexpr EntryName report_author{"Report", "Author"};
inline constexpr EntryName report_client{"Report", "Client"};
inline constexpr EntryName report_date{"Report", "Date"};
inline constexpr EntryName report_specimen{"Report", "Specimen"};
inline constexpr EntryName report_title{"Report", "Title"};
inline constexpr EntryName reference_file{"Report", "Reference file"};
inline constexpr EntryName material{"Sample", "Material"};
inline constexpr EntryName newton_tolerance{"Sample", "Newton tolerance"};
inline constexpr EntryName confinements{"Tests", "Confinements"};
inline constexpr EntryName lateral_boundary{"Tests", "Lateral boundary"};
inline constexpr EntryName least_fall{"Tests", "Least fall after peak"};
inline constexpr EntryName least_stress{"Tests", "Least peak stress"};
inline constexpr EntryName least_transits{"Tests", "Least transits to peak"};
inline constexpr EntryName notch_ratio{"Tests", "Notch ratio"};
inline constexpr EntryName platen_friction{"Tests", "Platen friction"};
inline constexpr EntryName stop_strain{"Tests", "Stop strain"};
inline constexpr EntryName stop_stress{"Tests", "Stop stress over peak"};
inline constexpr EntryName test_list{"Tests", "List"};

inline constexpr EntryName all[] = {elastic_modulus,  lateral_ratio,  targets,        most_packings,    tolerance,
                                    installation_gap, reference_file, material,       newton_tolerance, confinements,
                                    report_author,    report_client,  report_date,    report_specimen,  report_title,
                                    least_fall,       least_stress,   least_transits, notch_ratio,      platen_friction,
                                    stop_strain,      stop_stress,    test_list,      lateral_boundary};

/// Commands that write or read what results are about.
inline constexpr const char* calibrate = "feldspar calibrate";
inline constexpr const char* multiscale = "feldspar multiscale";
inline constexpr const char* report = "feldspar report";
inline constexpr const char* rve = "feldspar rve";
} // namespace feldspar::input_entries
