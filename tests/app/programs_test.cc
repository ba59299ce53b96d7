// Libraries of the programs, a program that goes on as another, an installation.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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
  const auto libraries = [&](const std::string& program) {
    const fs::path place = fs::path(FELDSPAR_COMMAND).replace_filename(program);
    return run_command(folder.path(), fmt::format("LD_TRACE_LOADED_OBJECTS=1 '{}'", place.string())).output;
  };
  const auto loads = [&](const std::string& program, const std::string& library) {
    return libraries(program).find(library) != std::string::npos;
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
        const std::string path = line.substr(line.find('[') + 1, line.find(']') - line.find('[') - 1);
        for (std::size_t begin = 0; begin <= path.size();)
          {
            const std::size_t end = std::min(path.find(':', begin), path.size());
            folders.push_back(path.substr(begin, end - begin));
            begin = end + 1;
          }
      }
  return folders;
}

/// An empty name is the current folder, where anybody may have put a library.
void expect_whole_library_folders(const fs::path& program)
{
  const TemporaryFolder folder;
  const auto read = run_command(folder.path(), fmt::format("LC_ALL=C readelf -dW '{}'", program.string()));
  EXPECT_NE(read.output.find("(NEEDED)"), std::string::npos) << program << read.error;
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
  const fs::path programs = folder.path() / "bin";
  fs::create_directory(programs);
  fs::create_directory_symlink(FELDSPAR_BUILD_DIR "/lib", folder.path() / "lib");
  fs::copy_file(FELDSPAR_COMMAND, programs / "feldspar");
  std::ofstream(folder.path() / "rock.prm") << "subsection Specimen\n  set Width = 20 mm\nend\n";
  for (const auto& [words, program] : {std::pair("multiscale rock.prm", "feldspar-multiscale"),
                                       {"parameters --check rock.prm", "feldspar-multiscale"},
                                       {"calibrate rock.prm", "feldspar-calibrate"}})
    {
      const auto alone = run_command(folder.path(), fmt::format("bin/feldspar {}", words));
      EXPECT_EQ(alone.exit_code, 2);
      EXPECT_NE(alone.error.find(fmt::format("{}: cannot be run", program)), std::string::npos) << alone.error;
    }

  fs::copy_file(fs::path(FELDSPAR_COMMAND).replace_filename("feldspar-multiscale"), programs / "feldspar-multiscale");
  const std::string check = "bin/feldspar parameters --check rock.prm --for lab";
  const auto installed = run_command(folder.path(), check);
  EXPECT_EQ(installed.exit_code, 0) << installed.error;

  const auto of_another = run_command(folder.path(), "FELDSPAR_VERSION_OF_CALLER=0.0.1 " + check);
  EXPECT_EQ(of_another.exit_code, 2);
  EXPECT_NE(of_another.error.find("and feldspar of 0.0.1; build or install both anew"), std::string::npos)
    << of_another.error;
}

TEST(Programs, TakeTheCodeOfTheHighestLevelThatTheProcessorHas)
{
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "bin");
  fs::copy_file(FELDSPAR_COMMAND, folder.path() / "bin/feldspar");
  const fs::path place = folder.path() / "lib/feldspar";
  for (const char* const level : {"", "glibc-hwcaps/x86-64-v3", "glibc-hwcaps/x86-64-v4"})
    {
      fs::create_directories(place / level);
      fs::copy_file(FELDSPAR_BUILD_DIR "/lib/feldspar/libfeldspar-code.so", place / level / "libfeldspar-code.so");
    }
  // The loader of a processor without what each level adds to the one before.
  for (const auto& [without, taken] :
       {std::pair("AVX512F", "glibc-hwcaps/x86-64-v3/"), {"AVX512F,-AVX2", "lib/feldspar/libfeldspar-code.so"}})
    {
      const auto loaded =
        run_command(folder.path(),
                    fmt::format("GLIBC_TUNABLES=glibc.cpu.hwcaps=-{} LD_TRACE_LOADED_OBJECTS=1 bin/feldspar", without));
      EXPECT_NE(loaded.output.find(taken), std::string::npos) << without << ": " << loaded.output;
    }
}

// Installation of a build by ./bootstrap.sh install, and the parts of it that a user meets first.
TEST(Installation, HasProgramManualCompletionAndExamples)
{
  const TemporaryFolder folder;
  const Outcome installed =
    run_command(folder.path(), "umask 077; cmake --install '" FELDSPAR_BUILD_DIR "' --prefix usr --strip > installed");
  ASSERT_EQ(installed.exit_code, 0) << installed.error;
  // For everybody, whatever the umask of who installs or packs; bootstrap.sh sees to that of folders.
  EXPECT_EQ(run_command(folder.path(), "find usr -type f ! -perm -444").output, "");
  for (const auto& program : fs::directory_iterator(folder.path() / "usr/bin"))
    expect_whole_library_folders(program.path());
  const Outcome version = run_command(folder.path(), "usr/bin/feldspar version");
  EXPECT_EQ(version.exit_code, 0) << version.error;
  EXPECT_EQ(version.output, run_command(folder.path(), "'" FELDSPAR_COMMAND "' version").output);
  const Outcome checked = run_command(
    folder.path(), "usr/bin/feldspar parameters --check usr/share/doc/feldspar/examples/first-run/granite.prm");
  EXPECT_EQ(checked.exit_code, 0) << checked.error;
  const Outcome page = run_command(folder.path(), "cat usr/share/man/man1/feldspar.1");
  EXPECT_NE(page.output.find("calibrate"), std::string::npos);
  const Outcome completed =
    run_command(folder.path(), "bash -c '. usr/share/bash-completion/completions/feldspar && complete -p feldspar'");
  EXPECT_EQ(completed.exit_code, 0) << completed.error;
}
} // namespace
} // namespace feldspar::tests
