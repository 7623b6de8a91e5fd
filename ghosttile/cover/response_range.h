// What a Property's response may give for all values of a range: sound bounds, which density fields are cut down by.
//
// Source: every Property but Bezier is monotone between the corners that its element names, so the ends and corners tell; a Bezier
// piece lies within the hull of its control points, and is cut into 64 parts.
#pragma once

#include <vector>

#include "ghosttile/cover/source.h"
#include "silvasim/config/node.h"
#include "silvasim/evaluators/response.h"

namespace ghosttile::cover {

class ResponseRange {
 public:
  // `node`: the checked Property that the response was made of.
  explicit ResponseRange(const silvasim::config::Node& node);

  Range of(const silvasim::evaluators::Response& response, const Range& values) const;

 private:
  struct Part {
    float first_x, last_x;
    Range y;
  };
  std::vector<float> corners_;
  std::vector<Part> parts_;  // of a Bezier
};

}  // namespace ghosttile::cover
