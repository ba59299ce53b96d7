#include "base/checksum/seal.h"
#include "base/system/hdf5_archive.h"
#include "base/whole_file.h"
#include "coupling/rve/path_run.h"
#include "coupling/rve/rve_file.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "results/sample_fields.h"
#include "tests/content.h"
#include "tests/mutations.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_rve.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

/// Files that were damaged, cut short or made up: one line, and nothing else.
namespace feldspar
{
namespace
{
using tests::has;
using tests::Mutations;
using tests::refusal;
using tests::TemporaryFolder;

/// Every one of so many mutations of a file is reported by `read` in one line.
void expect_all_refused(const std::filesystem::path& file, const std::function<void()>& read)
{
  constexpr std::uint64_t n_mutations = 300;
  const std::string whole = tests::content(file);
  ASSERT_EQ(refusal(read), "");
  for (std::uint64_t seed = 0; seed < n_mutations; ++seed)
    {
      std::ofstream(file, std::ios::binary) << Mutations(seed).of(whole);
      const std::string words = refusal(read);
      EXPECT_NE(words, "") << "mutation " << seed;
      EXPECT_FALSE(has(words, "\n"));
    }
  std::ofstream(file, std::ios::binary) << whole;
  EXPECT_EQ(refusal(read), "");
}

TEST(Seal, SeesEveryChangeOfAFile)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "sealed";
  const std::string content = "some content, " + std::string(seal_notice) + ", and more of it";
  const std::string sealed = content + seal_of(content);
  const auto examined = [&](const std::string& bytes) {
    folder.write("sealed", bytes);
    return examine_seal(file);
  };
  EXPECT_EQ(examined(sealed), Seal::intact);
  write_whole_file(file, [&](const int descriptor) {
    EXPECT_EQ(write_at(descriptor, 0, content), 0);
    return append_seal(descriptor);
  });
  EXPECT_EQ(tests::content(file), sealed);
  EXPECT_EQ(append_seal(-1), EBADF);
  EXPECT_EQ(examined("another file, without any"), Seal::none);
  EXPECT_EQ(examined(""), Seal::none);
  EXPECT_EQ(examine_seal(folder.path() / "missing"), Seal::broken);
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit)
    {
      std::string flipped = sealed;
      flipped[bit / 8] = char(flipped[bit / 8] ^ 1 << bit % 8);
      EXPECT_EQ(examined(flipped), Seal::broken) << bit;
    }
  for (std::size_t size = content.size(); size < sealed.size(); ++size)
    EXPECT_EQ(examined(sealed.substr(0, size)), Seal::broken) << size;
  // The notice across the border between the pieces in which a file is read.
  for (std::size_t before = (1u << 20) - seal_notice.size() - 1; before < (1u << 20) + 2; ++before)
    EXPECT_EQ(examined(std::string(before, ' ') + std::string(seal_notice)), Seal::broken) << before;
}

TEST(Seal, KeepsSmallTextsToTheBit)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "kept.json";
  EXPECT_FALSE(read_sealed(file)) << "there is none";
  const std::string content = "{\"seal\": \"" + std::string(seal_notice) + "\", \"values\": [1.25, null]}\n";
  write_sealed(file, content);
  EXPECT_EQ(read_sealed(file), content);
  const std::string whole = tests::content(file);
  for (std::size_t at = 0; at < whole.size(); ++at)
    {
      std::string changed = whole;
      changed[at] = char(changed[at] ^ 1);
      folder.write("kept.json", changed);
      EXPECT_TRUE(
        has(refusal([&] { read_sealed(file); }), "kept.json: damaged: content and checksum do not agree; remove"))
        << at;
    }
  folder.write("kept.json", whole.substr(0, whole.size() - 1));
  EXPECT_NE(refusal([&] { read_sealed(file); }), "");
  folder.write("kept.json", "{\"values\": [1.25, null]}\n");
  EXPECT_FALSE(read_sealed(file)) << "of an older version: it is computed anew";
}

TEST(DamagedFiles, SpecimensAreRefused)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  write_specimen(small_specimen(), file);
  expect_all_refused(file, [&] { read_specimen<2>(file); });
}

