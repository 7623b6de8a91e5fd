#include "assets/load.h"

#include <algorithm>
#include <cctype>
#include <new>
#include <string>

#include "assets/draft.h"
#include "assets/finish.h"
#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace assets {

namespace base = silvasim::base;

void Reading::fail(const std::string& what) const {
  throw base::Error(file.string() + ": " + base::shortened(what, 300));
}

void Reading::fail_at(std::size_t line, const std::string& what) const {
  throw base::Error(file.string() + ":" + std::to_string(line) + ": " + base::shortened(what, 300));
}

void Reading::warn(const std::string& what) {
  constexpr std::size_t most = 100;
  if (++warnings > most || report == nullptr) return;
  report->warnings.push_back(file.string() + ": " + (warnings == most ? "... and more" : base::shortened(what, 300)));
}

void Reading::check_triangles(std::size_t count) const {
  if (count > options.most_triangles) {
    fail("it has more than " + std::to_string(options.most_triangles) + " triangles; thin the model out");
  }
}

namespace {

Draft read_draft(Reading& reading) {
  std::string extension = reading.file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".obj") return read_obj(reading);
  if (extension == ".gltf" || extension == ".glb") return read_gltf(reading);
  if (extension == ".ply") return read_ply(reading);
  reading.fail("the name does not tell a known format; it should end in .obj, .gltf, .glb or .ply");
}

}  // namespace

Model load(const std::filesystem::path& file, const LoadOptions& options, LoadReport* report) {
  Reading reading{file, options, report};
  try {
    Model model = finished(read_draft(reading), reading);
    model.name = base::printable(file.stem().string());
    return model;
  } catch (const base::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    reading.fail("it needs more memory than there is");
  } catch (const std::exception& error) {  // of a foreign library, which met what it did not expect
    reading.fail(std::string("it is damaged: ") + error.what());
  }
}

}  // namespace assets
