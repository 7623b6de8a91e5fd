#include "silvasim/terminal/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>

namespace silvasim::terminal {

namespace {

bool on_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) && terminal && std::string(terminal) != "dumb";
}

// A log on a full disk must not end the work that it tells of, so what cannot be said is left unsaid.
template <typename... Parts>
void say(fmt::format_string<Parts...> format, Parts&&... parts) {
  std::fputs(fmt::format(format, std::forward<Parts>(parts)...).c_str(), stderr);
}

struct Bar {
  std::mutex mutex;
  std::string stage;
  double furthest = 0;
  std::chrono::steady_clock::time_point drawn{};
  bool terminal = on_terminal();

  void show(std::string_view now, double done) {
    const std::lock_guard lock(mutex);
    const bool new_stage = now != stage;
    if (new_stage) {
      stage = now;
      furthest = 0;
      if (!terminal) say("{} ...\n", stage);
    }
    if (!terminal) return;
    furthest = std::max(furthest, std::min(done, 1.0));
    const auto time = std::chrono::steady_clock::now();
    if (!new_stage && time - drawn < std::chrono::milliseconds(100)) return;
    drawn = time;
    constexpr int width = 30;
    const int filled = static_cast<int>(furthest * width);
    say("\r\x1b[K{:<11} [{}{}] {:3.0f} %", stage, std::string(static_cast<std::size_t>(filled), '#'),
        std::string(static_cast<std::size_t>(width - filled), '.'), furthest * 100);
    std::fflush(stderr);
  }
};

// The messages of a configuration are complete lines; others are given the program's name.
int fail(int code, const std::string& line) {
  // Not by fmt::print, which throws where the message cannot be written; the exit code tells all the same.
  std::fputs((line + "\n").c_str(), stderr);
  return code;
}

}  // namespace

int run(const std::string& program, const std::string& less, const std::function<int()>& commands) {
  const std::string begin = program + ": error: ";
  try {
    const int code = commands();
    if (code == 0 && (std::fflush(stdout) != 0 || std::ferror(stdout)))
      return fail(1, begin + "cannot write to standard output");
    return code;
  } catch (const base::Cancelled&) {
    return fail(130, begin + "interrupted; nothing was left half-written");
  } catch (const UsageError& error) {
    return fail(2, begin + error.what() + "; see " + program + " --help");
  } catch (const base::ConfigError& error) {
    return fail(2, error.what());
  } catch (const std::bad_alloc&) {
    return fail(1, begin + "out of memory; " + less);
  } catch (const std::exception& error) {
    return fail(1, begin + error.what());
  }
}

void wrong_option(const std::string& message) { throw base::ConfigError({"command line", 0, 0}, message); }

base::Progress console_progress(const Common& common) {
  if (common.quiet) return {};
  return [bar = std::make_shared<Bar>()](std::string_view stage, double done) {
    bar->show(stage, done);
    return true;
  };
}

void end_progress(const Common& common) {
  if (!common.quiet && on_terminal()) say("\r\x1b[K");
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

std::string bytes_text(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} bytes", bytes);
  if (bytes < 1000000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3);
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

}  // namespace silvasim::terminal
