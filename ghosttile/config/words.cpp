#include "ghosttile/config/words.h"

#include <charconv>
#include <cmath>

namespace ghosttile::config {

std::vector<double> numbers(const xml::Node& node, const std::string& attribute, std::size_t least, std::size_t most,
                            Errors& errors) {
  const std::string& text = node.string(attribute);
  std::vector<double> found;
  const char *at = text.data(), *end = text.data() + text.size();
  bool wrong = false;
  while (!wrong) {
    while (at < end && (*at == ' ' || *at == '\t' || *at == ',')) ++at;
    if (at == end) break;
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    wrong = error != std::errc{} || !std::isfinite(number) || std::abs(number) > 1e9 ||
            (next < end && *next != ' ' && *next != ',' && *next != '\t');
    found.push_back(number);
    at = next;
  }
  if (wrong || found.size() < least || found.size() > most) {
    const std::string wanted =
        least == most ? std::to_string(least) : std::to_string(least) + " or " + std::to_string(most);
    silvasim::base::add(errors, node.place_of(attribute),
                        attribute + ": \"" + text.substr(0, 80) + "\" should be " + wanted +
                            " numbers in metres, with commas between them");
    return std::vector<double>(most, 0.0);
  }
  found.resize(most, 0.0);
  return found;
}

assets::V3d place(const xml::Node& node, const std::string& attribute, Errors& errors) {
  const std::vector<double> v = numbers(node, attribute, 2, 3, errors);
  return {v[0], v[1], v[2]};
}

std::filesystem::path beside(const xml::Node& node, const std::string& path) {
  const std::filesystem::path named(path);
  return named.is_absolute() ? named
                             : (std::filesystem::path(node.place.file).parent_path() / named).lexically_normal();
}

}  // namespace ghosttile::config
