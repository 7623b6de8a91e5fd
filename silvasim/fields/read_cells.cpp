#include "silvasim/fields/read_cells.h"

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/open.h"

namespace silvasim::fields {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr double largest_float = std::numeric_limits<float>::max();
constexpr double largest_code = 1 << 24;

// All that is needed to turn one stored number into a value.
struct Decoder {
  std::vector<double> no_data;  // stored numbers that mean none
  double scale = 1, offset = 0;
  std::vector<float> palette;  // grey of each palette entry; empty: none
  bool codes = false;
  bool oversized_code = false;  // seen

  float operator()(double raw) {
    for (const double missing : no_data) {
      if (raw == missing) return no_value;
    }
    if (!palette.empty()) {
      const auto entry = raw >= 0 && raw < double(palette.size()) ? static_cast<std::size_t>(raw) : palette.size();
      return entry < palette.size() ? palette[entry] : no_value;
    }
    const double value = raw * scale + offset;
    if (!(std::abs(value) < largest_float)) return no_value;  // also NaN
    if (codes && std::abs(value) > largest_code) oversized_code = true;
    return static_cast<float>(value);
  }
};

// The largest number that the samples of an image can hold.
double full_scale(GDALRasterBand& band) {
  const char* const bits_text = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int bits = bits_text ? std::atoi(bits_text) : 0;
  if (bits > 0 && bits < 32) return double((1u << bits) - 1);
  if (band.GetRasterDataType() == GDT_Byte) return 255;
  if (band.GetRasterDataType() == GDT_UInt16) return 65535;
  return 1;  // other types have no natural full scale: kept as they are
}

std::vector<float> greys(const GDALColorTable& table) {
  std::vector<float> result;
  for (int i = 0; i < table.GetColorEntryCount(); ++i) {
    const GDALColorEntry& c = *table.GetColorEntry(i);
    // Brightness as in ITU-R BT.601; a transparent entry is no data.
    result.push_back(c.c4 == 0 ? no_value : static_cast<float>((0.299 * c.c1 + 0.587 * c.c2 + 0.114 * c.c3) / 255));
  }
  return result;
}

// The factor that turns heights of the band's unit into metres; none if they are, or no unit is named.
std::optional<double> metres_of_unit(GDALRasterBand& band) {
  std::string unit = band.GetUnitType() ? band.GetUnitType() : "";
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (unit == "ft" || unit == "foot" || unit == "feet" || unit == "international foot") return 0.3048;
  if (unit == "us-ft" || unit == "us survey foot" || unit == "foot_us" || unit == "us_survey_foot")
    return 1200.0 / 3937.0;
  if (unit == "cm" || unit == "centimetre" || unit == "centimeter") return 0.01;
  if (unit == "dm" || unit == "decimetre" || unit == "decimeter") return 0.1;
  if (unit == "km" || unit == "kilometre" || unit == "kilometer") return 1000;
  return std::nullopt;
}

Decoder decoder_of(GDALRasterBand& band, const config::FieldSettings& field, Decoding decoding, std::string& note) {
  Decoder decoder;
  decoder.codes = field.kind == config::FieldKind::class_code;
  int declared = 0;
  double missing = 0;
  if (band.GetRasterDataType() == GDT_Int64)
    missing = double(band.GetNoDataValueAsInt64(&declared));
  else if (band.GetRasterDataType() == GDT_UInt64)
    missing = double(band.GetNoDataValueAsUInt64(&declared));
  else
    missing = band.GetNoDataValue(&declared);
  if (declared) {
    decoder.no_data.push_back(missing);
    // A float band cannot hold the declared double exactly; compare with what it does hold.
    if (band.GetRasterDataType() == GDT_Float32 && std::abs(missing) <= largest_float) {
      decoder.no_data.push_back(double(static_cast<float>(missing)));
    }
  }
  if (field.no_data_value) decoder.no_data.push_back(*field.no_data_value);
  if (field.terrain) decoder.no_data.insert(decoder.no_data.end(), {-9999, -32767, -32768});

  if (decoding == Decoding::grey) {
    const GDALColorTable* const table = band.GetColorTable();
    if (table && table->GetColorEntryCount() > 0)
      decoder.palette = greys(*table);
    else
      decoder.scale = 1 / full_scale(band);
    return decoder;
  }
  if (decoder.codes) return decoder;

  int has_scale = 0, has_offset = 0;
  const double scale = band.GetScale(&has_scale), offset = band.GetOffset(&has_offset);
  if (has_scale && std::isfinite(scale) && scale != 0) decoder.scale = scale;
  if (has_offset && std::isfinite(offset)) decoder.offset = offset;
  if (field.scaled) {
    decoder.scale *= field.scale;
    decoder.offset = decoder.offset * field.scale + field.offset;
  } else if (const auto metres = metres_of_unit(band); field.terrain && metres) {
    decoder.scale *= *metres;
    decoder.offset *= *metres;
    note = std::string(band.GetUnitType()) + " turned into metres";
  }
  return decoder;
}

// The band that says which cells are visible, if there is one besides the nodata value.
GDALRasterBand* visibility(GDALRasterBand& band) {
  const int flags = band.GetMaskFlags();
  if (flags & (GMF_ALL_VALID | GMF_NODATA)) return nullptr;
  GDALRasterBand* const mask = band.GetMaskBand();
  return mask && mask->GetXSize() == band.GetXSize() && mask->GetYSize() == band.GetYSize() ? mask : nullptr;
}

float mean(const std::vector<float>& cells) {
  double sum = 0;
  int count = 0;
  for (const float value : cells) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count ? static_cast<float>(sum / count) : no_value;
}

float commonest(std::vector<float>& cells) {
  std::erase_if(cells, [](float value) { return std::isnan(value); });
  std::sort(cells.begin(), cells.end());
  float best = no_value;
  std::size_t most = 0;
  for (std::size_t i = 0; i < cells.size();) {
    std::size_t j = i;
    while (j < cells.size() && cells[j] == cells[i]) ++j;
    if (j - i > most) {
      most = j - i;
      best = cells[i];
    }
    i = j;
  }
  return best;
}

}  // namespace

