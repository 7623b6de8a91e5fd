#include "silvasim/export/geographic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/fields/crs.h"

namespace silvasim::exports {

Geographic::Geographic(const std::string& wkt, const base::Box& box) : box_(box) {
  if (wkt.empty()) return;
  const auto nodes = [](double metres) {
    return 2 * static_cast<int>(std::clamp(std::ceil(metres / 2000), 1.0, 250.0)) + 1;
  };
  columns_ = nodes(box.width());
  rows_ = nodes(box.height());
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      longitude_.push_back(box.west + box.width() * i / (columns_ - 1));
      latitude_.push_back(box.south + box.height() * j / (rows_ - 1));
    }
  }
  fields::Transformation(fields::crs_from_text(wkt), fields::wgs84()).apply(longitude_, latitude_);
  // Beside the date line longitudes jump by a turn; let them run on, at() brings them back.
  for (double& longitude : longitude_) {
    if (longitude - longitude_.front() > 180) longitude -= 360;
    if (longitude - longitude_.front() < -180) longitude += 360;
  }
}

base::Point Geographic::at(base::Point point) const {
  // Lagrange's parabolas through the three nodes of the cell, along and across.
  struct Span {
    int first;
    std::array<double, 3> weight;
  };
  const auto span = [](double share, int nodes) {
    const double at = share * (nodes - 1);
    const int first = 2 * static_cast<int>(std::clamp(std::floor(at / 2), 0.0, (nodes - 3) / 2.0));
    const double t = at - first;
    return Span{first, {(t - 1) * (t - 2) / 2, t * (2 - t), t * (t - 1) / 2}};
  };
  const Span a = span((point.x - box_.west) / box_.width(), columns_);
  const Span b = span((point.y - box_.south) / box_.height(), rows_);
  base::Point result;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t node = (static_cast<std::size_t>(b.first) + j) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(a.first) + i;
      result.x += a.weight[i] * b.weight[j] * longitude_[node];
      result.y += a.weight[i] * b.weight[j] * latitude_[node];
    }
  }
  if (result.x > 180) result.x -= 360;
  if (result.x < -180) result.x += 360;
  return result;
}

std::string crs_name(const std::string& wkt) {
  if (wkt.empty()) return "local metres";
  try {
    return fields::name_of(fields::crs_from_text(wkt));
  } catch (const base::Error&) {
    return "unknown CRS";
  }
}

}  // namespace silvasim::exports
