// Cameras by name, from an XML file.
//
//   <cameras>
//     <camera name="valley" fov="55">
//       <eye x="571500" y="5725800" height="30" above="ground"/>
//       <look-at longitude="10.045" latitude="51.688" height="520"/>
//     </camera>
//   </cameras>
//
// Errors: base::ConfigError with file, line and column of every finding; for a name that is not there, with the names.
#pragma once

#include <filesystem>
#include <string>

#include "silvavis/scene/scene.h"
#include "silvavis/shade/camera.h"

namespace silvavis::commands {

// `reference`: "cameras.xml#valley"; the file alone where it holds one camera. In world space; the picture's size is the
// caller's to say.
shade::Camera camera_from(const std::string& reference, const scene::Scene& scene);

// The file's part of a reference.
std::filesystem::path camera_file(const std::string& reference);

}  // namespace silvavis::commands
