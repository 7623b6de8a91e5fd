// Shared by the sources that turn checked nodes into a Scenario. Not for other rooms.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/scenario.h"

namespace silvasim::config {

struct Loading {
  const Dialect& dialect;
  std::vector<base::Diagnostic> errors;
  std::vector<SourceFile> files;

  void error(const base::Place& place, std::string message) { base::add(errors, place, std::move(message)); }
};

// A file name in the XML, relative to the file that names it.
std::filesystem::path beside(const base::Place& place, const std::string& name);

// "ecosystem.xml:12", for messages that point to a second place.
std::string short_place(const base::Place& place);

// A plant's scientific name as written, or its model file's; "" where it has neither.
std::string plant_name(const Node& plant);

void read_scene(Loading& loading, const Node& ecosystem, Scenario& scenario);
void read_fields(Loading& loading, const Node& ecosystem, Scenario& scenario);

// Creates the layers, without species.
void read_layers(Loading& loading, const Node& ecosystem, Scenario& scenario);

// Puts each plant into its layer.
void read_plants(Loading& loading, const Node& plants, Scenario& scenario);

// With the species known: each layer's pipeline and influences.
void read_pipelines(Loading& loading, const Node& ecosystem, const Node& plants, Scenario& scenario);

// The nodes that hold the layers' parts: the <layer> elements, or the ecosystem itself.
std::vector<const Node*> layer_nodes(const Node& ecosystem);

}  // namespace silvasim::config
