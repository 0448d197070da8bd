#pragma once
#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

#include "host/fit/vgg16.h"

namespace wale::fit {

inline std::string little_endian(uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i, value >>= 8) text += char(value & 255);
  return text;
}

inline std::string raw(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// A .npy file, version 1.
inline std::string npy(const std::string& shape, const std::string& data, const std::string& type = "<f4",
                       const std::string& fortran = "False") {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
  header.resize((10 + header.size() + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  return "\x93NUMPY" + little_endian(1, 1) + little_endian(0, 1) + little_endian(header.size(), 2) + header + data;
}

struct ZipFile {
  std::string name, content;
  bool deflated = false;
};

/// A ZIP archive.
inline std::string zip(const std::vector<ZipFile>& files) {
  std::string out, directory;
  for (const ZipFile& file : files) {
    std::string packed = file.content;
    if (file.deflated) {
      packed.resize(compressBound(uLong(file.content.size())));
      uLongf size = uLongf(packed.size());
      compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(file.content.data()),
               uLong(file.content.size()));
      packed = packed.substr(2, size - 6);  // zlib's own head and check sum left out
    }
    const uint32_t crc =
        uint32_t(crc32(0, reinterpret_cast<const Bytef*>(file.content.data()), uInt(file.content.size())));
    const std::string common = little_endian(20, 2) + little_endian(0, 2) + little_endian(file.deflated ? 8 : 0, 2) +
                               little_endian(0, 4) + little_endian(crc, 4) + little_endian(packed.size(), 4) +
                               little_endian(file.content.size(), 4) + little_endian(file.name.size(), 2) +
                               little_endian(0, 2);
    directory += "PK\1\2" + little_endian(20, 2) + common + little_endian(0, 2 + 2 + 2 + 4) +
                 little_endian(out.size(), 4) + file.name;
    out += "PK\3\4" + common + file.name + packed;
  }
  const size_t start = out.size();
  return out + directory + "PK\5\6" + little_endian(0, 4) + little_endian(files.size(), 2) +
         little_endian(files.size(), 2) + little_endian(directory.size(), 4) + little_endian(start, 4) +
         little_endian(0, 2);
}

/// Integers to numbers in [-0.5, 0.5), as in bench/peers/vgg_features.py.
inline float scrambled(uint64_t index) {
  uint64_t h = index * 2654435761u % (uint64_t(1) << 32);
  h ^= h >> 15;
  h = h * 2246822519u % (uint64_t(1) << 32);
  h ^= h >> 13;
  return float(h >> 8) / float(1 << 24) - 0.5f;
}

/// The first `count` layers of the made-up weights of bench/peers/vgg_features.py.
inline std::vector<Convolution> made_up_layers(size_t count) {
  std::vector<Convolution> all;
  for (const Vgg16Layer& layer : vgg16_layers().first(count)) {
    const uint64_t seed = 1000003u * uint64_t(10 * layer.block + layer.place);
    Convolution one{layer.in, layer.out, std::vector<float>(size_t(layer.in) * size_t(layer.out) * 9),
                    std::vector<float>(size_t(layer.out))};
    const float scale = std::sqrt(24.0f / float(9 * layer.in));
    for (size_t i = 0; i < one.weights.size(); ++i) one.weights[i] = scrambled(seed + i) * scale;
    for (size_t i = 0; i < one.bias.size(); ++i) one.bias[i] = scrambled(seed + 500000009u + i) * 0.1f;
    all.push_back(std::move(one));
  }
  return all;
}

/// One as arrays of torchvision, "features.0.weight" and "features.0.bias".
inline std::vector<ZipFile> torch_arrays(const std::vector<Convolution>& layers, bool deflated = false) {
  std::vector<ZipFile> files;
  for (size_t i = 0; i < layers.size(); ++i) {
    const std::string name = "features." + std::to_string(vgg16_layers()[i].torch);
    const std::string in = std::to_string(layers[i].in), out = std::to_string(layers[i].out);
    files.push_back({name + ".weight.npy", npy("(" + out + ", " + in + ", 3, 3)", raw(layers[i].weights)), deflated});
    files.push_back({name + ".bias.npy", npy("(" + out + ",)", raw(layers[i].bias)), deflated});
  }
  return files;
}

}  // namespace wale::fit
