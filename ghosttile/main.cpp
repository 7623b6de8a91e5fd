// The command line of ghosttile.
#include <CLI/CLI.hpp>
#include <string>

#include "ghosttile/commands/commands.h"
#include "ghosttile/export/formats.h"
#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/progress.h"
#include "silvasim/terminal/terminal.h"

namespace {

using namespace ghosttile::commands;

struct Options {
  CreateOptions create;
  FillOptions fill;
  EditOptions edit;
  InfoOptions info;
  ExportOptions exports;
  HelpOptions help;
};

void add_common(CLI::App& command, Common& common) {
  command.add_flag("--json", common.json, "Print one JSON object instead of text");
  command.add_flag("-q,--quiet", common.quiet, "No progress and no summary; only errors, and what was asked for");
  command
      .add_option("--threads", common.threads, "Threads to use; the result does not depend on it (default: one a core)")
      ->check(CLI::Range(1, 1024));
}

void add_create(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("create", "Make a Ghost Tile: candidates and the graph of their collisions");
  command->add_option("tile", o.create.tile, "The Ghost Tile's XML")->required();
  command->add_option("-o,--output", o.create.output,
                      "The file to write (default: the XML's name with .ghost, in this folder)");
  add_common(*command, o.create.common);
  command->callback([&o] { create(o.create); });
}

void add_fill(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("fill", "Fill land with details, as a scene says");
  command->add_option("scene", o.fill.scene, "The scene's XML")->required();
  command->add_option("-o,--output", o.fill.output,
                      "The file to write (default: the XML's name with .details, in this folder)");
  command->add_option("--bbox", o.fill.bbox, "WEST,SOUTH,EAST,NORTH: fill only this, in the land's metres")
      ->delimiter(',')
      ->expected(4);
  command->add_option("--around", o.fill.around, "EAST,NORTH: fill only around this point")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--radius", o.fill.radius_m, "Metres around the point (default: 20)")
      ->check(CLI::Range(0.1, 100000.0));
  add_common(*command, o.fill.common);
  command->callback([&o] { fill(o.fill); });
}

void add_edit(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("edit", "Add and remove details by strokes, or undo the last edit");
  command->add_option("details", o.edit.details, "The file of details")->required();
  command->add_option("strokes", o.edit.strokes, "The strokes' XML");
  command->add_flag("--undo", o.edit.undo, "Take the last edit back");
  command->add_option("-o,--output", o.edit.output, "The file to write (default: the file of details itself)");
  command->add_option("--scene", o.edit.scene, "The scene that it was filled from (default: the one that it names)");
  add_common(*command, o.edit.common);
  command->callback([&o] { edit(o.edit); });
}

void add_export(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("export", "Write details for other programs");
  std::string names;
  for (const auto& format : ghosttile::exports::formats()) names += (names.empty() ? "" : ", ") + format.name;
  command->add_option("details", o.exports.details, "The file of details")->required();
  command->add_option("--to", o.exports.format, "The format: " + names + " (default: by the output's extension)");
  command->add_option("-o,--output", o.exports.output, "The file to write")->required();
  add_common(*command, o.exports.common);
  command->callback([&o] { export_details(o.exports); });
}

void add_rest(CLI::App& app, Options& o) {
  CLI::App* command = app.add_subcommand("info", "Tell what a Ghost Tile or a file of details holds");
  command->add_option("file", o.info.file, "A file .ghost or .details")->required();
  add_common(*command, o.info.common);
  command->callback([&o] { info(o.info); });
  app.add_subcommand("schema", "Print the XML Schema of the XML files")->callback([] { schema(); });
  command = app.add_subcommand("help", "Explain an element of the XML files");
  command->add_option("element", o.help.element, "Element, like layer (default: all elements, a line each)");
  command->add_flag("--manual", o.help.manual, "The whole manual page, as Markdown");
  command->callback([&o] { help(o.help); });
}

}  // namespace

int main(int argc, char** argv) {
  silvasim::base::install_interrupt_handler();
  silvasim::base::give_back_large_blocks();
  CLI::App app("Silva covers the ground: leaves, twigs, stones and tufts that lie among each other.", "ghosttile");
  app.set_version_flag("--version", std::string("ghosttile ") + SILVA_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  Options options;
  add_create(app, options);
  add_fill(app, options);
  add_edit(app, options);
  add_export(app, options);
  add_rest(app, options);
  app.footer("ghosttile COMMAND --help tells a command's options.");
  return silvasim::terminal::run("ghosttile", "fill a smaller box", [&] {
    try {
      app.parse(argc, argv);
      return 0;
    } catch (const CLI::Success& done) {
      return app.exit(done);
    } catch (const CLI::ParseError& error) {
      throw silvasim::terminal::UsageError(error.what());
    }
  });
}