Cells read_cells(GDALDataset& dataset, const config::FieldSettings& field, Decoding decoding, const CellWindow& window,
                 int block) {
  GdalLog log;
  GDALRasterBand& band = *dataset.GetRasterBand(field.band);
  Cells result;
  Decoder decode = decoder_of(band, field, decoding, result.note);
  GDALRasterBand* const mask = visibility(band);
  result.columns = (window.columns + block - 1) / block;
  result.rows = (window.rows + block - 1) / block;
  result.values.reserve(static_cast<std::size_t>(result.columns) * static_cast<std::size_t>(result.rows));

  // Read in strips of whole blocks, about four million cells each.
  const int strip_rows = std::max(1, int(4e6 / window.columns) / block) * block;
  std::vector<double> stored;
  std::vector<std::uint8_t> visible;
  std::vector<float> strip, gathered;
  for (int first = 0; first < window.rows; first += strip_rows) {
    if (base::interrupted()) throw base::Cancelled();
    const int rows = std::min(strip_rows, window.rows - first);
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.columns);
    stored.resize(count);
    strip.resize(count);
    log.clear();
    const auto read = [&](GDALRasterBand& from, void* to, GDALDataType type) {
      return from.RasterIO(GF_Read, window.column, window.row + first, window.columns, rows, to, window.columns, rows,
                           type, 0, 0, nullptr) == CE_None;
    };
    bool good = read(band, stored.data(), GDT_Float64);
    if (good && mask) {
      visible.resize(count);
      good = read(*mask, visible.data(), GDT_Byte);
    }
    if (!good || log.failed()) {
      throw base::Error("data field \"" + field.name + "\": cannot read \"" + field.path.string() +
                        "\": " + log.reason());
    }
    for (std::size_t i = 0; i < count; ++i) strip[i] = mask && visible[i] == 0 ? no_value : decode(stored[i]);
    if (decode.oversized_code) fail_at(field, "a class code is larger than 16777216, the largest that is kept exactly");
    if (block == 1) {
      result.values.insert(result.values.end(), strip.begin(), strip.end());
      continue;
    }
    for (int row = 0; row < rows; row += block) {
      for (int column = 0; column < window.columns; column += block) {
        gathered.clear();
        for (int r = row; r < std::min(row + block, rows); ++r) {
          const float* const line =
              strip.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns);
          gathered.insert(gathered.end(), line + column, line + std::min(column + block, window.columns));
        }
        result.values.push_back(decode.codes ? commonest(gathered) : mean(gathered));
      }
    }
  }
  return result;
}

}  // namespace silvasim::fields
