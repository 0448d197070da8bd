#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wale {

/// Interleaved float image, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< names, e.g. "R","G","B","albedo.R",...,"variance.R"
  std::vector<float> pixels;          ///< width*height*channels.size()
  std::vector<std::pair<std::string, float>> figures{};  ///< numbers of an .exr's header, named "wale:..."
  std::map<std::string, std::string> attributes{};       ///< and texts
  float* at(int x, int y) { return pixels.data() + (size_t(y) * width + x) * channels.size(); }
  const float* at(int x, int y) const { return pixels.data() + (size_t(y) * width + x) * channels.size(); }
};

/// Throws user errors: missing file, not an image; `finite` refuses NaN and infinity, naming the first pixel.
Image read_image(const std::filesystem::path& file, bool finite = false);

/// The same from the bytes of an EXR, HDR, PNG, JPEG, TIFF, BMP or TGA file; `file` is its name for messages.
Image parse_image(std::string_view bytes, const std::filesystem::path& file, bool finite = false);

/// Writes by suffix through a temporary name: .exr all channels as float; .png 8-bit RGB through the view transform.
/// Throws a user error when the folder does not exist or cannot be written, or the suffix is unknown.
void write_image(const Image& image, const std::filesystem::path& file, double exposure = 0,
                 const std::string& view = "neutral");

/// True when write_image could write there; checked before rendering starts.
void require_writable(const std::filesystem::path& file);
/// By its suffix, in letters of any size; otherwise an image is written as PNG, ready for a screen.
bool is_exr(const std::filesystem::path& file);

/// The picture as 8-bit RGB, row after row, sRGB encoded.
std::vector<unsigned char> display_bytes(const Image& image, double exposure, const std::string& view);

/// A text in the header of an .exr or .png that write_image wrote; nothing where the file is neither, or without it.
std::optional<std::string> image_text(const std::filesystem::path& file, const std::string& name);

/// The text that a frame of an animation carries in either.
constexpr const char* kFrameAttribute = "wale:frame";

/// One scene-linear colour to display values in [0,1]: exposure, tone curve, sRGB encoding.
void view_transform(const float linear[3], double exposure, const std::string& view, float display[3]);

}  // namespace wale
