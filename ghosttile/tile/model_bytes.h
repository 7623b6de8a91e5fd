// Models of details as files hold them. What is read keeps the promises of assets/model.h, or is refused.
#pragma once

#include "assets/model.h"
#include "ghosttile/tile/chunk_list.h"

namespace ghosttile::tile {

void put_vector(ByteWriter& to, const assets::V3& v);
assets::V3 get_vector(ByteReader& from);  // finite

void put_model(ByteWriter& to, const assets::Model& model);
assets::Model get_model(ByteReader& from);

}  // namespace ghosttile::tile
