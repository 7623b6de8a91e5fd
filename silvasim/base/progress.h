// One progress callback for every long operation, shared with GDAL and later with Embree.
//
// Threads: may be called from several threads at once; a callback that keeps state guards it.
#pragma once

#include <functional>
#include <string_view>

namespace silvasim::base {

// Called with the stage's name ("evaluate") and the done share in [0,1]. Returns false to cancel.
using Progress = std::function<bool(std::string_view stage, double done)>;

// Reports, and throws Cancelled when the callback says stop or Ctrl-C was pressed. An empty callback reports nothing.
void report(const Progress& progress, std::string_view stage, double done);

// Makes Ctrl-C and SIGTERM set a flag that report() turns into Cancelled; a second signal ends the program at once.
void install_interrupt_handler();
bool interrupted();

}  // namespace silvasim::base