TEST(DamagedFiles, CheckpointsOfTheLaboratoryAreRefused)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  const LaboratoryCase wanted{uniaxial_compression};
  const auto specimen = small_specimen();
  LabTest<2> test(wanted, specimen, {}, {});
  for (int n = 0; n < 3; ++n)
    test.advance();
  test.write_checkpoint(file, "this one");
  LabTest<2> resumed(wanted, specimen, {}, {});
  expect_all_refused(file, [&] { resumed.read_checkpoint(file, "this one"); });
}

/// Makes a file as a version from before seals wrote it: without a seal, and without the attribute that announces one.
void unseal(const std::filesystem::path& file)
{
  std::string content = tests::content(file);
  content.resize(content.size() - seal_of("").size());
  const std::string another(seal_notice.size(), 'a');
  std::size_t n_notices = 0;
  for (std::size_t at = 0; (at = content.find(seal_notice, at)) != std::string::npos; ++n_notices)
    content.replace(at, seal_notice.size(), another);
  ASSERT_GT(n_notices, 0u);
  std::ofstream(file, std::ios::binary) << content;
}

// Specimens are what users keep: those of a version from before seals are read as they are. Checkpoints are of the program
// that goes on with them.
TEST(OlderFiles, SpecimensAreReadAndCheckpointsRefusedInOneLine)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  const auto specimen = small_specimen();
  write_specimen(specimen, file);
  unseal(file);
  EXPECT_EQ(examine_seal(file), Seal::none);
  const auto back = read_specimen<2>(file);
  EXPECT_EQ(back.grains.position, specimen.grains.position);
  EXPECT_EQ(back.joints.tensile_strength, specimen.joints.tensile_strength);

  const auto checkpoint = folder.path() / "checkpoint.h5";
  LabTest<2> test({uniaxial_compression}, specimen, {}, {});
  test.advance();
  test.write_checkpoint(checkpoint, "this one");
  unseal(checkpoint);
  const std::string words = refusal([&] { test.read_checkpoint(checkpoint, "this one"); });
  EXPECT_TRUE(has(words, "not of this version of the program: it has no checksum"));
  EXPECT_FALSE(has(words, "\n"));
}

// The HDF5 library itself crashes or searches without end in some of these, in a process of its own.
TEST(DamagedFiles, SpecimensWithoutASealAreReadOrRefusedInOneLine)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  write_specimen(small_specimen(), file);
  unseal(file);
  const std::string whole = tests::content(file);
  constexpr std::uint64_t n_mutations = 100;
  for (std::uint64_t seed = 0; seed < n_mutations; ++seed)
    {
      std::ofstream(file, std::ios::binary) << Mutations(seed).of(whole);
      EXPECT_FALSE(has(refusal([&] { read_specimen<2>(file); }), "\n")) << seed;
    }
}

/// A file of another program: HDF5 without a seal.
std::filesystem::path foreign_file(const TemporaryFolder& folder)
{
  const auto file = folder.path() / "foreign.h5";
  write_hdf5(file, [](Hdf5Writer& root) {
    std::vector<double> numbers{1.0, 2.0, 3.0};
    auto inner = root.subgroup("inner");
    inner.array("numbers", numbers);
  });
  unseal(file);
  return file;
}

