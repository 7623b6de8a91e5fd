// The models of an ecosystem's species: read from the files that its plants.xml names, or grown.
//
// A species' model is, in this order: what `overrides` says for its name; the file that the ecosystem names, relative to
// `folder`; the word "grown" or nothing: a plant grown by its name and measures (assets/grown). A file that is missing is a
// warning, and the species is grown instead; one that is broken is an error.
// Threads: parallel inside. Cost: 0.15 s a grown model of 40,000 triangles on one core, half of it its impostor.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "silvasim/base/progress.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvavis/scene/scene.h"

namespace silvavis {

struct FloraOptions {
  std::filesystem::path folder;                  // of the plants file; relative model paths begin here
  std::map<std::string, std::string> overrides;  // scientific name -> model file, or "grown", or "none"
  std::vector<std::string> layers;               // only these; empty: all
  int triangles = 40000;                         // of a grown tree; smaller plants have fewer
  int variants = 2;                              // grown models a species
  bool levels = true;                            // make simpler levels too
  std::uint64_t seed = 1;
};

struct Flora {
  std::vector<std::vector<scene::SpeciesModelSet>> models;  // by layer, by species
  std::vector<std::vector<std::string>> sources;            // the same: the file, "grown", or "" for what is not drawn
  std::vector<std::string> warnings;
};

// Species without a single plant get no model.
Flora models_of(const silvasim::ecosystem::Ecosystem& ecosystem, const FloraOptions& options,
                const silvasim::base::Progress& progress = {});

}  // namespace silvavis
