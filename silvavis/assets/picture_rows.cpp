#include "silvavis/assets/picture_rows.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <fstream>
#include <map>
#include <mutex>
#include <string>

#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace silvavis::assets {

namespace {

namespace base = silvasim::base;

OIIO::ImageCache& cache() {
  static OIIO::ImageCache* const shared = [] {
    OIIO::ImageCache* c = OIIO::ImageCache::create(false);
    c->attribute("max_memory_MB", 32.0f);
    c->attribute("max_open_files", 16);
    c->attribute("autotile", 64);     // read pictures without tiles by strips of 64 rows,
    c->attribute("autoscanline", 1);  // as wide as the picture
    c->attribute("unassociatedalpha", 1);
    return c;
  }();
  return *shared;
}

template <int N>
OIIO::ImageInput* reader_of() {
  constexpr std::array names{"png", "jpeg", "bmp", "tiff", "targa"};
  return OIIO::ImageInput::create(names[N], false, nullptr, nullptr, "").release();
}

// Names the plugin by the first bytes, so that no other one gets to see the file. Targa has no magic bytes.
OIIO::ImageInput::Creator reader_for(const std::string& head, const std::string& name) {
  const auto begins = [&](std::string_view magic) { return head.compare(0, magic.size(), magic) == 0; };
  using namespace std::string_view_literals;
  if (begins("\x89PNG\r\n\x1A\n"sv)) return reader_of<0>;
  if (begins("\xFF\xD8\xFF"sv)) return reader_of<1>;
  if (begins("BM"sv)) return reader_of<2>;
  if (begins("II*\0"sv) || begins("MM\0*"sv)) return reader_of<3>;
  std::string end = name.size() > 4 ? name.substr(name.size() - 4) : "";
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".tga" ? reader_of<4> : nullptr;
}

std::string first_bytes(const Picture& picture) {
  std::string head(8, '\0');
  if (picture.file.empty()) {
    const std::size_t count = std::min(head.size(), picture.bytes.size());
    std::transform(picture.bytes.begin(), picture.bytes.begin() + static_cast<std::ptrdiff_t>(count), head.begin(),
                   [](std::byte b) { return static_cast<char>(b); });
  } else {
    std::ifstream(picture.file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  }
  return head;
}

// The cache itself tells files apart by whole seconds.
void forget_if_changed(const std::filesystem::path& file) {
  static std::mutex mutex;
  static std::map<std::string, std::filesystem::file_time_type> known;
  std::error_code ignored;
  const std::filesystem::file_time_type time = std::filesystem::last_write_time(file, ignored);
  const std::lock_guard lock(mutex);
  const auto [it, is_new] = known.try_emplace(file.string(), time);
  if (is_new || it->second == time) return;
  it->second = time;
  cache().invalidate(OIIO::ustring(file.string()), true);
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw base::Error("texture \"" + base::shortened(name, 120) + "\" " + what);
}

}  // namespace

struct PictureRows::Source {
  std::string name;   // for messages
  OIIO::ustring key;  // in the cache
  bool embedded = false;
  OIIO::Filesystem::IOMemReader memory;
  OIIO::ImageSpec spec;

  Source(const std::string& shown, const std::vector<std::byte>& bytes)
      : name(shown), memory(const_cast<std::byte*>(bytes.data()), bytes.size()) {}
};

PictureRows::PictureRows(const Picture& picture) {
  if (picture.file.empty() && picture.bytes.empty()) return;
  source_ = std::make_unique<Source>(picture.name, picture.bytes);
  const OIIO::ImageInput::Creator reader = reader_for(first_bytes(picture), picture.name);
  if (reader == nullptr) fail(picture.name, "is no picture; it should be PNG, JPEG, Targa, BMP or TIFF");

  OIIO::ImageSpec config;
  if (picture.file.empty()) {
    static std::atomic<std::uint64_t> number{0};
    source_->embedded = true;
    source_->key = OIIO::ustring("silva-embedded-" + std::to_string(number++));
    OIIO::Filesystem::IOProxy* proxy = &source_->memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  } else {
    source_->key = OIIO::ustring(picture.file.string());
    forget_if_changed(picture.file);
  }
  if (!cache().add_file(source_->key, reader, &config) || !cache().get_imagespec(source_->key, source_->spec)) {
    const std::string why = cache().geterror();
    if (source_->embedded) cache().invalidate(source_->key, true);
    fail(picture.name, "cannot be read: " + base::shortened(why.substr(0, why.find('\n')), 120));
  }
  const OIIO::ImageSpec& spec = source_->spec;
  const long long pixels = static_cast<long long>(spec.width) * spec.height;
  const bool fits = spec.width > 0 && spec.height > 0 && spec.depth <= 1 && spec.nchannels > 0 &&
                    spec.width <= most_picture_side_px && spec.height <= most_picture_side_px &&
                    pixels <= most_picture_px;
  // No packing makes more of a byte; a file that claims more is cut off, or made to waste time.
  constexpr long long most_pixels_a_byte = 8192;
  std::error_code ignored;
  const auto bytes = static_cast<long long>(picture.file.empty() ? picture.bytes.size()
                                                                 : std::filesystem::file_size(picture.file, ignored));
  if (!fits || pixels > most_pixels_a_byte * bytes) {
    if (source_->embedded) cache().invalidate(source_->key, true);
    fail(picture.name, "claims " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                           " pixels, which " +
                           (fits ? "its " + std::to_string(bytes) + " bytes cannot hold"
                                 : "is too large; at most " + std::to_string(most_picture_side_px) + " a side and " +
                                       std::to_string(most_picture_px >> 20) + " million in all are read"));
  }
  width_ = spec.width;
  height_ = spec.height;
  has_alpha_ = spec.nchannels == 2 || (spec.nchannels >= 4 && spec.alpha_channel >= 0);
}

PictureRows::~PictureRows() {
  if (source_ && source_->embedded) cache().invalidate(source_->key, true);
}

void PictureRows::read(int first, int end, std::vector<std::uint8_t>& rgba) {
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(end - first);
  rgba.assign(pixels * 4, 255);
  if (!source_) return;
  const OIIO::ImageSpec& spec = source_->spec;
  const int channels = std::min(spec.nchannels, 4);
  std::vector<std::uint8_t> raw(pixels * static_cast<std::size_t>(channels));
  const bool read = cache().get_pixels(source_->key, 0, 0, spec.x, spec.x + width_, spec.y + first, spec.y + end,
                                       spec.z, spec.z + 1, 0, channels, OIIO::TypeDesc::UINT8, raw.data());
  if (!read) {
    const std::string why = cache().geterror();
    fail(source_->name, "is damaged: " + base::shortened(why.substr(0, why.find('\n')), 120));
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* in = raw.data() + i * static_cast<std::size_t>(channels);
    std::uint8_t* out = rgba.data() + i * 4;
    const bool grey = channels < 3;
    for (int c = 0; c < 3; ++c) out[c] = in[grey ? 0 : c];
    if (has_alpha_) out[3] = in[grey ? 1 : 3];
  }
}

}  // namespace silvavis::assets
