#pragma once
#include <filesystem>
#include <functional>
#include <vector>

namespace wale {

/// Throws a user error where ffmpeg, which makes videos, is not installed, or `file` cannot be written.
void require_video(const std::filesystem::path& file);

/// A picture of 8-bit RGB, row after row.
struct VideoFrame {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

/// Joins pictures to a video by ffmpeg, a program of its own: next(k) is frame k of `count`. H.264 or what the suffix
/// says; a side of odd length gets one more row or column, as that needs. Appears whole or not at all. Throws a user
/// error with ffmpeg's last line where it fails, or where pictures differ in size.
void write_video(const std::filesystem::path& file, double fps, size_t count,
                 const std::function<VideoFrame(size_t)>& next);

}  // namespace wale
