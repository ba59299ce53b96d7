// Libraries of the programs, a program that goes on as another, an installation.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

TEST(Programs, LoadFiniteElementsAndStatisticsWhereTheyAreUsedOnly)
{
  // Libraries that the loader of the system would load.
  const TemporaryFolder folder;
  const auto loads = [&](const std::string& program, const std::string& library) {
    const fs::path place = fs::path(FELDSPAR_COMMAND).replace_filename(program);
    const auto traced = run_command(folder, fmt::format("LD_TRACE_LOADED_OBJECTS=1 '{}'", place.string()));
    return traced.output.find(library) != std::string::npos;
  };
  EXPECT_TRUE(loads("feldspar-multiscale", "libdeal.ii"));
  EXPECT_TRUE(loads("feldspar-calibrate", "libOT.so"));
  EXPECT_FALSE(loads("feldspar-calibrate", "libdeal.ii"));
  EXPECT_FALSE(loads("feldspar-multiscale", "libOT.so"));
  EXPECT_TRUE(loads("feldspar", "libhdf5"));
  for (const char* const library : {"libdeal.ii", "libpetsc", "libOT.so"})
    EXPECT_FALSE(loads("feldspar", library)) << library;
}

/// The folders in which a program's libraries are looked for, as readelf shows its dynamic section: RPATH and RUNPATH.
std::vector<std::string> library_folders(const std::string& dynamic_section)
{
  std::vector<std::string> folders;
  std::istringstream lines(dynamic_section);
  for (std::string line; std::getline(lines, line);)
    if (line.find("(RUNPATH)") != std::string::npos || line.find("(RPATH)") != std::string::npos)
      {
        std::istringstream path(line.substr(line.find('[') + 1, line.find(']') - line.find('[') - 1) + ":");
        for (std::string one; std::getline(path, one, ':');)
          folders.push_back(one);
      }
  return folders;
}

/// An empty name is the current folder, where anybody may have put a library.
void expect_whole_library_folders(const fs::path& program)
{
  const TemporaryFolder folder;
  const auto read = run_command(folder, fmt::format("LC_ALL=C readelf -dW '{}'", program.string()));
  EXPECT_TRUE(has_words(read.output, "(NEEDED)")) << program << read.error;
  for (const std::string& one : library_folders(read.output))
    EXPECT_TRUE(one.starts_with('/') || one.starts_with("$ORIGIN/"))
      << program << " looks for libraries in \"" << one << '"';
}

TEST(Programs, LookForLibrariesInNoFolderThatDependsOnTheCurrentOne)
{
  for (const char* const program : {"feldspar", "feldspar-calibrate", "feldspar-multiscale"})
    expect_whole_library_folders(fs::path(FELDSPAR_COMMAND).replace_filename(program));
  // Path from before: CMake ended it with an empty element.
  EXPECT_EQ(library_folders(" 0x000000000000001d (RUNPATH)            Library runpath: [/usr/lib:]\n"),
            (std::vector<std::string>{"/usr/lib", ""}));
  EXPECT_EQ(library_folders(" 0x000000000000000f (RPATH)              Library rpath: [:lib]\n"),
            (std::vector<std::string>{"", "lib"}));
}

TEST(Programs, GoOnAsAnotherOfTheSameVersionOrSayWhatIsMissing)
{
  const TemporaryFolder folder;
  const fs::path programs = folder / "bin";
  fs::create_directory(programs);
  fs::create_directory_symlink(FELDSPAR_BUILD_DIR "/lib", folder / "lib");
  fs::copy_file(FELDSPAR_COMMAND, programs / "feldspar");
  std::ofstream(folder / "rock.prm") << "subsection Specimen\n  set Width = 20 mm\nend\n";
  for (const auto& [words, program] : {std::pair("multiscale rock.prm", "feldspar-multiscale"),
                                       {"parameters --check rock.prm", "feldspar-multiscale"},
                                       {"calibrate rock.prm", "feldspar-calibrate"}})
    {
      const auto alone = run_command(folder, fmt::format("bin/feldspar {}", words));
      EXPECT_EQ(alone.exit_code, 2);
      EXPECT_TRUE(has_words(alone.error, fmt::format("{}: cannot be run", program)));
    }

  fs::copy_file(fs::path(FELDSPAR_COMMAND).replace_filename("feldspar-multiscale"), programs / "feldspar-multiscale");
  const std::string check = "bin/feldspar parameters --check rock.prm --for lab";
  const auto installed = run_command(folder, check);
  EXPECT_EQ(installed.exit_code, 0) << installed.error;

  const auto of_another = run_command(folder, "FELDSPAR_VERSION_OF_CALLER=0.0.1 " + check);
  EXPECT_EQ(of_another.exit_code, 2);
  EXPECT_TRUE(has_words(of_another.error, "and feldspar of 0.0.1; build or install both anew"));
}

TEST(Programs, TakeTheCodeOfTheHighestLevelThatTheProcessorHas)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "bin");
  fs::copy_file(FELDSPAR_COMMAND, folder / "bin/feldspar");
  const fs::path place = folder / "lib/feldspar";
  for (const char* const level : {"", "glibc-hwcaps/x86-64-v3", "glibc-hwcaps/x86-64-v4"})
    {
      fs::create_directories(place / level);
      fs::copy_file(FELDSPAR_BUILD_DIR "/lib/feldspar/libfeldspar-code.so", place / level / "libfeldspar-code.so");
    }
  // The loader of a processor without what each level adds to the one before.
  for (const auto& [without, taken] :
       {std::pair("AVX512F", "glibc-hwcaps/x86-64-v3/"), {"AVX512F,-AVX2", "lib/feldspar/libfeldspar-code.so"}})
    {
      const auto loaded = run_command(
        folder, fmt::format("GLIBC_TUNABLES=glibc.cpu.hwcaps=-{} LD_TRACE_LOADED_OBJECTS=1 bin/feldspar", without));
      EXPECT_TRUE(has_words(loaded.output, taken)) << without << ": ";
    }
}

// Installation of a build by ./bootstrap.sh install, and the parts of it that a user meets first.
TEST(Installation, HasProgramManualCompletionAndExamples)
{
  const TemporaryFolder folder;
  const Outcome installed =
    run_command(folder, "umask 077; cmake --install '" FELDSPAR_BUILD_DIR "' --prefix usr --strip > installed");
  ASSERT_EQ(installed.exit_code, 0) << installed.error;
  // For everybody, whatever the umask of who installs or packs; bootstrap.sh sees to that of folders.
  EXPECT_EQ(run_command(folder, "find usr -type f ! -perm -444").output, "");
  for (const auto& program : fs::directory_iterator(folder / "usr/bin"))
    expect_whole_library_folders(program.path());
  const Outcome version = run_command(folder, "usr/bin/feldspar version");
  EXPECT_EQ(version.exit_code, 0) << version.error;
  EXPECT_EQ(version.output, run_command(folder, "'" FELDSPAR_COMMAND "' version").output);
  const Outcome checked = run_command(
    folder.path(), "usr/bin/feldspar parameters --check usr/share/doc/feldspar/examples/first-run/granite.prm");
  EXPECT_EQ(checked.exit_code, 0) << checked.error;
  const Outcome page = run_command(folder, "cat usr/share/man/man1/feldspar.1");
  EXPECT_TRUE(has_words(page.output, "calibrate"));
  const Outcome completed =
    run_command(folder, "bash -c '. usr/share/bash-completion/completions/feldspar && complete -p feldspar'");
  EXPECT_EQ(completed.exit_code, 0) << completed.error;
}
} // namespace
} // namespace feldspar::tests
