#include "assets/pictures/picture_file.h"

#include <dlfcn.h>

#include "assets/pictures/module.h"
#include "silvasim/base/error.h"

namespace assets::pictures {

namespace {

const Module& module() {
  static const Module* const loaded = [] {
    // Never unloaded: OpenImageIO keeps threads of its own. A program finds it in its own folder (its RUNPATH).
    void* const library = dlopen(module_file, RTLD_NOW | RTLD_LOCAL);
    void* const table = library ? dlsym(library, module_symbol) : nullptr;
    if (!table)
      throw silvasim::base::Error(
          std::string("the module that reads pictures is missing; it belongs beside the program: ") + dlerror());
    return static_cast<const Module*>(table);
  }();
  return *loaded;
}

}  // namespace

std::unique_ptr<PictureFile> open_bytes(Format format, const std::string& name, std::span<const std::byte> bytes) {
  return module().open_bytes(format, name, bytes);
}

std::unique_ptr<PictureFile> open_cached(Format format, const std::filesystem::path& file) {
  return module().open_cached(format, file);
}

}  // namespace assets::pictures
