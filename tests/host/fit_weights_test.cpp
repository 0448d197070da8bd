// Files of weights: every layout gives the same network, and whatever is wrong has its line.
#include <cmath>

#include "host/fit/npy.h"
#include "host/fit/protobuf.h"
#include "host/fit/vgg16.h"
#include "host/fit/zip_entries.h"
#include "tests/host/fit_pictures.h"
#include "tests/host/fit_weight_files.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

bool same(const FeatureNetwork& a, const FeatureNetwork& b) {
  const Picture picture = random_picture(9, 7, 3);
  if (a.layers() != b.layers()) return false;
  const auto left = a.features(picture, a.layers()), right = b.features(picture, b.layers());
  for (size_t i = 0; i < left.size(); ++i)
    if (left[i].values != right[i].values) return false;
  return true;
}

TEST(FitNpy, NumbersShapesAndOrders) {
  const std::vector<float> six{1, 2, 3, 4, 5, 6};
  const NpyArray c = parse_npy(npy("(2, 3)", raw(six)), "a");
  EXPECT_EQ(c.shape, (std::vector<size_t>{2, 3}));
  EXPECT_EQ(c.values, six);
  const NpyArray fortran = parse_npy(npy("(2, 3)", raw(six), "<f4", "True"), "a");
  EXPECT_EQ(fortran.values, (std::vector<float>{1, 3, 5, 2, 4, 6}));
  const double two[] = {0.5, -1e-3};
  const std::string bytes(reinterpret_cast<const char*>(two), sizeof two);
  EXPECT_EQ(parse_npy(npy("(2,)", bytes, "<f8"), "a").values, (std::vector<float>{0.5f, -1e-3f}));
  EXPECT_EQ(parse_npy(npy("()", raw({7})), "a").values, (std::vector<float>{7}));
  EXPECT_TRUE(parse_npy(npy("(0, 3)", ""), "a").values.empty());
  // Version 2 has a longer number for the length.
  const std::string header = "{'shape': (1,), 'fortran_order': False, 'descr': '<f4'}" + std::string(70000, ' ') + "\n";
  EXPECT_EQ(
      parse_npy("\x93NUMPY" + little_endian(2, 2) + little_endian(header.size(), 4) + header + raw({3}), "a").values,
      (std::vector<float>{3}));
}

TEST(FitNpy, DamagedFilesHaveTheirLine) {
  const auto line = [](const std::string& bytes) { return user_message([&] { parse_npy(bytes, "w.npy"); }); };
  const std::string good = npy("(2,)", raw({1, 2}));
  EXPECT_EQ(line("hello, world"), "w.npy: not a .npy file");
  EXPECT_EQ(line(good.substr(0, 20)), "w.npy: is cut off in its header");
  EXPECT_EQ(line(good.substr(0, good.size() - 1)), "w.npy: 7 bytes for 2 numbers of 4; is it cut off?");
  EXPECT_EQ(line(npy("(2,)", "12345678", ">f4")),
            "w.npy: numbers of type \">f4\"; valid: \"<f4\", \"<f8\" (array.astype('<f4'))");
  EXPECT_EQ(line(npy("(4294967296, 4294967296, 4294967296)", "1234")),
            "w.npy: 4294967296 x 4294967296 x 4294967296 numbers do not fit into its 4 bytes");
  for (const char* shape : {"(2", "(-2,)", "2", "(1,1,1,1,1,1,1,1,1)", "(99999999999999999999,)"})
    EXPECT_NE(line(npy(shape, raw({1, 2}))).find("its header is not that of an array"), std::string::npos) << shape;
  EXPECT_NE(line(npy("(2,)", raw({1, 2}), "<f4", "Maybe")).find("not that of an array"), std::string::npos);
  std::string version = good;
  version[6] = 9;
  EXPECT_EQ(line(version), "w.npy: .npy version 9; valid: 1, 2, 3");
}

TEST(FitZip, StoredAndDeflated) {
  const std::string long_text(100000, 'x');
  const std::string archive = zip({{"a", "stored", false}, {"b", long_text, true}, {"c", "", false}});
  const auto entries = zip_entries(archive + std::string(60000, '#'), "z");  // a comment
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(zip_content(archive, entries[0], "z"), "stored");
  EXPECT_LT(entries[1].packed, 1000u);
  EXPECT_EQ(zip_content(archive, entries[1], "z"), long_text);
  EXPECT_EQ(zip_content(archive, entries[2], "z"), "");
}

