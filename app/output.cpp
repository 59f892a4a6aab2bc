#include "app/output.h"

#include <cctype>
#include <cstdio>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "quality/results.h"
#include "scene/error.h"

namespace airlight::app {

using scene::Error;
using scene::ExitCode;

void require_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Error(ExitCode::bad_file, folder.string(),
                fmt::format("the folder cannot be made: {}", error.message()), "choose another one with -o");
  }
  const std::filesystem::path probe = folder / fmt::format(".airlight-{}", getpid());
  require_writable(probe);
}

void require_writable(const std::filesystem::path& file) {
  std::error_code error;
  const bool existed = std::filesystem::exists(file, error);
  if (!std::ofstream(file, std::ios::app)) {
    throw Error(ExitCode::bad_file, file.string(), "it cannot be written", "is its folder there, and yours?");
  }
  if (!existed) std::filesystem::remove(file, error);
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw Error(ExitCode::bad_file, "standard output", "it cannot be written");
  }
}

void say(std::string_view line) {
  std::string text(line);
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  }
  fmt::print(stderr, "{}\n", text);
}

void say_page(const std::filesystem::path& file) {
  say(fmt::format("{} written; to open it: xdg-open {}", file.string(), quality::shell_quote(file.string())));
}

void say_warnings(const scene::ImportReport& report) {
  if (report.degenerate_triangles > 0) {
    say(fmt::format("airlight: warning: triangles of zero area dropped: {}", report.degenerate_triangles));
  }
  for (const std::string& warning : report.warnings) say("airlight: warning: " + warning);
}

std::unique_ptr<quality::Tev> open_tev(const std::string& address) {
  return address.empty() ? nullptr : std::make_unique<quality::Tev>(address);
}

void say_of_tev(const quality::Tev* tev) {
  if (tev && !tev->is_there())
    say("airlight: warning: --tev: tev was closed, and does not show all that was rendered");
}

ProgressLine::ProgressLine(bool quiet) : is_shown_(!quiet && isatty(STDERR_FILENO)) {}

ProgressLine::~ProgressLine() {
  if (is_shown_) fmt::print(stderr, "\r\x1b[K");
}

quality::Progress ProgressLine::follower() {
  if (!is_shown_) return {};
  return [this](const std::string& what, double fraction) {
    constexpr int k_width = 30;  // characters
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(100) && fraction < 1.0) return;
    last_ = now;
    const int filled = static_cast<int>(fraction * k_width);
    fmt::print(stderr, "\r\x1b[K{:#<{}}{:.<{}} {:3.0f} % {}", "", filled, "", k_width - filled,
               100.0 * fraction, what);
    std::fflush(stderr);
  };
}

}  // namespace airlight::app
