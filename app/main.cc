#include "app/commands/commands.h"
#include "app/commands/manual.h"
#include "app/input/nearest_name.h"
#include "app/run/interrupt.h"
#include "app/run/other_program.h"
#include "app/screen/print_result.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/whole_file.h"
#include "dem/genesis/packing_export.h"
#include "feldspar_version.h"

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace
{
using namespace feldspar;

std::vector<std::string> names_of_commands_with_input()
{
  return mapped<std::string>(commands_with_input, &CommandWithInput::name);
}

constexpr std::size_t longest_line = 2000; // of standard error, whatever it repeats

/// Prints on standard error in one printable line, without an exception if standard error lies on the disk that is
/// full.
void say(std::string text)
{
  std::ranges::replace(text, '\n', ' ');
  std::fputs(fmt::format("feldspar: {}\n", shortened(text, longest_line)).c_str(), stderr);
}

/// The command line that `feldspar` understands, and what it was told.
class CommandLine
{
public:
  CommandLine()
  {
    app.set_version_flag("--version", fmt::format("feldspar {}", version));
    app.require_subcommand(0, 1);
    for (const CommandWithInput& command : commands_with_input)
      add_run(command);
    add_extract(*app.get_subcommand("multiscale"));
    add_packings(*app.get_subcommand("specimen"));
    add_report();
    add_parameters();
    add_new();
    add_texts();
  }

  /// Returns the exit code.
  int run(const int argc, const char* const* argv)
  {
    if (argc > 1 && !std::string_view(argv[1]).starts_with('-'))
      check_name(argv[1]); // CLI11 would only say that the word was not expected
    try
      {
        app.parse(argc, argv);
      }
    catch (const CLI::ParseError& error)
      {
        return explain(error);
      }
    if (!chosen)
      {
        print_result("{}", app.help());
        return 0;
      }
    std::optional<tbb::global_control> limit;
    if (n_threads)
      limit.emplace(tbb::global_control::max_allowed_parallelism, *n_threads);
    return chosen();
  }

private:
  void add_run(const CommandWithInput& of)
  {
    CLI::App& command = *app.add_subcommand(std::string(of.name), std::string(of.description));
    command.add_option("INPUT", common.input, "parameter file, .prm or .json")->required();
    command.add_option("--output", common.output, "folder of the results (default: INPUT-results-001, ...)")
      ->type_name("DIR");
    command.add_flag("--force", common.force, "write over what is in the folder");
    add_settings(command, common.settings);
    add_threads(command);
    command.add_flag("--quiet", common.quiet, "no progress, and of the results only where they are");
    command.callback([this, &of] { chosen = [this, &of] { return of.run(common); }; });
    add_examples(command, of.examples);
    if (of.runs_long)
      add_resume(command);
  }

  static CLI::Option* add_settings(CLI::App& command, std::vector<std::string>& settings)
  {
    return command.add_option("--set", settings, "an entry in place of what INPUT says; may be repeated")
      ->type_name("'SECTION/ENTRY = VALUE'")
      ->allow_extra_args(false);
  }

  void add_resume(CLI::App& command)
  {
    CLI::Option* const resume =
      command.add_option("--resume", common.resume, "take up the run of this folder; instead of INPUT")
        ->type_name("DIR");
    command.get_option("INPUT")->required(false)->excludes(resume);
    command.get_option("--set")->excludes(resume);
    command.get_option("--output")->excludes(resume);
    command.get_option("--force")->excludes(resume);
  }

  void add_extract(CLI::App& command)
  {
    CLI::Option* const extract =
      command
        .add_option("--extract", common.extract,
                    "write the RVE at a point for `feldspar rve` and ParaView; INPUT is the folder of a run")
        ->type_name("CELL:POINT");
    for (const char* const other : {"--resume", "--output", "--force"})
      command.get_option(other)->excludes(extract);
    extract->needs(command.get_option("INPUT"));
  }

  void add_packings(CLI::App& command)
  {
    auto names = mapped<std::string>(packing_forms, &PackingForm::name);
    command
      .add_option("--packing", common.packings,
                  "write the grains into packings/ too: yade (lines x y z radius) or lammps (data with bonds)")
      ->type_name("FORM")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names).description(""));
  }

  void add_threads(CLI::App& command)
  {
    command.add_option("--threads", n_threads, "how many to use (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1u, 4096u).description("")); // its range would stand beside the N
  }

  void add_new()
  {
    CLI::App& command = *app.add_subcommand("new", "write a commented input to begin with, and a reference to fill in");
    command.add_option("NAME", fresh.name, fmt::format("{}", fmt::join(names_of_templates(), ", ")))
      ->required()
      ->check(CLI::IsMember(names_of_templates()).description(""));
    command.add_option("--output", fresh.output, "folder of both files (default: the current one)")->type_name("DIR");
    command.callback([this] { chosen = [this] { return run_new(fresh); }; });
    add_examples(command, "feldspar new rock\n  feldspar new sample --output granite");
  }

  void add_report()
  {
    CLI::App& command = *app.add_subcommand("report", "(re)make the comparison report from result folders");
    command.add_option("RESULTS", report.result_folders,
                       "folders of `feldspar lab` and `multiscale`; each is a series of its own");
    command.add_option("--curve", report.curves, "a stress-strain curve measured in a laboratory; may be repeated")
      ->type_name("CSV")
      ->allow_extra_args(false);
    CLI::Option* const curve = command.get_option("--curve");
    command
      .add_option(
        "--curve-size", report.curve_sizes,
        "diameter and height (of a disc thickness) of its specimen, for forces and displacements: \"50, 100 mm\"; "
        "once for all curves, or once for each")
      ->type_name("SIZE")
      ->allow_extra_args(false)
      ->needs(curve);
    command
      .add_option(
        "--curve-test", report.curve_tests,
        "the test of a curve: direct_tension, brazilian, or one of compression (default); once for all curves, "
        "or once for each")
      ->type_name("TEST")
      ->allow_extra_args(false)
      ->needs(curve);
    command
      .add_option("--catalogue", report.catalogues,
                  "acoustic emission recorded in a laboratory, a row for each event or hit; may be repeated")
      ->type_name("CSV")
      ->allow_extra_args(false);
    command
      .add_option("--reference", report.reference, "figures of the rock (default: those the runs were set beside)")
      ->type_name("JSON");
    command
      .add_option("--output", report.output,
                  "folder of the report (default: the folder itself if there is one, else report-results-001, ...)")
      ->type_name("DIR");
    command.add_flag("--film", report.film, "write the cracking of the tests as film.webp too, by Chromium");
    command
      .add_option(
        "--quakeml", report.quakeml,
        "write the acoustic emission of the tests into quakeml/ too; latitude, longitude, depth and time of the "
        "origin of the axes: \"41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z\"")
      ->type_name("ORIGIN");
    command.add_flag("--force", report.force, "write over what is in the folder");
    add_threads(command);
    command.add_flag("--quiet", report.quiet, "do not say what is missing in it");
    command.callback([this] { chosen = [this] { return run_report(report); }; });
    add_examples(command, "feldspar report granite slate --reference rock.json\n"
                          "  feldspar report granite --curve core.csv\n"
                          "  feldspar report --curve disc.csv --curve-test brazilian --curve-size '50, 25 mm'\n"
                          "  feldspar report granite --catalogue emission.csv\n"
                          "  feldspar report granite --film");
  }

  void add_parameters()
  {
    CLI::App& command = *app.add_subcommand("parameters", "every parameter: unit, default, range, meaning");
    CLI::Option* const section =
      command.add_option("SECTION", parameters.section, "only this one, or the entries that have this word");
    CLI::Option* const check = command.add_option("--check", parameters.check, "only check this input file");
    check->type_name("INPUT");
    command.add_option("--for", parameters.check_for, "whether this command takes it (default: say which do)")
      ->type_name("COMMAND")
      ->check(CLI::IsMember(names_of_commands_with_input()).description(""))
      ->needs(check);
    add_settings(command, parameters.settings)->needs(check);
    command
      .add_flag("--results", parameters.results,
                "the quantities of results and the columns of curves instead, as docs/results.md")
      ->excludes(section)
      ->excludes(check);
    command.add_flag("--markdown", parameters.markdown, "as tables for docs/parameters.md");
    command.callback([this] { chosen = [this] { return run_parameters(parameters); }; });
    add_examples(command, "feldspar parameters Tests\n  feldspar parameters friction\n"
                          "  feldspar parameters --check granite.prm --for lab");
  }

  /// The help on this command; null: on the program.
  std::string help_text(const CLI::App* const command) const
  {
    return help_on(command ? *command : app, app.get_name() + (command ? " " + command->get_name() : std::string()));
  }

  /// A subcommand that prints a text.
  CLI::App& add_text(const char* name, const char* description, const std::function<std::string()>& text)
  {
    CLI::App& command = *app.add_subcommand(name, description);
    command.callback([this, text] {
      chosen = [text] {
        print_result("{}", text());
        return 0;
      };
    });
    return command;
  }

  void add_texts()
  {
    add_text("help", "the same as --help, or as COMMAND --help", [this] {
      check_name(helped.empty() ? "help" : helped);
      return help_text(helped.empty() ? nullptr : app.get_subcommand(helped));
    }).add_option("COMMAND", helped, "a command");
    add_text("version", "the same as --version", [] { return fmt::format("feldspar {}\n", version); });
    add_text("manual", "the manual page, for man: feldspar manual | man -l -", [this] { return manual_page(app); });
    add_text("completion", "completion for bash: source <(feldspar completion)",
             [this] { return bash_completion(app); });
  }

  /// With what a user would type.
  static void add_examples(CLI::App& command, const std::string_view examples)
  {
    command.footer(fmt::format("Examples:\n  {}", examples));
  }

  /// Prints help or version, which CLI11 throws too, or what is wrong.
  int explain(const CLI::ParseError& error) const
  {
    const auto subcommands = app.get_subcommands();
    if (error.get_name() == "CallForHelp")
      {
        print_result("{}", help_text(subcommands.empty() ? nullptr : subcommands.front()));
        return 0;
      }
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);
    const std::string unknown = subcommands.empty() ? "" : unknown_option(*subcommands.front());
    constexpr std::size_t most_characters = 400; // of words that are no command line
    say(fmt::format("{}; see feldspar {}--help", shortened(unknown.empty() ? error.what() : unknown, most_characters),
                    subcommands.empty() ? "" : subcommands.front()->get_name() + " "));
    return exit_code::user_error;
  }

  /// Names the first option of a command line that this command does not have, and those that are near; else empty.
  static std::string unknown_option(const CLI::App& command)
  {
    const std::vector<std::string> words = command.remaining();
    const auto word = std::ranges::find_if(words, [](const auto& one) { return one.starts_with("--"); });
    if (word == words.end())
      return "";
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options())
      for (const std::string& name : option->get_lnames())
        names.push_back("--" + name);
    const std::string given = word->substr(0, word->find('='));
    return fmt::format("{}: {} has no such option{}", excerpt(given), command.get_name(),
                       suggestion(given, {names.begin(), names.end()}));
  }

  void check_name(const std::string_view name) const
  {
    std::vector<std::string> names;
    for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    if (!contains(names, name))
      throw InputError("{}: no such command{}", excerpt(name), suggestion(name, {names.begin(), names.end()}));
  }

  CLI::App app{"Feldspar: laboratory tests on rock made of grains and joints", "feldspar"};
  CommonOptions common;
  ReportOptions report;
  ParametersOptions parameters;
  NewOptions fresh;
  std::string helped; ///< the command that help is asked for
  std::optional<unsigned int> n_threads;
  std::function<int()> chosen;
};

