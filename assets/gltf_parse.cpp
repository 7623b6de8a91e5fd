#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "assets/beneath.h"
#include "assets/gltf_parts.h"
#include "silvasim/base/error.h"
#include "silvasim/base/file.h"

namespace assets {

namespace {

namespace fs = std::filesystem;

// What the callbacks of tinygltf may reach.
struct Files {
  const Reading* reading;
  std::uint64_t bytes_left;
};

// tinygltf asks for "<folder>/<name>", and then for "./<name>" of the working directory, which is not for it to see.
const std::string folder_mark = "the-model";

Beneath named(const std::string& path, const Files& files) {
  if (path.compare(0, folder_mark.size() + 1, folder_mark + "/") != 0) return {{}, "is missing"};
  return file_beneath(files.reading->file.parent_path(), path.substr(folder_mark.size() + 1));
}

bool is_picture(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array known{".png",  ".jpg",  ".jpeg", ".tga", ".bmp", ".tif",
                             ".tiff", ".webp", ".dds",  ".ktx", ".ktx2"};
  return std::find(known.begin(), known.end(), extension) != known.end();
}

bool file_exists(const std::string& path, void* user) { return !named(path, *static_cast<Files*>(user)).file.empty(); }

std::string same_path(const std::string& path, void*) { return path; }

bool read_buffer(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
  Files& files = *static_cast<Files*>(user);
  const Beneath found = named(path, files);
  if (found.file.empty()) {
    *error = found.refusal;
    return false;
  }
  // Pictures are read later, and only those that are needed.
  if (is_picture(found.file)) {
    out->assign(1, 0);
    return true;
  }
  try {
    const std::string bytes = silvasim::base::read_file(found.file, files.bytes_left);
    files.bytes_left -= bytes.size();
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const silvasim::base::Error& failure) {
    *error = failure.what();
    return false;
  }
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

// Keeps the bytes of data URIs; those of buffer views are fetched when they are needed, after a check.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  if (image->bufferView >= 0 || !image->uri.empty() || size <= 0) return true;
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// The JSON text of the file: its first chunk in a GLB. Lengths that lie are left to tinygltf, which refuses them.
void check_json_of(const Reading& reading, const std::string& bytes, bool binary) {
  if (!binary) return check_json(reading, bytes.data(), bytes.size());
  if (bytes.size() < 20) return;
  std::uint64_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | static_cast<unsigned char>(bytes[12 + static_cast<std::size_t>(i)]);
  check_json(reading, bytes.data() + 20, static_cast<std::size_t>(std::min<std::uint64_t>(length, bytes.size() - 20)));
}

void check_extensions(const Reading& reading, const tinygltf::Model& model) {
  for (const std::string& name : model.extensionsRequired) {
    // Materials only change how light is reflected; the rest is read here.
    const bool known = name.compare(0, 14, "KHR_materials_") == 0 || name == "KHR_texture_transform" ||
                       name == "KHR_mesh_quantization" || name == "KHR_lights_punctual";
    if (!known) {
      reading.fail("it requires the glTF extension \"" + name +
                   "\", which is not known; save the model without compression, with PNG or JPEG textures");
    }
  }
}

}  // namespace

void check_json(const Reading& reading, const char* text, std::size_t size) {
  constexpr int most_depth = 64;
  constexpr std::size_t most_values = 4'000'000;
  int depth = 0;
  std::size_t values = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = text[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
      continue;
    }
    if (c == '"') in_text = true;
    if (c == ',' || c == '[' || c == '{') ++values;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > most_depth) reading.fail("its JSON is nested deeper than " + std::to_string(most_depth) + " levels");
    if (values > most_values) reading.fail("its JSON has more than " + std::to_string(most_values) + " values");
  }
}

tinygltf::Model parse_gltf(Reading& reading) {
  const std::string bytes = silvasim::base::read_file(reading.file, reading.options.most_file_bytes);
  if (bytes.size() > 0x7FFFFFFFu) reading.fail("a glTF file may have 2 GB at most");
  const bool binary = bytes.compare(0, 4, "glTF") == 0;
  check_json_of(reading, bytes, binary);

  Files files{&reading, reading.options.most_file_bytes - bytes.size()};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({file_exists, same_path, read_buffer, write_nothing, &files});
  loader.SetImageLoader(keep_picture, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool read =
      binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                           reinterpret_cast<const unsigned char*>(bytes.data()), size, folder_mark)
             : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder_mark);
  // Compressed files miss what their extension would bring, so the extension is the better message.
  check_extensions(reading, model);
  // An error may be told although the model was made, and it was made half then.
  if (!read || !error.empty()) {
    reading.fail("it is no valid glTF: " + (error.empty() ? "it cannot be read" : first_line(error)));
  }
  if (model.asset.version.compare(0, 1, "2") != 0) {
    reading.fail("it is glTF version \"" + model.asset.version + "\"; it should be 2.0");
  }
  return model;
}

}  // namespace assets
