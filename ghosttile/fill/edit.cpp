#include "ghosttile/fill/edit.h"

#include "silvasim/base/error.h"

namespace ghosttile::fill {

void edit(const Plan& plan, DetailsFile& file, const TileBox& touched, const std::string& strokes_xml,
          const silvasim::base::Progress& progress) {
  if (file.edits.size() >= most_edits)
    throw silvasim::base::Error("there are " + std::to_string(most_edits) + " edits already: fill the scene again");
  Details after = refill(plan, file.details, touched, progress);
  file.edits.push_back({strokes_xml, touched, part_of(file.details, touched)});
  file.details = std::move(after);
}

void undo(DetailsFile& file) {
  const Edit last = std::move(file.edits.back());
  file.edits.pop_back();
  file.details = joined(file.details, last.before, last.touched);
}

}  // namespace ghosttile::fill
