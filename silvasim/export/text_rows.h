// Plants as lines of text: portions are made in parallel and written in their order.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "silvasim/base/progress.h"
#include "silvasim/export/plant_rows.h"

namespace silvasim::exports {

// `text_of` appends the text of a portion to an empty string; called from several threads, each with its own string.
// Errors: base::Error where the file cannot be written, base::Cancelled; nothing half-written stays.
void write_text_rows(const std::filesystem::path& path, const PlantRows& rows, const std::string& head,
                     const std::function<void(std::size_t portion, std::string& text)>& text_of,
                     const std::string& foot, const base::Progress& progress);

}  // namespace silvasim::exports
