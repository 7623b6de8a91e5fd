// Embree, from its start to its end. Errors: base::Error where it cannot start.
#pragma once

#include <embree3/rtcore.h>

#include "silvasim/base/error.h"

namespace silvavis::accel {

class EmbreeDevice {
 public:
  EmbreeDevice() : device_(rtcNewDevice(config)) {
    if (!device_) throw silvasim::base::Error("Embree cannot start on this machine");
  }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  ~EmbreeDevice() { rtcReleaseDevice(device_); }

  RTCDevice get() const { return device_; }

 private:
#if defined(__SANITIZE_THREAD__)
  // ThreadSanitizer cannot see how Embree's own threads wait for each other.
  static constexpr const char* config = "threads=1,user_threads=1";
#else
  static constexpr const char* config = nullptr;
#endif
  RTCDevice device_;
};

}  // namespace silvavis::accel