TEST(FitZip, DamagedArchivesHaveTheirLine) {
  const std::string good = zip({{"a", std::string(5000, 'a'), true}, {"b", "plain", false}});
  const auto content = [](const std::string& archive, size_t i) {
    return user_message([&] { zip_content(archive, zip_entries(archive, "z.npz").at(i), "z.npz"); });
  };
  EXPECT_EQ(content("PK but no archive, however long it is", 0),
            "z.npz: its directory is missing; is it a .npz or .zip file, and whole?");
  EXPECT_EQ(content(good.substr(0, good.size() - 5), 0),
            "z.npz: its directory is missing; is it a .npz or .zip file, and whole?");
  const size_t end = good.rfind("PK\5\6"), directory = good.find("PK\1\2"), second = good.rfind("PK\1\2");
  const auto with = [&](size_t at, const std::string& bytes) {
    std::string changed = good;
    return changed.replace(at, bytes.size(), bytes);
  };
  EXPECT_EQ(content(with(end + 10, little_endian(1, 2)), 0), "z.npz: is one part of an archive in several");
  EXPECT_EQ(content(with(end + 16, little_endian(0xFFFFFFFF, 4)), 0),
            "z.npz: archives above 4 GiB or 65534 entries are not read");
  EXPECT_EQ(content(with(end + 16, little_endian(7, 4)), 0), "z.npz: entry 1 of its directory is damaged");
  EXPECT_EQ(content(with(second + 28, little_endian(9000, 2)), 0), "z.npz: entry 2 of its directory is cut off");
  EXPECT_EQ(content(with(directory + 8, little_endian(1, 2)), 0), "z.npz: a: is encrypted");
  EXPECT_EQ(content(with(directory + 10, little_endian(12, 2)), 0),
            "z.npz: a: packed by method 12; valid: stored (0) and deflate (8)");
  EXPECT_EQ(content(with(directory + 42, little_endian(3, 4)), 0), "z.npz: a: has no header; is the file damaged?");
  EXPECT_EQ(content(with(second + 20, little_endian(4000000000u, 4)), 1), "z.npz: b: is cut off");
  EXPECT_EQ(content(with(directory + 24, little_endian(4000000000u, 4)), 0),
            "z.npz: a: 4000000000 bytes cannot come from 23 packed ones");
  EXPECT_EQ(content(with(directory + 24, little_endian(5001, 4)), 0),
            "z.npz: a: cannot be unpacked; is the file damaged?");
  EXPECT_EQ(content(with(directory + 24, little_endian(4999, 4)), 0),
            "z.npz: a: cannot be unpacked; is the file damaged?");
  EXPECT_EQ(content(with(directory + 16, little_endian(1, 4)), 0),
            "z.npz: a: its check sum is wrong; is the file damaged?");
}

TEST(FitProtobuf, FieldsOfEveryKind) {
  // 1: varint 300; 2: text; 3: 8 bytes; 4: 4 bytes (the example of "Encoding", protobuf.dev, is 08 96 01 = 150).
  const std::string name = "m",
                    message = std::string("\x08\xac\x02\x12\x02hi\x19") + "12345678" + "\x25" + "1234" + "\x28\x01";
  ProtobufFields fields(message, name);
  ASSERT_TRUE(fields.next());
  EXPECT_EQ(fields.number(), 1u);
  EXPECT_EQ(fields.integer(), 300u);
  ASSERT_TRUE(fields.next());
  EXPECT_EQ(fields.number(), 2u);
  EXPECT_EQ(fields.bytes(), "hi");
  ASSERT_TRUE(fields.next());
  EXPECT_EQ(fields.number(), 3u);
  EXPECT_EQ(fields.bytes(), "");
  ASSERT_TRUE(fields.next());
  EXPECT_EQ(fields.number(), 4u);
  ASSERT_TRUE(fields.next());
  EXPECT_EQ(fields.number(), 5u);
  EXPECT_EQ(fields.integer(), 1u);
  EXPECT_FALSE(fields.next());
}

TEST(FitProtobuf, DamagedMessagesHaveTheirLine) {
  const auto line = [](const std::string& bytes) {
    return user_message([&] {
      const std::string name = "m.onnx";
      ProtobufFields fields(bytes, name);
      while (fields.next()) continue;
    });
  };
  EXPECT_EQ(line("\x08\xff"), "m.onnx: is cut off within a number");
  EXPECT_EQ(line("\x08" + std::string(11, '\xff')), "m.onnx: holds a number of more than 64 bits; is it damaged?");
  EXPECT_EQ(line("\x12\x7f"
                 "abc"),
            "m.onnx: is cut off: a field of 127 bytes has 3");
  EXPECT_EQ(line("\x19"
                 "1234"),
            "m.onnx: is cut off: a field of 8 bytes has 4");
  EXPECT_EQ(line(std::string("\x02\0", 2)), "m.onnx: a field has no number; is it damaged?");
  EXPECT_EQ(line("\x0b"), "m.onnx: a field of kind 3; is it damaged?");
}

