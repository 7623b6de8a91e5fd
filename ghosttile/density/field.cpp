#include "ghosttile/density/field.h"

#include <limits>

#include "ghosttile/density/program.h"
#include "ghosttile/density/tree.h"
#include "silvasim/base/error.h"

namespace ghosttile::density {

Field::Field(Node tree) {
  const std::string problem = problem_with(tree);
  if (!problem.empty()) throw silvasim::base::Error(problem);
  cut_ = std::make_shared<const Cut>(worked_out(tree));
}

Box3 Field::bounds() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!cut_) return {V3d(infinity), V3d(-infinity)};
  return bounds_of(*cut_->tree, cut_->items);
}

Range Field::range(const Box3& box) const {
  if (!cut_) return {0, 0};
  std::vector<Item> items;
  items.reserve(cut_->items.size());
  return cut_down(*cut_->tree, cut_->items, box, items);
}

Field Field::within(const Box3& box) const {
  Field field;
  if (!cut_) return field;
  auto cut = std::make_shared<Cut>();
  cut->items.reserve(cut_->items.size());
  const Range range = cut_down(*cut_->tree, cut_->items, box, cut->items);
  if (!(range.most > 0)) return field;
  cut->tree = cut_->tree;
  field.cut_ = std::move(cut);
  return field;
}

Compiled Field::compiled(const V3d& corner, const Box3& box) const {
  Compiled compiled;
  if (!cut_) return compiled;
  std::vector<Item> items;
  items.reserve(cut_->items.size());
  compiled.range = cut_down(*cut_->tree, cut_->items, box, items);
  if (!compiled.constant()) compiled.program_ = program_of(cut_->tree, items, corner);
  return compiled;
}

}  // namespace ghosttile::density
