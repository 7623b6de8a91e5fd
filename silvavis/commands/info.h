// silvavis info: what would be rendered, and what it takes.
#pragma once

#include "silvavis/commands/stage.h"

namespace silvavis::commands {

struct InfoOptions {
  StageOptions stage;
};

void info(const InfoOptions& options);

}  // namespace silvavis::commands
