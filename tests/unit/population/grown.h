// Scenes of competing plants, ready for the field-of-neighbourhood passes.
#pragma once

#include <cmath>
#include <string>

#include "silvasim/population/neighbourhoods.h"
#include "tests/unit/evaluators/scene.h"

namespace silvasim::population {

inline double wave(double x, double y) { return 0.5 + 0.5 * std::sin(x / 171) * std::cos(y / 253); }
inline double bumps(double x, double y) { return 0.5 + 0.5 * std::cos(x / 71 + y / 129); }

// A plant that thrives where the fields a and b are near values of its own. Radii at scale 1.
inline std::string plant(const std::string& name, double mean, double model_m = 4, double reach_m = 14) {
  return "<plant name=\"" + name + "\"><model radius=\"" + std::to_string(model_m) + " m\"/><neighbourhood radius=\"" +
         std::to_string(reach_m) + " m\"/><property name=\"A\"><Gauss mean=\"" + std::to_string(mean) +
         "\" deviation=\"0.35\"/></property><property name=\"B\"><Gauss mean=\"" + std::to_string(1 - mean * 0.8) +
         "\" deviation=\"0.5\"/></property></plant>";
}

inline const std::string pipeline_element =
    "<pipeline><FunctionEvaluator><datafield>a</datafield><property>A</property></FunctionEvaluator>"
    "<FunctionEvaluator><datafield>b</datafield><property>B</property></FunctionEvaluator></pipeline>";
inline const std::string tiles_element = "<tiles side=\"80 m\"><radii least=\"2 m\" most=\"6 m\"/></tiles>";
inline constexpr double tile_m = 80;
inline const std::string three = plant("one", 0.2) + plant("two", 0.5) + plant("three", 0.8);
inline const std::string certain = "<establishment chance=\"certain\"/>";

struct Grown {
  evaluators::Scene scene;
  evaluators::Suitability suitability;

  const config::LayerSettings& layer() const { return scene.scenario.layers[0]; }
  Competition compete(std::uint64_t seed, const NeighbourhoodOptions& options = {}) const {
    return population::compete(suitability, scene.ground(), layer(), seed, options);
  }
};

inline Grown grow(const std::string& neighbourhoods, const std::string& plants = three, double side = 1200,
                  const std::string& establishment = certain,
                  const evaluators::FieldFunctions& fields = {wave, bumps}) {
  Grown grown{
      evaluators::make_scene(tiles_element + pipeline_element + establishment + neighbourhoods, plants, fields, side),
      {}};
  grown.suitability = evaluators::evaluate_sites(evaluators::Network(grown.scene.scenario, 0), grown.scene.ground());
  return grown;
}

// The same influence of all on all.
inline std::string influences(double value, const std::string& attributes) {
  return "<neighbourhoods " + attributes + "><influence from=\"*\" on=\"*\" value=\"" + std::to_string(value) +
         "\"/></neighbourhoods>";
}

// Influences that differ between the three species, so that neighbours change who is best.
inline std::string rivalry(double strength, const std::string& attributes) {
  const char* const names[] = {"one", "two", "three"};
  std::string text = "<neighbourhoods " + attributes + ">";
  for (int from = 0; from < 3; ++from) {
    for (int on = 0; on < 3; ++on) {
      const double value = -strength * (from == on ? 0.2 : 1.0 - 0.3 * ((on - from + 3) % 3 == 1));
      text += std::string("<influence from=\"") + names[from] + "\" on=\"" + names[on] + "\" value=\"" +
              std::to_string(value) + "\"/>";
    }
  }
  return text + "</neighbourhoods>";
}

}  // namespace silvasim::population
