// Images as files: what is checked before and after the coder.
#include <algorithm>
#include <cmath>

#include "geom/byte_source.h"
#include "geom/error.h"
#include "geom/text_lines.h"
#include "host/atomic_file.h"
#include "host/display_picture.h"
#include "host/exr_header.h"
#include "host/image.h"
#include "host/image_coder.h"
#include "host/png_chunks.h"
#include "host/schema.h"
#include "host/stored_image.h"

namespace wale {
namespace {

constexpr uint64_t kMaxValues = uint64_t(1) << 32;
// No file packs more numbers into a byte: deflate gives 1032 bytes for one. Else it is a damaged header, which must not
// make the program reserve gigabytes.
constexpr uint64_t kValuesPerByte = 2048, kBaseValues = 1 << 16;

std::string suffix_of(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

// Throws a user error that begins with `what` when a coder gave a reason.
void require_coded(const std::string& failure, const std::string& what) {
  if (!failure.empty()) user_error("{}: {}", what, one_line(failure));
}

// OpenImageIO's name of the format, from the first bytes. Left to itself the library tries every reader it has on a
// file that none of them knows; these few are tested with damaged files.
std::string format_of(std::string_view bytes, const std::filesystem::path& file) {
  constexpr std::pair<std::string_view, const char*> kFirstBytes[] = {
      {"v/1\x01", "openexr"}, {"\x89PNG", "png"},     {"\xff\xd8\xff", "jpeg"},
      {"#?", "hdr"},          {{"II*\0", 4}, "tiff"}, {{"MM\0*", 4}, "tiff"},
      {"BM", "bmp"},          {"P1", "pnm"},          {"P2", "pnm"},
      {"P3", "pnm"},          {"P4", "pnm"},          {"P5", "pnm"},
      {"P6", "pnm"},          {"PF", "pnm"},          {"Pf", "pnm"}};
  for (const auto& [first, format] : kFirstBytes)
    if (bytes.starts_with(first)) return format;
  if (suffix_of(file) == ".tga") return "targa";  // has no first bytes of its own
  user_error("{}: cannot be read as an image; formats are EXR, HDR, PNG, JPEG, TIFF, BMP, TGA, PNM", file.string());
}

void check_finite(const Image& image, const std::string& file) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < image.channels.size(); ++c)
        if (!std::isfinite(image.at(x, y)[c]))
          user_error("{}: pixel ({}, {}), channel {}: {} is not a finite number", file, x, y, image.channels[c],
                     image.at(x, y)[c]);
}

void write_png(const Image& image, const std::filesystem::path& file, double exposure, const std::string& view) {
  std::string png = display_png(image, exposure, view);
  if (const auto frame = image.attributes.find(kFrameAttribute); frame != image.attributes.end())
    add_png_text(png, frame->first, frame->second);
  write_text_file(file, png);
}

void write_exr(const Image& image, const std::filesystem::path& file) {
  AtomicFile out(file);
  require_coded(image_coder().write_exr(image, out.temporary().string()), file.string() + ": cannot be written");
  out.commit();
}

std::string read_image_bytes(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) user_error("{}: no such image file", file.string());
  return read_bytes(file);
}

}  // namespace

Image read_image(const std::filesystem::path& file, bool finite) {
  return parse_image(read_image_bytes(file), file, finite);
}

Image parse_image(std::string_view bytes, const std::filesystem::path& path, bool finite) {
  StoredImage stored = parse_stored_image(bytes, path);
  if (stored.srgb) decode_srgb(stored);
  if (finite) check_finite(stored.image, path.string());
  return std::move(stored.image);
}

StoredImage read_stored_image(const std::filesystem::path& file) {
  return parse_stored_image(read_image_bytes(file), file);
}

StoredImage parse_stored_image(std::string_view bytes, const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string format = format_of(bytes, path);
  if (format == "openexr") require_plausible_exr(bytes, file);
  if (format == "png") require_whole_png_chunks(bytes, file);
  StoredImage stored;
  const auto accept = [&](const ImageHeader& header) {
    const size_t channels = header.channels.size();
    const uint64_t values = uint64_t(std::max(0, header.width)) * std::max(0, header.height) * channels;
    if (values == 0 || values > kMaxValues || header.deep)
      user_error("{}: {} x {} with {} channels{} cannot be used", file, header.width, header.height, channels,
                 header.deep ? " (deep)" : "");
    if (values > kBaseValues + kValuesPerByte * bytes.size())
      user_error("{}: {} x {} pixels do not fit into its {} bytes; is the file cut off?", file, header.width,
                 header.height, bytes.size());
    stored.alpha = header.alpha;
    stored.srgb = header.srgb;
    stored.integer_bits = header.integer_bits;
  };
  require_coded(image_coder().decode(bytes, format, file, accept, stored.image), file + ": cannot be read as an image");
  return stored;
}

void decode_srgb(StoredImage& stored) {
  std::vector<float>& pixels = stored.image.pixels;
  const size_t channels = stored.image.channels.size();
  for (size_t c = 0; c < channels; ++c) {
    if (int(c) == stored.alpha) continue;
    for (size_t i = c; i < pixels.size(); i += channels) pixels[i] = static_cast<float>(srgb_to_linear(pixels[i]));
  }
}

void write_image(const Image& image, const std::filesystem::path& file, double exposure, const std::string& view) {
  require_writable(file);
  const size_t values = size_t(std::max(0, image.width)) * std::max(0, image.height) * image.channels.size();
  if (values == 0 || image.pixels.size() != values)
    bug("write_image: {} values for {} x {} pixels of {} channels", image.pixels.size(), image.width, image.height,
        image.channels.size());
  if (is_exr(file))
    write_exr(image, file);
  else
    write_png(image, file, exposure, view);
}

std::optional<std::string> image_text(const std::filesystem::path& file, const std::string& name) {
  constexpr uint64_t kHead = 1 << 16;  // of ours, far less
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return {};
  const ByteSource source = ByteSource::of_file(file);
  std::string head(std::min(source.size(), kHead), '\0');
  source.read(0, head.data(), head.size());
  return suffix_of(file) == ".png" ? png_text(head, name) : exr_text(head, name);
}

bool is_exr(const std::filesystem::path& file) { return suffix_of(file) == ".exr"; }

void require_writable(const std::filesystem::path& file) {
  const std::string suffix = suffix_of(file);
  if (!file.has_filename())
    user_error("{}: this names a folder; give the name of a picture, .exr or .png", file.string());
  if (suffix != ".exr" && suffix != ".png")
    user_error("{}: images are written as .exr or .png, not \"{}\"", file.string(), suffix);
  require_image_coder();
  require_writable_path(file);
}

}  // namespace wale
