// What silvasim's commands share: loading a scenario, and talking to its user (terminal.h).
#pragma once

#include "silvasim/commands/commands.h"
#include "silvasim/config/scenario.h"
#include "silvasim/terminal/terminal.h"

namespace silvasim::commands {

using terminal::bytes_text;
using terminal::console_progress;
using terminal::end_progress;
using terminal::grouped;

config::Scenario load(const ScenarioOptions& options);

}  // namespace silvasim::commands