// Keras' arrays, from the same weights.
std::vector<ZipFile> keras_arrays(const std::vector<Convolution>& layers) {
  std::vector<ZipFile> files;
  for (size_t k = 0; k < layers.size(); ++k) {
    const Convolution& layer = layers[k];
    const Vgg16Layer& place = vgg16_layers()[k];
    std::vector<float> kernel(layer.weights.size());
    for (int o = 0; o < layer.out; ++o)
      for (int i = 0; i < layer.in; ++i)
        for (int tap = 0; tap < 9; ++tap)
          kernel[size_t((tap * layer.in + i) * layer.out + o)] = layer.weights[size_t((o * layer.in + i) * 9 + tap)];
    const std::string name = fmt::format("block{}_conv{}_", place.block, place.place);
    files.push_back({name + "kernel.npy", npy(fmt::format("(3, 3, {}, {})", layer.in, layer.out), raw(kernel))});
    files.push_back({name + "bias.npy", npy(fmt::format("({},)", layer.out), raw(layer.bias))});
  }
  return files;
}

TEST(FitWeights, EveryLayoutGivesTheSameNetwork) {
  const auto layers = made_up_layers(3);
  const Vgg16 torch(layers, Normalisation::torch), caffe(layers, Normalisation::caffe);
  EXPECT_TRUE(same(*parse_vgg16_npz(zip(torch_arrays(layers)), "w"), torch));
  EXPECT_TRUE(same(*parse_vgg16_npz(zip(torch_arrays(layers, true)), "w"), torch));
  EXPECT_TRUE(same(*parse_vgg16_npz(zip(keras_arrays(layers)), "w"), caffe));
  EXPECT_TRUE(same(*parse_vgg16_npz(zip(keras_arrays(layers)), "w", Normalisation::torch), torch));
  EXPECT_FALSE(same(torch, caffe));
  EXPECT_EQ(parse_vgg16_npz(zip(torch_arrays(made_up_layers(1))), "w")->text(),
            "relu1_1 to relu1_1 of VGG16, 1 of 13 layers");
}

// Written by the onnx package from the same made-up weights (bench/peers/vgg_features.py).
TEST(FitWeights, AModelThatOnnxWrote) {
  const std::string model = file_text(std::filesystem::path(WALE_SOURCE_DIR) / "tests/host/vgg16_first_layer.onnx");
  EXPECT_TRUE(same(*parse_vgg16_onnx(model, "m"), Vgg16(made_up_layers(1), Normalisation::torch)));
  const TemporaryFolder folder;
  EXPECT_EQ(read_vgg16(folder.write("vgg.onnx", model))->layers().size(), 1u);
  EXPECT_EQ(read_vgg16(folder.write("vgg.npz", zip(torch_arrays(made_up_layers(2)))))->layers().size(), 2u);
  EXPECT_NE(user_message([&] { read_vgg16(folder / "none.npz"); }).find("none.npz: no such file of weights"),
            std::string::npos);
  EXPECT_NE(user_message([&] {
              read_vgg16(folder.write("vgg.pth", "weights"));
            }).find("weights are read from .npz files of NumPy and from .onnx models"),
            std::string::npos);
}

TEST(FitWeights, AnotherNetworkHasItsLine) {
  const auto layers = made_up_layers(3);
  auto arrays = torch_arrays(layers);
  const auto line = [](const std::vector<ZipFile>& files) {
    return user_message([&] { parse_vgg16_npz(zip(files), "w.npz"); });
  };
  EXPECT_EQ(line({{"a.npy", npy("(1,)", raw({1}))}}),
            "w.npz: holds no first layer of VGG16: block1_conv1_kernel, conv1_1.weight or features.0.weight");
  auto gap = arrays;
  gap.erase(gap.begin() + 2, gap.begin() + 4);
  EXPECT_EQ(line(gap),
            "w.npz: holds features.5.weight.npy but no conv1_2; layers must follow from the first without a gap");
  auto no_bias = arrays;
  no_bias.erase(no_bias.begin() + 3);
  EXPECT_EQ(line(no_bias), "w.npz: holds features.2.weight.npy but no bias of conv1_2");
  auto shape = arrays;
  shape[2].content = npy("(64, 65, 3, 3)", std::string(64 * 65 * 9 * 4, '\0'));
  EXPECT_EQ(line(shape),
            "w.npz: features.2.weight.npy: has 64 x 65 x 3 x 3 numbers, not VGG16's 3 x 3 x 64 x 64 (Keras) "
            "or 64 x 64 x 3 x 3 (torch) as the first");
  auto mixed = arrays;
  mixed[2].content = npy("(3, 3, 64, 64)", raw(layers[1].weights));
  EXPECT_NE(line(mixed).find("features.2.weight.npy: has 3 x 3 x 64 x 64 numbers"), std::string::npos);
  auto bias = arrays;
  bias[1].content = npy("(63,)", std::string(63 * 4, '\0'));
  EXPECT_EQ(line(bias), "w.npz: features.0.bias.npy: has 63 numbers, VGG16's conv1_1 has 64");
  auto wild = layers;
  wild[1].weights[5] = NAN;
  EXPECT_EQ(line(torch_arrays(wild)), "w.npz: features.2.weight.npy: nan is not a finite number");
}