TEST(ForeignFiles, AreReadByWayOfAChildWithTheSameNumbers)
{
  const TemporaryFolder folder;
  std::vector<double> numbers;
  bool has_more = true;
  pid_t reader = 0;
  read_foreign_hdf5(foreign_file(folder), "a test", [&](Hdf5Reader& root) {
    reader = getpid();
    auto inner = root.subgroup("inner");
    inner.array("numbers", numbers);
    has_more = inner.has("more");
  });
  EXPECT_EQ(numbers, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_FALSE(has_more);
  EXPECT_EQ(reader, getpid());
}

TEST(ForeignFiles, OnWhichTheLibraryCrashesOrFindsNoEndAreRefusedInOneLine)
{
  const TemporaryFolder folder;
  const auto file = foreign_file(folder);
  const pid_t self = getpid();
  const auto words_of = [&](const std::function<void()>& library) {
    return refusal([&] {
      read_foreign_hdf5(file, "a test", [&](Hdf5Reader&) {
        ASSERT_NE(getpid(), self); // whatever happens, not here
        library();
      });
    });
  };
  const auto says = [](const std::string& refused, const std::string& words) {
    EXPECT_TRUE(has(refused, "foreign.h5: " + words));
    EXPECT_FALSE(has(refused, "\n"));
  };
  says(words_of([] { raise(SIGFPE); }), "damaged: the HDF5 library fails on it (SIGFPE)");
  says(words_of([] { raise(SIGSEGV); }), "damaged: the HDF5 library fails on it (SIGSEGV)");
  says(words_of([] { _exit(0); }), "cannot be read");
  says(words_of([] { throw InputError("no grains"); }), "no grains");
  says(words_of([] {
         for (volatile int n = 0;;) // the limit of time ends it
           n = 1 - n;
       }),
       "damaged: the HDF5 library does not end on it within its limit of time");
}

TEST(ForeignFiles, CanBeLeftWhileTheyAreRead)
{
  const TemporaryFolder folder;
  const auto file = foreign_file(folder);
  struct Enough
  {
  };
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(read_foreign_hdf5(
                 file, "a test", [](Hdf5Reader&) { pause(); },
                 [&] {
                   if (std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(300))
                     throw Enough();
                 }),
               Enough);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1); // no child is left
}

TEST(DamagedFiles, CheckpointsOfPathsAndStatesOfRvesAreRefused)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  const auto specimen = periodic_specimen<2>();
  const auto network = std::make_shared<const Network<2>>(specimen);
  PathRun<2> run(network, {{strain_control<2>(axial<2>(3e-4)), true}}, {});
  while (!run.has_ended())
    run.advance();
  ASSERT_GT(run.record().cracks.size(), 0u);
  run.write_checkpoint(file, "this one");
  PathRun<2> resumed(network, {{strain_control<2>(axial<2>(3e-4)), true}}, {});
  expect_all_refused(file, [&] { resumed.read_checkpoint(file, "this one"); });

  const auto rve_file = folder.path() / "volume.h5";
  write_rve<2>(specimen, {}, run.rve().state(), rve_file);
  expect_all_refused(rve_file, [&] { read_rve_state<2>(rve_file, *network); });

  // States that are whole but not of this network.
  const auto refusal_of = [&](const std::function<void(NetworkState<2>&)>& change) {
    NetworkState<2> state = run.rve().state();
    change(state);
    write_rve<2>(specimen, {}, state, rve_file);
    return refusal([&] { read_rve_state<2>(rve_file, *network); });
  };
  EXPECT_EQ(refusal_of([](NetworkState<2>&) {}), "");
  EXPECT_NE(refusal_of([](NetworkState<2>& state) { state.motions.pop_back(); }), "");
  EXPECT_NE(refusal_of([](NetworkState<2>& state) { state.unbonded.back().segment = 1u << 31; }), "");
  EXPECT_NE(refusal_of([](NetworkState<2>& state) { std::reverse(state.unbonded.begin(), state.unbonded.end()); }), "");
  EXPECT_NE(refusal_of([](NetworkState<2>& state) {
              state.unbonded.front().shear_stress[0] = std::numeric_limits<double>::quiet_NaN();
            }),
            "");
  EXPECT_NE(refusal_of([](NetworkState<2>& state) { state.strain[1] = 1e300; }), "");
}

