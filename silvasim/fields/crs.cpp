#include "silvasim/fields/crs.h"

#include <cpl_conv.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/words.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/gdal_log.h"

namespace silvasim::fields {

namespace {

Crs prepared(OGRSpatialReference reference) {
  reference.StripVertical();
  if (reference.GetAxesCount() > 2) reference.DemoteTo2D(nullptr);
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return std::make_shared<const OGRSpatialReference>(std::move(reference));
}

// PROJ strings and WKT can name files with parameters, which PROJ opens as soon as GDAL reads the text: "+init=/a/file:1",
// "+nadgrids=/a/file", PARAMETERFILE["...", "/a/file"]. Names without a folder are PROJ's own and harmless. Both languages
// allow blanks, brackets and quotation marks of several kinds, hence no look at where exactly a slash stands.
bool names_a_file(const std::string& text) {
  std::string words;  // in lower case, without blanks about equals signs
  for (const char c : text) {
    const auto is_blank = [](char each) { return std::strchr(" \t\n\v\f\r", each) != nullptr; };
    while (c == '=' && !words.empty() && is_blank(words.back())) words.pop_back();
    const bool drop = is_blank(c) && !words.empty() && words.back() == '=';
    if (!drop) words += c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  }
  const std::size_t slash = words.find_last_of("/\\");
  if (slash == std::string::npos) return false;
  for (const char* const key : {"init=", "grids=", "file=", "model=", "parameterfile", "proj4_grids", "proj-based"}) {
    if (words.find(key) < slash) return true;
  }
  return false;
}

}  // namespace

Crs crs_from_text(const std::string& text) {
  prepare_gdal();
  constexpr std::size_t longest = 64 << 10;
  if (text.size() > longest) throw base::Error("the text of the CRS is longer than 64 kB");
  const std::string shown = base::shortened(text, 80);
  const auto refuse_files = [&](const std::string& written) {
    if (names_a_file(written)) throw base::Error("\"" + shown + "\" names a file; a CRS may not");
  };
  refuse_files(text);
  if (const std::size_t first = text.find_first_not_of(" \t\r\n"); first != std::string::npos && text[first] == '{') {
    throw base::Error("a CRS in PROJJSON is not read; write it like \"EPSG:32610\", or as WKT");
  }
  static const char* const limits[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  GdalLog log;
  OGRSpatialReference reference;
  if (reference.SetFromUserInput(text.c_str(), limits) != OGRERR_NONE) {
    throw base::Error("\"" + shown + "\" is no known CRS; write it like \"EPSG:32610\", or as WKT");
  }
  if (reference.IsGeocentric()) throw base::Error("\"" + shown + "\" is geocentric; a projected CRS is needed");
  Crs crs = prepared(std::move(reference));
  refuse_files(wkt_of(crs));
  return crs;
}

Crs crs_from_gdal(const OGRSpatialReference* reference) {
  const GdalLog quiet;
  if (!reference || reference->IsEmpty() || reference->IsLocal()) return nullptr;
  if (!reference->IsProjected() && !reference->IsGeographic()) return nullptr;
  Crs crs = prepared(*reference);
  return names_a_file(wkt_of(crs)) ? nullptr : crs;
}

Crs wgs84() {
  prepare_gdal();
  OGRSpatialReference reference;
  reference.SetWellKnownGeogCS("WGS84");
  return prepared(std::move(reference));
}

std::string wkt_of(const Crs& crs) {
  if (!crs) return {};
  static const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  GdalLog log;
  char* text = nullptr;
  const bool good = crs->exportToWkt(&text, options) == OGRERR_NONE;
  const std::string wkt = text ? text : "";
  CPLFree(text);
  if (!good || wkt.empty()) throw base::Error("a CRS cannot be written as WKT: " + log.reason());
  return wkt;
}

std::string name_of(const Crs& crs) {
  if (!crs) return "local metres";
  const GdalLog quiet;
  const char* const name = crs->GetName();
  const char* const authority = crs->GetAuthorityName(nullptr);
  const char* const code = crs->GetAuthorityCode(nullptr);
  std::string text = name && *name ? name : "CRS without a name";
  if (authority && code) text += std::string(" (") + authority + ":" + code + ")";
  return text;
}

bool is_geographic(const Crs& crs) {
  const GdalLog quiet;
  return crs && crs->IsGeographic();
}

bool is_in_metres(const Crs& crs) {
  if (!crs) return true;
  const GdalLog quiet;
  return crs->IsProjected() && std::abs(crs->GetLinearUnits() - 1) < 1e-9;
}

bool same(const Crs& a, const Crs& b) {
  if (!a || !b) return !a && !b;
  const GdalLog quiet;
  static const char* const options[] = {"CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
                                        "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "IGNORE_COORDINATE_EPOCH=YES",
                                        nullptr};
  return a == b || a->IsSame(b.get(), options);
}

void Transformation::Destroy::operator()(OGRCoordinateTransformation* way) const {
  OGRCoordinateTransformation::DestroyCT(way);
}

Transformation::Transformation(const Crs& from, const Crs& to) {
  if (same(from, to)) return;
  if (!from || !to) throw base::Error("there is no way between " + name_of(from) + " and " + name_of(to));
  GdalLog log;
  way_.reset(OGRCreateCoordinateTransformation(from.get(), to.get()));
  if (!way_) throw base::Error("there is no way from " + name_of(from) + " to " + name_of(to) + ": " + log.reason());
}

Transformation::Transformation(Transformation&&) noexcept = default;
Transformation& Transformation::operator=(Transformation&&) noexcept = default;
Transformation::~Transformation() = default;

void Transformation::apply(std::span<double> x, std::span<double> y) const {
  if (!way_ || x.empty()) return;
  GdalLog log;
  std::vector<int> good(x.size());
  way_->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, good.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (good[i] && std::isfinite(x[i]) && std::isfinite(y[i])) continue;
    x[i] = y[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<base::Point> Transformation::apply(base::Point point) const {
  apply({&point.x, 1}, {&point.y, 1});
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) return std::nullopt;
  return point;
}

base::Box bounds(const Transformation& way, const base::Box& box) {
  constexpr int steps = 32;
  std::vector<double> x, y;
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      // Written so that the first and last are the edges exactly.
      x.push_back((box.west * (steps - i) + box.east * i) / steps);
      y.push_back((box.south * (steps - j) + box.north * j) / steps);
    }
  }
  if (!way.gdal()) return box;
  way.apply(x, y);
  base::Box image;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i])) continue;
    image.west = std::min(image.west, x[i]);
    image.east = std::max(image.east, x[i]);
    image.south = std::min(image.south, y[i]);
    image.north = std::max(image.north, y[i]);
  }
  return image;
}

std::string extent_text(const Crs& crs, const base::Box& box) {
  std::string text =
      fmt::format("west {:.10g}, south {:.10g}, east {:.10g}, north {:.10g}", box.west, box.south, box.east, box.north);
  if (!crs) return text;
  try {
    const base::Box degrees = bounds(Transformation(crs, wgs84()), box);
    if (!degrees.empty()) {
      text += fmt::format(" (longitude {:.5f} to {:.5f}, latitude {:.5f} to {:.5f})", degrees.west, degrees.east,
                          degrees.south, degrees.north);
    }
  } catch (const base::Error&) {
    // The metres alone must do.
  }
  return text;
}

}  // namespace silvasim::fields
