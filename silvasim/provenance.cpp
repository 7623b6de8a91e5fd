#include "silvasim/provenance.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace silvasim {

namespace {

// Absolute names would tell the machine, and make bytes differ between machines.
std::string without_folder_of_machine(const std::filesystem::path& path) {
  return path.is_absolute() ? path.filename().string() : path.generic_string();
}

}  // namespace

std::string provenance(const config::Scenario& scenario, const fields::FieldSet& fields) {
  nlohmann::ordered_json json;
  json["program"] = "silvasim";
  json["version"] = version;
  json["seed"] = scenario.seed;
  json["config_sha256"] = scenario.sha256;
  // The folder of the first file is the root: where a run was started from must not change its bytes.
  const std::filesystem::path root = scenario.files.empty()
                                         ? std::filesystem::path()
                                         : std::filesystem::path(scenario.files.front().path).parent_path();
  for (const config::SourceFile& file : scenario.files) {
    json["config"].push_back({{"path", without_folder_of_machine(std::filesystem::path(file.path).lexically_relative(
                                           root.empty() ? "." : root))},
                              {"sha256", file.sha256},
                              {"text", file.text}});
  }
  json["fields"] = nlohmann::ordered_json::array();
  for (const fields::Field& field : fields.fields) {
    nlohmann::ordered_json entry = {{"name", field.name}, {"source", field.source}};
    if (!field.path.empty()) {
      entry["file"] = field.path.filename().string();
      entry["sha256"] = field.sha256;
    }
    json["fields"].push_back(entry);
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace silvasim
