// Every detail that the project makes goes into a Ghost Tile's file and out of it.
#include <gtest/gtest.h>

#include "ghosttile/objects/made/made.h"
#include "ghosttile/objects/make_detail.h"
#include "ghosttile/tile/create.h"
#include "ghosttile/tile/file.h"

namespace ghosttile::tile {
namespace {

TEST(MadeObjects, AllGoThroughTheFile) {
  std::vector<objects::Detail> made;
  CreateOptions options;
  for (const objects::made::MadeForm& form : objects::made::made_forms()) {
    for (const auto season : {objects::made::Season::summer, objects::made::Season::winter}) {
      objects::made::MadeOptions how;
      how.form = form.name;
      how.season = season;
      objects::SphereFitOptions fit;
      fit.spheres = 4;
      fit.outside_share = 1;
      made.push_back(objects::make_detail(form.name, objects::made::make(how), fit, {}));
      options.spreads.push_back({2, 1, 1, {}});
    }
  }
  options.side_m = 1;
  const Bytes bytes = file_bytes(chunks_of(create(std::move(made), options)));
  EXPECT_EQ(file_bytes(chunks_of(tile_from(chunks_from(bytes, "t", tile_type, "Ghost Tile"), "t"))), bytes);
}

}  // namespace
}  // namespace ghosttile::tile
