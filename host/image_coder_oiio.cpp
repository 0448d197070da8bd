// The only file that knows OpenImageIO; a library of its own, see host/image_coder.h.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <utility>

#include "host/image_coder.h"

namespace wale {
namespace {

const std::string kOurs = "wale:";  // what the attributes that are ours begin with

template <typename File>
std::string reason(const File& file) {
  const std::string text = file ? file->geterror() : OIIO::geterror();
  return text.empty() ? "unknown reason" : text;
}

std::string decode(std::string_view bytes, const std::string& format, const std::string& file,
                   const std::function<void(const ImageHeader&)>& accept, Image& image) {
  const auto input = OIIO::ImageInput::create(format);
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());
  OIIO::ImageSpec spec, how;
  how.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are stored: alpha must not darken them
  if (!input || !input->set_ioproxy(&memory) || !input->open(file, spec, how)) return reason(input);
  const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
  std::vector<std::string> channels = spec.channelnames;
  channels.resize(size_t(std::max(0, spec.nchannels)));
  const bool integers = !spec.format.is_floating_point();
  accept({spec.width, spec.height, channels, spec.alpha_channel, spec.deep,
          integers && !OIIO::Strutil::iequals(space, "linear"), integers ? int(spec.format.size()) * 8 : 0});
  image = {spec.width, spec.height, std::move(channels), {}, {}, {}};
  for (const auto& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    if (name.size() <= kOurs.size() || !name.starts_with(kOurs)) continue;
    if (attribute.type() == OIIO::TypeString)
      image.attributes[name] = attribute.get_string();
    else
      image.figures.emplace_back(name, attribute.get_float());
  }
  image.pixels.resize(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data())) return reason(input);
  return {};
}

// In memory.
std::string encode(const char* format, const OIIO::ImageSpec& spec, const std::vector<unsigned char>& rgb,
                   std::string& file) {
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(format);
  if (!output || !output->set_ioproxy(&memory) || !output->open(std::string("memory.") + format, spec) ||
      !output->write_image(spec.format, rgb.data()) || !output->close())
    return reason(output);
  file.assign(memory.buffer().begin(), memory.buffer().end());
  return {};
}

OIIO::ImageSpec display_spec(int width, int height) {
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return spec;
}

std::string encode_png(const std::vector<unsigned char>& rgb, int width, int height, std::string& png) {
  return encode("png", display_spec(width, height), rgb, png);
}

std::string encode_jpeg(const std::vector<unsigned char>& rgb, int width, int height, int quality, std::string& jpeg) {
  OIIO::ImageSpec spec = display_spec(width, height);
  spec.attribute("Compression", "jpeg:" + std::to_string(quality));
  spec.attribute("jpeg:subsampling", "4:4:4");
  return encode("jpeg", spec, rgb, jpeg);
}

std::string write_exr(const Image& image, const std::string& file) {
  OIIO::ImageSpec spec(image.width, image.height, int(image.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.channels;
  spec.attribute("compression", "zip");
  for (const auto& [name, value] : image.figures) spec.attribute(name, value);
  for (const auto& [name, value] : image.attributes) spec.attribute(name, value);
  const auto output = OIIO::ImageOutput::create(file);
  if (!output || !output->open(file, spec) || !output->write_image(spec.format, image.pixels.data()) ||
      !output->close())
    return reason(output);
  return {};
}

constexpr ImageCoder kCoder{decode, encode_png, encode_jpeg, write_exr};

}  // namespace
}  // namespace wale

extern "C" const void* wale_image_coder() { return &wale::kCoder; }
