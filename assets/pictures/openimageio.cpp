// The module: the only file of SilvaVis that includes OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <vector>

#include "assets/pictures/module.h"
#include "silvasim/base/error.h"

namespace assets::pictures {

namespace {

using silvasim::base::Error;

constexpr std::array plugins{"openexr", "png", "jpeg", "tiff", "bmp", "targa"};

const char* plugin_of(Format format) { return plugins[static_cast<std::size_t>(format)]; }

Sample sample_of(OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return Sample::u8;
  if (type == OIIO::TypeDesc::UINT16) return Sample::u16;
  if (type == OIIO::TypeDesc::UINT32) return Sample::u32;
  if (type == OIIO::TypeDesc::HALF) return Sample::half;
  if (type == OIIO::TypeDesc::FLOAT) return Sample::f32;
  return Sample::other;
}

OIIO::TypeDesc type_of(Sample sample) {
  constexpr std::array types{OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::UINT32,
                             OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT};
  return types.at(static_cast<std::size_t>(sample));
}

Shape shape_of(const OIIO::ImageSpec& spec) {
  Shape shape;
  shape.width = spec.width;
  shape.height = spec.height;
  shape.depth = spec.depth;
  for (int c = 0; c < spec.nchannels; ++c)
    shape.channels.push_back({spec.channel_name(c), sample_of(spec.channelformat(c))});
  shape.alpha = spec.alpha_channel >= 0;
  shape.deep = spec.deep;
  shape.pixel_bytes = spec.pixel_bytes(true);
  return shape;
}

// Whatever the libraries throw becomes a reason.
template <class Act>
void guarded(const Act& act) {
  try {
    act();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(error.what());
  }
}

class InMemory : public PictureFile {
 public:
  InMemory(Format format, const std::string& name, std::span<const std::byte> bytes)
      : memory_(const_cast<std::byte*>(bytes.data()), bytes.size()) {
    guarded([&] {
      input_ = OIIO::ImageInput::create(plugin_of(format), false, nullptr, &memory_);
      OIIO::ImageSpec wish;
      wish.attribute("oiio:UnassociatedAlpha", 1);
      OIIO::ImageSpec spec;
      input_->set_ioproxy(&memory_);
      if (!input_->open(name, spec, wish)) fail();
      shape_ = shape_of(spec);
      first_row_ = spec.y;
      tiled_ = spec.tile_width > 0;
    });
  }

  void read(int first_row, int end_row, int first_channel, int end_channel, Sample sample, void* to) override {
    const OIIO::TypeDesc type = type_of(sample);
    guarded([&] {
      if (!tiled_) {
        if (!input_->read_scanlines(0, 0, first_row_ + first_row, first_row_ + end_row, 0, first_channel, end_channel,
                                    type, to))
          fail();
        return;
      }
      const std::size_t row_bytes =
          static_cast<std::size_t>(shape_.width) * static_cast<std::size_t>(end_channel - first_channel) * type.size();
      std::vector<std::byte> whole(row_bytes * static_cast<std::size_t>(shape_.height));
      if (!input_->read_image(0, 0, first_channel, end_channel, type, whole.data())) fail();
      std::memcpy(to, whole.data() + static_cast<std::size_t>(first_row) * row_bytes,
                  static_cast<std::size_t>(end_row - first_row) * row_bytes);
    });
  }

 private:
  [[noreturn]] void fail() const {
    const std::string text = input_->geterror();
    throw Error(text.empty() ? "it is broken, or of another format" : text);
  }

  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  int first_row_ = 0;
  bool tiled_ = false;
};

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

template <std::size_t N>
OIIO::ImageInput* reader_of() {
  return OIIO::ImageInput::create(plugins[N], false, nullptr, nullptr, "").release();
}
constexpr std::array<OIIO::ImageInput::Creator, plugins.size()> readers{reader_of<0>, reader_of<1>, reader_of<2>,
                                                                        reader_of<3>, reader_of<4>, reader_of<5>};

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

class Cached : public PictureFile {
 public:
  Cached(Format format, const std::filesystem::path& file) : key_(file.string()) {
    guarded([&] {
      forget_if_changed(file);
      if (!cache().add_file(key_, readers[static_cast<std::size_t>(format)]) || !cache().get_imagespec(key_, spec_))
        throw Error(cache().geterror());
      shape_ = shape_of(spec_);
    });
  }

  void read(int first_row, int end_row, int first_channel, int end_channel, Sample sample, void* to) override {
    guarded([&] {
      if (!cache().get_pixels(key_, 0, 0, spec_.x, spec_.x + spec_.width, spec_.y + first_row, spec_.y + end_row,
                              spec_.z, spec_.z + 1, first_channel, end_channel, type_of(sample), to))
        throw Error(cache().geterror());
    });
  }

 private:
  OIIO::ustring key_;
  OIIO::ImageSpec spec_;
};

}  // namespace

extern "C" const Module assets_pictures;
const Module assets_pictures{
    [](Format format, const std::string& name, std::span<const std::byte> bytes) -> std::unique_ptr<PictureFile> {
      return std::make_unique<InMemory>(format, name, bytes);
    },
    [](Format format, const std::filesystem::path& file) -> std::unique_ptr<PictureFile> {
      return std::make_unique<Cached>(format, file);
    }};

}  // namespace assets::pictures