// A file of another program, or of a version before there were checksums, may hold anything.
TEST(DamagedFiles, SpecimensThatCannotBeAreRefused)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  const auto refusal_of = [&](const std::function<void(Specimen<2>&)>& change) {
    Specimen<2> specimen = small_specimen();
    change(specimen);
    write_specimen(specimen, file);
    return refusal([&] { read_specimen<2>(file); });
  };
  const auto says = [](const std::string& refused, const std::string& words) { EXPECT_TRUE(has(refused, words)); };
  using S = Specimen<2>;
  EXPECT_EQ(refusal_of([](S&) {}), "");
  says(refusal_of([](S& s) { s.joints.grain_2[3] = std::uint32_t(s.grains.size()); }), "a grain that is not there");
  says(refusal_of([](S& s) { std::swap(s.joints.grain_1[3], s.joints.grain_2[3]); }), "a grain that is not there");
  says(refusal_of([](S& s) { s.joints.number[3] = s.joints.number[4]; }), "one number");
  says(refusal_of([](S& s) { s.joints.number[3] = 1u << 31; }), "one number");
  says(refusal_of([](S& s) { s.joints.normal[0][3] = 5.0; }), "no direction");
  says(refusal_of([](S& s) { s.joints.rest_distance[3] = 1e9; }), "leads out of its box");
  says(refusal_of([](S& s) { s.joints.half_length[3] = 0.0; }), "positive stiffness and size");
  says(refusal_of([](S& s) { s.joints.bonded[3] = 0.5; }), "neither bonded nor broken");
  says(refusal_of([](S& s) { s.joints.cohesion[3] = -1.0; }), "negative strength");
  says(refusal_of([](S& s) { s.joints.division = {1u << 30}; }), "another number of segments");
  says(refusal_of([](S& s) { s.joints.division = {0}; }), "another number of segments");
  says(refusal_of([](S& s) { s.joints.division = {s.joints.n_segments + 1}; }), "another number of segments");
  says(refusal_of([](S& s) { s.grains.position[1][7] = 1e300; }), "far from its box");
  says(refusal_of([](S& s) { s.grains.radius[7] = -1e-3; }), "no positive radius");
  says(refusal_of([](S& s) { s.grains.mass.pop_back(); }), "grains are missing");
  says(refusal_of([](S& s) { s.report.n_grains = 1u << 31; }), "grains are missing");
  says(refusal_of([](S& s) { s.report.mean_radius = 1e-30; }), "mean radius");
  says(refusal_of([](S& s) { s.size[0] = std::numeric_limits<double>::infinity(); }), "size or density");
  says(refusal_of([](S& s) { s.particle_contact.friction = std::numeric_limits<double>::quiet_NaN(); }),
       "a parameter of its contacts");
}

TEST(DamagedFiles, AnArrayIsNotLongerThanItsFile)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "long.h5";
  {
    // Announced, but never written: HDF5 itself would hand out zeros.
    const H5::H5File out(file.string(), H5F_ACC_TRUNC);
    const std::array<hsize_t, 1> length{hsize_t(1) << 40};
    out.createDataSet("endless", H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, length.data()));
    const std::array<hsize_t, 1> three{3};
    const std::array<double, 3> values{1.0, 2.0, 3.0};
    out.createAttribute("several", H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, three.data()))
      .write(H5::PredType::NATIVE_DOUBLE, values.data());
  }
  std::vector<double> read;
  const auto reading = [&](const std::function<void(Hdf5Reader&)>& use) {
    return refusal([&] { read_foreign_hdf5(file, "a test", use); });
  };
  EXPECT_TRUE(has(reading([&](Hdf5Reader& root) { root.array("endless", read); }), "longer than the file"));
  double one = 0.0;
  EXPECT_TRUE(has(reading([&](Hdf5Reader& root) { root.value("several", one); }), "not one value"));
  std::string text;
  EXPECT_NE(reading([&](Hdf5Reader& root) { root.text("several", text); }), "");
  // Read as one that this version wrote.
  EXPECT_TRUE(has(refusal([&] { read_hdf5(file, "a test", [](Hdf5Reader&) {}); }), "no checksum"));
}

#if defined(__SANITIZE_ADDRESS__) // of g++
constexpr bool under_address_sanitizer = true;
#elif defined(__has_feature) // of clang
constexpr bool under_address_sanitizer = __has_feature(address_sanitizer);
#else
constexpr bool under_address_sanitizer = false;
#endif

/// The most memory this process has had [bytes].
double most_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

