#include "host/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

constexpr int kBarWidth = 28;
constexpr auto kRedraw = std::chrono::milliseconds(100);
// A log gets a line per tenth, and where a tenth takes long: one soon, then now and then.
constexpr auto kFirstLine = std::chrono::seconds(1), kLaterLine = std::chrono::seconds(10);

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds >= 0)) seconds = 0;
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  const long whole = std::lround(std::min(seconds, 1e9));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(std::string title, bool quiet, std::FILE* out)
    : title_(std::move(title)),
      out_(out),
      quiet_(quiet),
      terminal_(::isatty(::fileno(out)) == 1),
      start_(std::chrono::steady_clock::now()),
      last_draw_(start_ - kRedraw) {}

Progress::~Progress() {
  // An error left the step early: its message must not run on in the line of the bar.
  const std::lock_guard lock(mutex_);
  if (!done_ && !quiet_ && terminal_ && last_draw_ >= start_) std::fputc('\n', out_);
}

void Progress::update(double fraction, const std::string& note) {
  const std::lock_guard lock(mutex_);
  if (done_ || quiet_) return;
  fraction = fraction > 0 ? std::min(fraction, 1.0) : 0;
  const auto now = std::chrono::steady_clock::now();
  if (terminal_) {
    if (now - last_draw_ < kRedraw) return;
    last_draw_ = now;
  } else {
    const int tenth = int(fraction * 10 + 1e-9);
    const bool silent = last_draw_ < start_ ? now - start_ > kFirstLine : now - last_draw_ > kLaterLine;
    if (tenth == 10 || (tenth <= last_tenth_ && !silent)) return;  // 100 % is finish()'s line
    last_tenth_ = tenth;
    last_draw_ = now;
  }
  draw(fraction, note, false);
}

void Progress::finish(const std::string& note) {
  const std::lock_guard lock(mutex_);
  if (done_) return;
  done_ = true;
  if (!quiet_) draw(1, note, true);
}

void Progress::draw(double fraction, const std::string& note, bool last) {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  // Too early an estimate is worse than none.
  const std::string time = last ? duration_text(elapsed)
                           : fraction > 0.01 && elapsed > 0.5
                               ? fmt::format("{} left", duration_text(elapsed / fraction * (1 - fraction)))
                               : "";
  const std::string tail = fmt::format("{:3.0f} %{}{}{}{}", std::floor(100 * fraction), note.empty() ? "" : "  ", note,
                                       time.empty() ? "" : "  ", time);
  if (terminal_) {
    const int full = int(fraction * kBarWidth);
    const std::string bar = std::string(full, '#') + std::string(kBarWidth - full, '.');
    fmt::print(out_, "\r\033[K{} [{}] {}{}", title_, bar, tail, last ? "\n" : "");
  } else {
    fmt::print(out_, "{} {}\n", title_, tail);
  }
  std::fflush(out_);
}

}  // namespace wale
