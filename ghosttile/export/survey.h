// What an export must know of all instances before it writes the first.
//
// Errors: base::Error where an instance's place, turn or scale is no finite number.
// Cost: a pass over the instances.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "ghosttile/fill/file.h"
#include "ghosttile/fill/instances.h"
#include "silvasim/base/progress.h"

namespace ghosttile::exports {

using assets::V2;
using assets::V3;
using assets::V3d;

struct Survey {
  std::uint64_t instances = 0;
  std::uint64_t triangles = 0;           // of all instances
  std::vector<std::uint64_t> of_object;  // instances
  std::vector<std::size_t> used;         // objects that have instances, ascending
  V3d least{0, 0, 0}, most{0, 0, 0};     // all triangles lie within, scene coordinates; zero without instances
  V3d origin{0, 0, 0};  // the middle, in whole hundreds of metres: floats from it are good to 0.01 mm a
                        // hundred metres, and exports of neighbouring land often share it
};

Survey survey(const fill::DetailsFile& file);

// An error that says what is too much and what to use instead.
void check_triangles(const Survey& survey, std::string_view format);

// A point or a normal of an instance's model, in the scene, from the origin.
inline V3 placed(const fill::Instance& instance, const V3d& origin, const V3& of_object) {
  return V3(instance.at - origin + V3d(instance.rotation(of_object) * instance.scale));
}

// Goes over all instances several times and reports how far it is.
class Passes {
 public:
  Passes(const fill::DetailsFile& file, const Survey& survey, const silvasim::base::Progress& progress, int passes)
      : file_(file), total_(static_cast<double>(survey.instances) * passes), progress_(progress) {
    silvasim::base::report(progress_, "export", 0);
  }

  template <typename Visit>
  void run(Visit&& visit) {
    constexpr std::uint64_t often = 8192;
    fill::for_each_instance(*file_.tile, file_.details, [&](const fill::Instance& instance) {
      if (done_++ % often == 0) silvasim::base::report(progress_, "export", static_cast<double>(done_) / total_);
      visit(instance);
    });
  }

 private:
  const fill::DetailsFile& file_;
  double total_;
  const silvasim::base::Progress& progress_;
  std::uint64_t done_ = 0;
};

}  // namespace ghosttile::exports
