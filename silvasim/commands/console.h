// What commands share in talking to a person or a program.
#pragma once

#include <string>

#include "silvasim/base/progress.h"
#include "silvasim/commands/commands.h"
#include "silvasim/config/scenario.h"

namespace silvasim::commands {

// Progress on standard error: a bar on a terminal, a line a stage elsewhere, nothing when quiet.
base::Progress console_progress(const Common& common);

// Removes the bar, so that what follows starts on a clean line.
void end_progress(const Common& common);

config::Scenario load(const ScenarioOptions& options);

// "1,234,567"
std::string grouped(std::uint64_t number);
// "12.3 MB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace silvasim::commands