// An array at a time passes through memory, with the copy that its checksum takes: never the file.
TEST(Hdf5File, IsWrittenAndSealedWithoutAnImageInMemory)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "large.h5";
  std::vector<double> values(500'000);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = double(k);
  constexpr int n_arrays = 12; // 48 MB
  const double before = most_memory();
  write_hdf5(file, [&](Hdf5Writer& root) {
    for (int k = 0; k < n_arrays; ++k)
      root.array(fmt::format("array_{}", k), values);
  });
  const double bytes_of_array = 8.0 * double(values.size());
  if (!under_address_sanitizer) // which keeps what was given back, to see whether it is read again
    {
      EXPECT_LT(most_memory() - before, 5.0 * bytes_of_array);
    }
  EXPECT_GT(double(std::filesystem::file_size(file)), n_arrays * bytes_of_array);
  EXPECT_EQ(examine_seal(file), Seal::intact);
  std::vector<double> last;
  read_hdf5(file, "a test", [&](Hdf5Reader& root) { root.array("array_11", last); });
  EXPECT_EQ(last, values);
}

TEST(Hdf5File, ThatCannotBeWrittenLeavesTheOneBefore)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "kept.h5";
  const auto write = [&](double value) {
    write_hdf5(file, [&](Hdf5Writer& root) {
      root.value("number", value);
      if (value < 0.0)
        throw std::runtime_error("left amid the writing");
    });
  };
  write(1.0);
  EXPECT_THROW(write(-1.0), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "kept.h5.unfinished"));
  double number = 0.0;
  read_hdf5(file, "a test", [&](Hdf5Reader& root) { root.value("number", number); });
  EXPECT_EQ(number, 1.0);
  EXPECT_THROW(write_hdf5(folder.path() / "nowhere/file.h5", [](Hdf5Writer&) {}), OutputError);
}

TEST(DamagedFiles, FieldsOfSamplesAreRefused)
{
  const TemporaryFolder folder;
  const std::string index =
    "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n<Domain>\n<Grid Name=\"CellTime\">\n<Grid Name=\"mesh\">\n"
    "<Time Value=\"5\"/>\n<Geometry GeometryType=\"XY\"><DataItem>a.h5:/nodes</DataItem></Geometry>\n"
    "<Topology><DataItem>a.h5:/cells</DataItem></Topology>\n"
    "<Attribute Name=\"displacement\"><DataItem>a.h5:/displacement</DataItem></Attribute>\n"
    "</Grid>\n</Grid>\n</Domain>\n</Xdmf>\n";
  folder.write("a.xdmf", index);
  const auto file = folder.path() / "a.h5";
  write_hdf5(file, [](Hdf5Writer& root) {
    std::vector<double> nodes{0, 0, 1, 0, 1, 1, 0, 1};
    std::vector<double> displacement(12, 0.5);
    std::vector<std::uint32_t> cells{0, 1, 2, 3};
    root.array("nodes", nodes, 2);
    root.array("cells", cells, 4);
    root.array("displacement", displacement, 3);
  });
  const auto read = [&] { read_sample_fields(folder.path(), "a"); };
  ASSERT_EQ(read_sample_fields(folder.path(), "a").n_rows, 5u);
  expect_all_refused(file, read);

  // The index is text that nothing seals: read or refused.
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    {
      folder.write("a.xdmf", Mutations(seed).of(index));
      EXPECT_FALSE(has(refusal(read), "\n")) << seed;
    }
  folder.write("a.xdmf", std::string(index).replace(index.find("\"5\""), 3, "\"1e300\""));
  EXPECT_NE(refusal(read), "");
  // The name in it is shown as text, and nothing outside of the folder is opened.
  for (const auto& [name, shown] : {std::pair("../a.h5", "\"../a.h5\""), std::pair("a\xa0.h5", "\"a\\xa0.h5\"")})
    {
      folder.write("a.xdmf", std::string(index).replace(index.find("a.h5"), 4, name));
      EXPECT_TRUE(has(refusal(read), std::string("a.xdmf: a DataItem names ") + shown));
    }
}
} // namespace
} // namespace feldspar
