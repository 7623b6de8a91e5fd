// How long the pictures of a window took, and for what.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace silvavis::commands {

struct PictureTimes {
  double light_s = 0, trace_s = 0, tone_s = 0, show_s = 0;
  std::uint64_t rays = 0;
  int coarseness_px = 1;
  bool anew = false;  // the first after the eye moved, or anything else changed

  double all_s() const { return light_s + trace_s + tone_s + show_s; }
};

// Of those that began anew, which is what a moving eye sees, and of those that refined.
class ViewTimes {
 public:
  void add(const PictureTimes& picture) { all_.push_back(picture); }
  std::size_t pictures() const { return all_.size(); }

  std::string text() const;  // two lines
  std::string json() const;  // an object

 private:
  std::vector<PictureTimes> all_;
};

}  // namespace silvavis::commands
