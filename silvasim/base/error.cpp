#include "silvasim/base/error.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace silvasim::base {

namespace {

std::string joined(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += to_string(diagnostic);
  }
  return text;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Levenshtein distance with adjacent transpositions counted as one edit, for short words.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> two_back, previous(b.size() + 1), current(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substituted});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], two_back[j - 2] + 1);
      }
    }
    two_back = previous;
    previous = current;
  }
  return previous[b.size()];
}

}  // namespace

std::string to_string(const Place& place) {
  std::string text = place.file.empty() ? "configuration" : place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  return to_string(diagnostic.place) + ": error: " + diagnostic.message;
}

void add(std::vector<Diagnostic>& diagnostics, Place place, std::string message) {
  if (diagnostics.size() > most_diagnostics) return;
  if (diagnostics.size() == most_diagnostics) message = "... and more";
  diagnostics.push_back({std::move(place), std::move(message)});
}

ConfigError::ConfigError(std::vector<Diagnostic> diagnostics)
    : Error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

ConfigError::ConfigError(Place place, std::string message)
    : ConfigError(std::vector<Diagnostic>{{std::move(place), std::move(message)}}) {}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 64;
  if (word.empty() || word.size() > longest) return {};
  std::size_t least = std::min(word.size(), std::max<std::size_t>(1, word.size() / 3) + 1);
  const std::string* best = nullptr;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(lower(word), lower(candidate));
    if (distance < least) {
      least = distance;
      best = &candidate;
    }
  }
  return best ? "; did you mean \"" + *best + "\"?" : std::string{};
}

}  // namespace silvasim::base