/// Opens standard streams that are closed: the first file to be opened would take the number of such a stream, and what
/// is printed would go into it.
void open_standard_streams()
{
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1)
      open("/dev/null", O_RDWR); // the lowest number that is free
}

/// The exit code of a command whose words may not have got through.
int after_output(const int code)
{
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
    return code;
  say("standard output: cannot be written");
  return code == 0 ? exit_code::output_error : code;
}
} // namespace

/// The program, for app/program.cc.
extern "C" int feldspar_main(const int argc, const char* const* argv)
{
  open_standard_streams();
  // A limit on the size of files and a reader that has gone come as errors of the write, which can be said.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try
    {
      check_version_of_caller();
      return after_output(CommandLine().run(argc, argv));
    }
  catch (const Interrupted&)
    {
      say("interrupted before there was a result; nothing was kept");
      return exit_code::interrupted;
    }
  catch (const InputError& error)
    {
      say(error.what());
      return exit_code::user_error;
    }
  catch (const OutputError& error)
    {
      say(error.what());
      return exit_code::output_error;
    }
  catch (const std::system_error& error) // a folder that cannot be made, a file that cannot be moved
    {
      say(error.what());
      return exit_code::output_error;
    }
  catch (const std::exception& error)
    {
      say(fmt::format("this should not have happened: {}", error.what()));
      std::fputs(fmt::format("To reproduce it, with feldspar {}: {}\n", version,
                             shortened(fmt::format("{}", fmt::join(argv, argv + argc, " ")), longest_line))
                   .c_str(),
                 stderr);
      return exit_code::internal_error;
    }
}
