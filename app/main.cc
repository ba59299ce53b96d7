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
  /// A subcommand that does this, with what a user would type.
  CLI::App& add(const std::string_view name, const std::string_view description, const std::function<int()>& run,
                const std::string_view examples = "")
  {
    CLI::App& command = *app.add_subcommand(std::string(name), std::string(description));
    command.callback([this, run] { chosen = run; });
    if (!examples.empty())
      command.footer(fmt::format("Examples:\n  {}", examples));
    return command;
  }

  /// An option with a value of this type; where there may be several, each has the option before it.
  template <typename Value>
  static CLI::Option* add_option(CLI::App& command, const char* name, Value& value, const char* type,
                                 const char* description)
  {
    return command.add_option(name, value, description)->type_name(type)->allow_extra_args(false);
  }

  void add_run(const CommandWithInput& of)
  {
    CLI::App& command = add(
      of.name, of.description, [this, &of] { return of.run(common); }, of.examples);
    command.add_option("INPUT", common.input, "parameter file, .prm or .json")->required(!of.runs_long);
    add_option(command, "--output", common.output, "DIR", "folder of the results (default: INPUT-results-001, ...)");
    command.add_flag("--force", common.force, "write over what is in the folder");
    add_settings(command, common.settings);
    add_threads(command);
    command.add_flag("--quiet", common.quiet, "no progress, and of the results only where they are");
    if (!of.runs_long)
      return;
    CLI::Option* const resume =
      add_option(command, "--resume", common.resume, "DIR", "take up the run of this folder; instead of INPUT");
    for (const char* const other : {"INPUT", "--set", "--output", "--force"})
      command.get_option(other)->excludes(resume);
  }

  static CLI::Option* add_settings(CLI::App& command, std::vector<std::string>& settings)
  {
    return add_option(command, "--set", settings, "'SECTION/ENTRY = VALUE'",
                      "an entry in place of what INPUT says; may be repeated");
  }

  void add_extract(CLI::App& command)
  {
    CLI::Option* const extract =
      add_option(command, "--extract", common.extract, "CELL:POINT",
                 "write the RVE at a point for `feldspar rve` and ParaView; INPUT is the folder of a run");
    for (const char* const other : {"--resume", "--output", "--force"})
      command.get_option(other)->excludes(extract);
    extract->needs(command.get_option("INPUT"));
  }

  void add_packings(CLI::App& command)
  {
    add_option(command, "--packing", common.packings, "FORM",
               "write the grains into packings/ too: yade (lines x y z radius) or lammps (data with bonds)")
      ->check(CLI::IsMember(mapped<std::string>(packing_forms, &PackingForm::name)).description(""));
  }

  void add_threads(CLI::App& command)
  {
    add_option(command, "--threads", n_threads, "N", "how many to use (default: all cores)")
      ->check(CLI::Range(1u, 4096u).description("")); // its range would stand beside the N
  }

  void add_new()
  {
    CLI::App& command = add(
      "new", "write a commented input to begin with, and a reference to fill in", [this] { return run_new(fresh); },
      "feldspar new rock\n  feldspar new sample --output granite");
    command.add_option("NAME", fresh.name, fmt::format("{}", fmt::join(names_of_templates(), ", ")))
      ->required()
      ->check(CLI::IsMember(names_of_templates()).description(""));
    add_option(command, "--output", fresh.output, "DIR", "folder of both files (default: the current one)");
  }

  void add_report()
  {
    CLI::App& command = add(
      "report", "(re)make the comparison report from result folders", [this] { return run_report(report); },
      "feldspar report granite slate --reference rock.json\n"
      "  feldspar report granite --curve core.csv\n"
      "  feldspar report --curve disc.csv --curve-test brazilian --curve-size '50, 25 mm'\n"
      "  feldspar report granite --catalogue emission.csv\n"
      "  feldspar report granite --film");
    command.add_option("RESULTS", report.result_folders,
                       "folders of `feldspar lab` and `multiscale`; each is a series of its own");
    CLI::Option* const curve = add_option(command, "--curve", report.curves, "CSV",
                                          "a stress-strain curve measured in a laboratory; may be repeated");
    add_option(
      command, "--curve-size", report.curve_sizes, "SIZE",
      "diameter and height (of a disc thickness) of its specimen, for forces and displacements: \"50, 100 mm\"; "
      "once for all curves, or once for each")
      ->needs(curve);
    add_option(command, "--curve-test", report.curve_tests, "TEST",
               "the test of a curve: direct_tension, brazilian, or one of compression (default); once for all curves, "
               "or once for each")
      ->needs(curve);
    add_option(command, "--catalogue", report.catalogues, "CSV",
               "acoustic emission recorded in a laboratory, a row for each event or hit; may be repeated");
    add_option(command, "--reference", report.reference, "JSON",
               "figures of the rock (default: those the runs were set beside)");
    add_option(command, "--output", report.output, "DIR",
               "folder of the report (default: the folder itself if there is one, else report-results-001, ...)");
    command.add_flag("--film", report.film, "write the cracking of the tests as film.webp too, by Chromium");
    add_option(command, "--quakeml", report.quakeml, "ORIGIN",
               "write the acoustic emission of the tests into quakeml/ too; latitude, longitude, depth and time of the "
               "origin of the axes: \"41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z\"");
    command.add_flag("--force", report.force, "write over what is in the folder");
    add_threads(command);
    command.add_flag("--quiet", report.quiet, "do not say what is missing in it");
  }

  void add_parameters()
  {
    CLI::App& command = add(
      "parameters", "every parameter: unit, default, range, meaning", [this] { return run_parameters(parameters); },
      "feldspar parameters Tests\n  feldspar parameters friction\n"
      "  feldspar parameters --check granite.prm --for lab");
    CLI::Option* const section =
      command.add_option("SECTION", parameters.section, "only this one, or the entries that have this word");
    CLI::Option* const check = add_option(command, "--check", parameters.check, "INPUT", "only check this input file");
    add_option(command, "--for", parameters.check_for, "COMMAND",
               "whether this command takes it (default: say which do)")
      ->check(CLI::IsMember(mapped<std::string>(commands_with_input, &CommandWithInput::name)).description(""))
      ->needs(check);
    add_settings(command, parameters.settings)->needs(check);
    command
      .add_flag("--results", parameters.results,
                "the quantities of results and the columns of curves instead, as docs/results.md")
      ->excludes(section)
      ->excludes(check);
    command.add_flag("--markdown", parameters.markdown, "as tables for docs/parameters.md");
  }

  /// The help on this command; null: on the program.
  std::string help_text(const CLI::App* const command) const
  {
    return help_on(command ? *command : app, app.get_name() + (command ? " " + command->get_name() : std::string()));
  }

  /// A subcommand that prints a text.
  CLI::App& add_text(const char* name, const char* description, const std::function<std::string()>& text)
  {
    return add(name, description, [text] {
      print_result("{}", text());
      return 0;
    });
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
    const auto names =
      mapped<std::string_view>(app.get_subcommands([](const CLI::App*) { return true; }), &CLI::App::get_name);
    if (!contains(names, name))
      throw InputError("{}: no such command{}", excerpt(name), suggestion(name, names));
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
