#include "silvavis/commands/view_script.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"

namespace silvavis::commands {

namespace {

namespace base = silvasim::base;

constexpr int most_pictures = 1'000'000;
constexpr std::size_t most_script_bytes = 1 << 20;

const std::map<std::string, char>& key_names() {
  static const std::map<std::string, char> names{
      {"Esc", key_escape}, {"Left", key_left}, {"Right", key_right}, {"Up", key_up}, {"Down", key_down}};
  return names;
}

// None: no such key.
std::vector<Press> keys_of(std::string word, bool several) {
  Press press;
  if (word.rfind("shift+", 0) == 0) {
    press.shift = true;
    word = word.substr(6);
  }
  if (const auto found = key_names().find(word); found != key_names().end()) {
    press.key = found->second;
    return {press};
  }
  std::vector<Press> keys;
  for (const char letter : word) {
    if (!std::isalpha(static_cast<unsigned char>(letter)) && letter != '+' && letter != '-') return {};
    press.key = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    keys.push_back(press);
  }
  if (!several && keys.size() != 1) return {};
  return keys;
}

void send(Window& window, const std::vector<Press>& keys, bool down) {
  for (const Press& key : keys) window.send_key(key, down);
}

void begin(Window& window, const ScriptStep& step) {
  using Kind = ScriptStep::Kind;
  if (step.kind == Kind::hold || step.kind == Kind::press) send(window, step.keys, true);
  if (step.kind == Kind::press) send(window, step.keys, false);
  if (step.kind == Kind::drag) window.send_drag(step.x, step.y);
  if (step.kind == Kind::wheel) window.send_wheel(step.x);
  if (step.kind == Kind::resize) window.send_size(static_cast<int>(step.x), static_cast<int>(step.y));
}

}  // namespace

bool ScriptPlayer::step(Window& window, bool finished) {
  for (; at_ < steps_.size(); ++at_, shown_ = 0) {
    const ScriptStep& step = steps_[at_];
    if (step.kind == ScriptStep::Kind::finish) {
      if (finished) continue;
      return true;
    }
    if (shown_ == std::max(1, step.pictures)) {
      if (step.kind == ScriptStep::Kind::hold) send(window, step.keys, false);
      continue;
    }
    if (shown_++ == 0) begin(window, step);
    return true;
  }
  return false;
}

std::vector<ScriptStep> read_script(const std::filesystem::path& file) {
  std::istringstream text(base::read_file(file, most_script_bytes));
  std::vector<ScriptStep> steps;
  std::vector<base::Diagnostic> errors;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word, keys;
    if (!(words >> word)) continue;
    const auto wrong = [&](const std::string& right) {
      base::add(errors, {file.string(), static_cast<int>(number), 0}, "\"" + line + "\" should read like: " + right);
    };
    ScriptStep step;
    const std::size_t before = errors.size();
    const auto count = [&](int& value) { return words >> value && value >= 1 && value <= most_pictures; };
    const auto numbers = [&](auto&... values) { return ((words >> values && std::isfinite(values)) && ...); };
    if (word == "hold") {
      step.kind = ScriptStep::Kind::hold;
      if (words >> keys) step.keys = keys_of(keys, true);
      if (step.keys.empty() || !count(step.pictures)) wrong("hold WE 10");
    } else if (word == "press") {
      step.kind = ScriptStep::Kind::press;
      if (words >> keys) step.keys = keys_of(keys, false);
      if (step.keys.empty()) wrong("press shift+T");
    } else if (word == "drag") {
      step.kind = ScriptStep::Kind::drag;
      if (!numbers(step.x, step.y)) wrong("drag -120 30");
    } else if (word == "wheel") {
      step.kind = ScriptStep::Kind::wheel;
      if (!numbers(step.x)) wrong("wheel 2");
    } else if (word == "resize") {
      step.kind = ScriptStep::Kind::resize;
      if (!numbers(step.x, step.y) || std::min(step.x, step.y) < 1 || std::max(step.x, step.y) > 8192)
        wrong("resize 640 360");
    } else if (word == "wait") {
      step.kind = (words >> std::ws).eof() ? ScriptStep::Kind::finish : ScriptStep::Kind::wait;
      if (step.kind == ScriptStep::Kind::wait && !count(step.pictures)) wrong("wait 5");
    } else {
      base::add(errors, {file.string(), static_cast<int>(number), 0},
                "there is no step \"" + word + "\"" +
                    base::did_you_mean(word, {"hold", "press", "drag", "wheel", "resize", "wait"}) +
                    "; there are hold, press, drag, wheel, resize and wait");
    }
    words.clear();
    if (std::string rest; words >> rest && errors.size() == before) wrong(line.substr(0, line.rfind(rest)));
    steps.push_back(step);
  }
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  return steps;
}

}  // namespace silvavis::commands
