// Weights of VGG16 in an ONNX model: ModelProto.graph, its nodes and its initialisers. Field numbers of onnx.proto.
#include <cmath>
#include <cstring>
#include <map>

#include "geom/error.h"
#include "host/fit/npy.h"
#include "host/fit/protobuf.h"
#include "host/fit/vgg16.h"

namespace wale::fit {
namespace {

// TensorProto, its numbers still packed.
struct Tensor {
  std::vector<size_t> shape;
  uint64_t type = 0;
  std::string_view numbers;
  bool elsewhere = false;  // in another file
};

struct Node {
  std::string kind;
  std::vector<std::string> inputs;
};

struct Graph {
  std::vector<Node> nodes;
  std::map<std::string, Tensor, std::less<>> tensors;
};

void read_tensor(std::string_view message, const std::string& file, Graph& graph) {
  constexpr size_t kMostAxes = 8;
  Tensor tensor;
  std::string name;
  const auto add_axis = [&](uint64_t extent) {
    if (tensor.shape.size() == kMostAxes) user_error("{}: a tensor of more than {} axes", file, kMostAxes);
    tensor.shape.push_back(size_t(extent));
  };
  ProtobufFields fields(message, file);
  while (fields.next()) {
    switch (fields.number()) {
      case 1: {  // dims, each by itself or packed
        PackedVarints packed(fields.bytes(), file);
        if (fields.is_integer()) add_axis(fields.integer());
        for (uint64_t extent; packed.next(extent);) add_axis(extent);
        break;
      }
      case 2:
        tensor.type = fields.integer();
        break;
      case 4:  // float_data
      case 9:  // raw_data
        if (fields.is_bytes()) tensor.numbers = fields.bytes();
        break;
      case 8:
        name = fields.bytes();
        break;
      case 14:
        tensor.elsewhere = fields.integer() != 0;
        break;
      default:
        break;
    }
  }
  graph.tensors.emplace(std::move(name), std::move(tensor));
}

void read_node(std::string_view message, const std::string& file, Graph& graph) {
  Node node;
  ProtobufFields fields(message, file);
  while (fields.next()) {
    if (fields.number() == 1) node.inputs.emplace_back(fields.bytes());
    if (fields.number() == 4) node.kind = fields.bytes();
  }
  graph.nodes.push_back(std::move(node));
}

Graph read_graph(std::string_view model, const std::string& file) {
  Graph graph;
  bool found = false;
  ProtobufFields fields(model, file);
  while (fields.next()) {
    if (fields.number() != 7 || !fields.is_bytes()) continue;
    found = true;
    ProtobufFields parts(fields.bytes(), file);
    while (parts.next()) {
      if (parts.number() == 1 && parts.is_bytes()) read_node(parts.bytes(), file, graph);
      if (parts.number() == 5 && parts.is_bytes()) read_tensor(parts.bytes(), file, graph);
    }
  }
  if (!found) user_error("{}: holds no graph; is it an ONNX model?", file);
  return graph;
}

// The numbers of a Conv node's input; `what` is for messages.
std::vector<float> numbers(const Graph& graph, const Node& node, size_t input, const std::vector<size_t>& shape,
                           const std::string& what, const std::string& file) {
  constexpr uint64_t kFloat = 1;
  const auto found = input < node.inputs.size() ? graph.tensors.find(node.inputs[input]) : graph.tensors.end();
  if (found == graph.tensors.end()) user_error("{}: {} is not among its initialisers", file, what);
  const Tensor& tensor = found->second;
  if (tensor.elsewhere) user_error("{}: {} is kept in another file; save the model as one file", file, what);
  if (tensor.type != kFloat)
    user_error("{}: {} has numbers of ONNX type {}; valid: float (1)", file, what, tensor.type);
  if (tensor.shape != shape)
    user_error("{}: {} has {} numbers, VGG16's has {}; is it another network?", file, what, shape_text(tensor.shape),
               shape_text(shape));
  size_t count = 1;
  for (const size_t extent : shape) count *= extent;
  if (tensor.numbers.size() != count * sizeof(float))
    user_error("{}: {} has {} bytes for {} numbers; is it cut off?", file, what, tensor.numbers.size(), count);
  std::vector<float> values(count);
  std::memcpy(values.data(), tensor.numbers.data(), tensor.numbers.size());
  for (const float value : values)
    if (!std::isfinite(value)) user_error("{}: {}: {} is not a finite number", file, what, value);
  return values;
}

}  // namespace

std::shared_ptr<const Vgg16> parse_vgg16_onnx(std::string_view bytes, const std::string& file,
                                              std::optional<Normalisation> normalisation) {
  const Graph graph = read_graph(bytes, file);
  std::vector<Convolution> convolutions;
  std::string between;  // a node that is none of VGG16's
  for (const Node& node : graph.nodes) {
    if (convolutions.size() == vgg16_layers().size()) break;
    if (node.kind != "Conv") {
      if (node.kind != "Relu" && node.kind != "MaxPool" && node.kind != "Constant" && between.empty())
        between = node.kind;
      continue;
    }
    const Vgg16Layer& layer = vgg16_layers()[convolutions.size()];
    if (!between.empty() && !convolutions.empty())
      user_error("{}: a node {} stands before {}; only networks of Conv, Relu and MaxPool are read", file, between,
                 layer.name());
    between.clear();  // before the first layer stands what prepares a picture
    const size_t in = size_t(layer.in), out = size_t(layer.out);
    std::vector<float> weights = numbers(graph, node, 1, {out, in, 3, 3}, layer.name() + ".weight", file);
    std::vector<float> bias = numbers(graph, node, 2, {out}, layer.name() + ".bias", file);
    convolutions.push_back({layer.in, layer.out, std::move(weights), std::move(bias)});
  }
  if (convolutions.empty()) user_error("{}: holds no Conv node", file);
  return std::make_shared<Vgg16>(std::move(convolutions), normalisation.value_or(Normalisation::torch));
}

}  // namespace wale::fit