// The smallest writer of an ONNX model.
std::string field(int number, const std::string& bytes) {
  std::string out(1, char(number << 3 | 2));
  size_t size = bytes.size();
  for (; size > 127; size >>= 7) out += char(128 | (size & 127));
  return out + char(size) + bytes;
}
std::string integer_field(int number, int value) {  // up to 16383
  std::string out(1, char(number << 3));
  if (value > 127) out += char(128 | (value & 127)), value >>= 7;
  return out + char(value);
}
std::string node(const std::string& kind, const std::vector<std::string>& inputs) {
  std::string out;
  for (const std::string& input : inputs) out += field(1, input);
  return field(1, out + field(4, kind));
}
std::string tensor(const std::string& name, const std::vector<int>& shape, const std::string& data, int type = 1,
                   bool elsewhere = false) {
  std::string out;
  for (const int extent : shape) out += integer_field(1, extent);
  return field(
      5, out + integer_field(2, type) + field(8, name) + field(9, data) + (elsewhere ? integer_field(14, 1) : ""));
}

TEST(FitWeights, OnnxModelsThatAreNotVgg16HaveTheirLine) {
  const auto layers = made_up_layers(2);
  const auto weights = [&](size_t i, int type = 1, bool elsewhere = false) {
    const std::string n = std::to_string(i);
    return tensor("w" + n, {layers[i].out, layers[i].in, 3, 3}, raw(layers[i].weights), type, elsewhere) +
           tensor("b" + n, {layers[i].out}, raw(layers[i].bias));
  };
  const auto model = [](const std::string& graph) { return integer_field(1, 8) + field(7, graph); };
  const std::string first = node("Conv", {"x", "w0", "b0"}), second = node("Conv", {"y", "w1", "b1"});
  const std::string both = first + node("Relu", {"a"}) + second + weights(0) + weights(1);
  EXPECT_TRUE(same(*parse_vgg16_onnx(model(both), "m"), Vgg16(layers, Normalisation::torch)));
  const std::string packed_axes =
      field(5, field(1, "\x40\3\3\3") + integer_field(2, 1) + field(8, "w0") + field(9, raw(layers[0].weights)));
  EXPECT_EQ(
      parse_vgg16_onnx(model(first + packed_axes + tensor("b0", {64}, raw(layers[0].bias))), "m")->layers().size(), 1u);
  const auto line = [&](const std::string& graph) {
    return user_message([&] { parse_vgg16_onnx(model(graph), "m.onnx"); });
  };
  EXPECT_EQ(user_message([] { parse_vgg16_onnx(integer_field(1, 8), "m.onnx"); }),
            "m.onnx: holds no graph; is it an ONNX model?");
  EXPECT_EQ(line(node("Relu", {"a"})), "m.onnx: holds no Conv node");
  EXPECT_EQ(line(first), "m.onnx: conv1_1.weight is not among its initialisers");
  EXPECT_EQ(line(node("Conv", {"x", "w0"}) + weights(0)), "m.onnx: conv1_1.bias is not among its initialisers");
  EXPECT_EQ(line(first + weights(0, 10)), "m.onnx: conv1_1.weight has numbers of ONNX type 10; valid: float (1)");
  EXPECT_EQ(line(first + weights(0, 1, true)),
            "m.onnx: conv1_1.weight is kept in another file; save the model as one file");
  EXPECT_EQ(line(first + tensor("w0", {64, 3, 7, 7}, "")),
            "m.onnx: conv1_1.weight has 64 x 3 x 7 x 7 numbers, VGG16's has 64 x 3 x 3 x 3; is it another network?");
  EXPECT_EQ(line(first + tensor("w0", {64, 3, 3, 3}, "1234")),
            "m.onnx: conv1_1.weight has 4 bytes for 1728 numbers; is it cut off?");
  EXPECT_EQ(
      line(first + node("BatchNormalization", {"a"}) + node("Relu", {"a"}) + second + weights(0) + weights(1)),
      "m.onnx: a node BatchNormalization stands before conv1_2; only networks of Conv, Relu and MaxPool are read");
  auto wild = layers[0].bias;
  wild[3] = INFINITY;
  EXPECT_EQ(line(first + tensor("w0", {64, 3, 3, 3}, raw(layers[0].weights)) + tensor("b0", {64}, raw(wild))),
            "m.onnx: conv1_1.bias: inf is not a finite number");
}

}  // namespace
}  // namespace wale::fit
