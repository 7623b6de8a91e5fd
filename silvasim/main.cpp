// The command line of silvasim.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"
#include "silvasim/commands/commands.h"
#include "silvasim/export/formats.h"
#include "silvasim/provenance.h"
#include "silvasim/terminal/terminal.h"

namespace {

using namespace silvasim::commands;

void add_common(CLI::App& command, Common& common, bool json = true) {
  if (json) command.add_flag("--json", common.json, "Print one JSON object instead of text");
  command.add_flag("-q,--quiet", common.quiet, "No progress and no summary; only errors, and what was asked for");
  command
      .add_option("--threads", common.threads, "Threads to use; the result does not depend on it (default: one a core)")
      ->check(CLI::Range(1, 1024));
}

void add_scenario(CLI::App& command, ScenarioOptions& scenario) {
  command.add_option("ecosystem", scenario.ecosystem, "The ecosystem file (XML)")->required();
  command.add_option("--plants", scenario.plants, "The plants file (XML); default: the one the ecosystem file names");
  command.add_option("--seed", scenario.seed, "Overrides the ecosystem file's seed")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9007199254740991}));
}

struct Options {
  RunOptions run;
  ValidateOptions validate;
  ExplainOptions explain;
  InfoOptions info;
  PreviewOptions preview;
  ExportOptions exports;
  HelpOptions help;
  std::vector<double> at;
};

void add_run(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("run", "Grow the ecosystem and write it");
  add_scenario(*command, o.run.scenario);
  command->add_option("-o,--output", o.run.output,
                      "Ecosystem file to write; default: the XML file's name with .silva in this folder, and of a file "
                      "called ecosystem.xml its folder's name");
  command->add_option("--png", o.run.png, "Also write a map as PNG, with a world file");
  command->add_option("--svg", o.run.svg, "Also write a map as SVG, a layer a species");
  for (const auto& format : silvasim::exports::formats()) {
    const auto keep = [&o, name = format.name](const Path& path) { o.run.exports[name] = path; };
    const std::string what =
        format.maps ? "Also write maps of the place, and keep --probabilities: " : "Also write every plant: ";
    command->add_option_function<Path>("--" + format.name, keep, what + format.help);
  }
  command->add_flag(
      "--probabilities", o.run.probabilities,
      "Keep each plant's growth probability and a map of each species' suitability in the ecosystem file");
  add_common(*command, o.run.common);
  command->callback([&o] { run(o.run); });
}

void add_validate(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("validate", "Check an ecosystem file, its plants file and its data fields");
  add_scenario(*command, o.validate.scenario);
  command->add_flag("--xml-only", o.validate.xml_only, "Leave the data fields' files alone");
  add_common(*command, o.validate.common);
  command->callback([&o] { validate(o.validate); });
}

void add_explain(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("explain", "Tell why a plant stands at a point, or none");
  add_scenario(*command, o.explain.scenario);
  command->add_option("--at", o.at, "The point X,Y in the scene's metres")->required()->delimiter(',')->expected(2);
  command->add_flag("--degrees", o.explain.degrees, "The point is LONGITUDE,LATITUDE of WGS 84");
  add_common(*command, o.explain.common);
  command->callback([&o] {
    o.explain.x = o.at[0];
    o.explain.y = o.at[1];
    explain_point(o.explain);
  });
}

void add_info(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("info", "Tell what an ecosystem file holds");
  command->add_option("ecosystem", o.info.ecosystem, "The ecosystem file (.silva)")->required();
  add_common(*command, o.info.common);
  command->callback([&o] { info(o.info); });
}

void add_preview(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("preview", "Draw a map of an ecosystem file");
  command->add_option("ecosystem", o.preview.ecosystem, "The ecosystem file (.silva)")->required();
  command->add_option("-o,--output", o.preview.output, "The map, .png or .svg")->required();
  command->add_option("--species", o.preview.species, "Only this species (may be repeated)");
  command
      ->add_option(
          "--layer", o.preview.layer,
          "What to draw: the species, the growth probability of their plants, or how well the place suits them")
      ->check(CLI::IsMember({"species", "probability", "suitability"}));
  command->add_option("--bbox", o.preview.bbox, "WEST,SOUTH,EAST,NORTH in the scene's metres")
      ->delimiter(',')
      ->expected(4);
  command->add_option("--width", o.preview.width_px,
                      "Width of the picture in pixels, 240 to 20000; a bare map from 16 (default: 1600)");
  command->add_option("--title", o.preview.title, "Title of the map");
  command->add_flag("--bare", o.preview.bare, "The map alone, without title, legend and margins");
  add_common(*command, o.preview.common, false);
  command->callback([&o] { preview(o.preview); });
}

void add_export(CLI::App& app, Options& o) {
  CLI::App* command =
      app.add_subcommand("export", "Write an ecosystem file's plants, or maps of its place, for other programs");
  std::string names;
  for (const auto& format : silvasim::exports::formats()) names += (names.empty() ? "" : ", ") + format.name;
  command->add_option("ecosystem", o.exports.ecosystem, "The ecosystem file (.silva)")->required();
  command->add_option("--to", o.exports.format, "The format: " + names + " (default: by the output's extension)");
  command->add_option("-o,--output", o.exports.output, "The file to write")->required();
  add_common(*command, o.exports.common, false);
  command->callback([&o] { export_plants(o.exports); });
}

const CLI::App* command_of(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

void add_dialect(CLI::App& app, Options& o) {
  app.add_subcommand("schema", "Print the XML Schema of the two XML files")->callback([] { schema(); });
  CLI::App* command = app.add_subcommand("help", "Explain an element of the XML files, or a command");
  command->add_option("element", o.help.element,
                      "Element, like MinMaxEvaluator, or command, like run (default: all elements, a line each)");
  command->add_flag("--manual", o.help.manual, "The whole manual page, as Markdown");
  command->callback([&app, &o] {
    if (const CLI::App* other = command_of(app, o.help.element)) {
      fmt::print("{}", other->help());
    } else {
      help(o.help);
    }
  });
}

// What stands where a command should, and is none: the library would only say that one is missing.
void check_command(const CLI::App& app, const std::string& word) {
  if (word.empty() || word[0] == '-' || command_of(app, word)) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  throw CLI::ParseError("there is no command \"" + word + "\"" + silvasim::base::did_you_mean(word, names), 2);
}

}  // namespace

int main(int argc, char** argv) {
  silvasim::base::install_interrupt_handler();
  CLI::App app("Silva grows landscapes: two XML files and GIS data become a plant population.", "silvasim");
  app.set_version_flag("--version", std::string("silvasim ") + silvasim::version);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  Options options;
  add_run(app, options);
  add_validate(app, options);
  add_info(app, options);
  add_preview(app, options);
  add_explain(app, options);
  add_export(app, options);
  add_dialect(app, options);
  app.footer("silvasim COMMAND --help tells a command's options.");
  return silvasim::terminal::run("silvasim", "lessen the scene, or run it in parts", [&] {
    try {
      check_command(app, argc > 1 ? argv[1] : "");
      app.parse(argc, argv);
      return 0;
    } catch (const CLI::Success& done) {
      return app.exit(done);
    } catch (const CLI::ParseError& error) {
      throw silvasim::terminal::UsageError(error.what());
    }
  });
}
