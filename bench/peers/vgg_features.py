#!/usr/bin/env python3
"""Features of VGG16 by NumPy in double precision and by ONNX Runtime: the figures that Wale's must agree with.

    pip install numpy onnx onnxruntime
    WALE_REAL_DATA=... python3 bench/peers/vgg_features.py [--write]

Prints the table of bench/results/vgg_features.md. `--write` also writes tests/host/fit_vgg_figures.inc, and
tests/host/vgg16_first_layer.onnx with the first layer of the made-up weights.

Weights: the Oxford ones in $WALE_REAL_DATA/vgg16 (blocks 1 and 2, Keras layout), and made-up ones of all 13 layers. Pictures:
a formula. Both formulas are integers, so that C++ has the same numbers to the last bit.
"""
import os
import pathlib
import sys

import numpy as np

LAYERS = [(1, 1, 3, 64), (1, 2, 64, 64), (2, 1, 64, 128), (2, 2, 128, 128), (3, 1, 128, 256), (3, 2, 256, 256),
          (3, 3, 256, 256), (4, 1, 256, 512), (4, 2, 512, 512), (4, 3, 512, 512), (5, 1, 512, 512), (5, 2, 512, 512),
          (5, 3, 512, 512)]
ROOT = pathlib.Path(__file__).parents[2]


def picture(width, height):
    """Display values [c][y][x]."""
    c, y, x = np.meshgrid(np.arange(3), np.arange(height), np.arange(width), indexing="ij")
    return ((7 * x + 13 * y + 29 * c + x * y) % 97 / np.float32(96)).astype(np.float32)


def scrambled(index):
    """Integers to numbers in [-0.5, 0.5)."""
    h = (np.asarray(index, np.uint64) * 2654435761) % 2**32
    h ^= h >> np.uint64(15)
    h = (h * 2246822519) % 2**32
    h ^= h >> np.uint64(13)
    return (h >> np.uint64(8)).astype(np.float32) / np.float32(2**24) - np.float32(0.5)


def made_up():
    layers = []
    for block, place, inner, outer in LAYERS:
        seed = 1000003 * (10 * block + place)
        scale = np.float32(np.sqrt(np.float32(24) / np.float32(9 * inner)))  # keeps the mean square through a ReLU
        weights = scrambled(seed + np.arange(outer * inner * 9)).reshape(outer, inner, 3, 3) * scale
        bias = scrambled(seed + 500000009 + np.arange(outer)) * np.float32(0.1)
        layers.append((weights, bias))
    return layers


def oxford(folder):
    data = np.load(folder / "vgg16/vgg16_imagenet_block1_block2.npz")
    return [(np.ascontiguousarray(data[f"block{b}_conv{p}_kernel"].transpose(3, 2, 0, 1)), data[f"block{b}_conv{p}_bias"])
            for b, p in [(1, 1), (1, 2), (2, 1), (2, 2)]]


def caffe(display):
    return 255 * display[::-1] - np.array([103.939, 116.779, 123.68])[:, None, None]


def torch(display):
    mean, deviation = np.array([0.485, 0.456, 0.406]), np.array([0.229, 0.224, 0.225])
    return (display - mean[:, None, None]) / deviation[:, None, None]


def numpy_features(x, layers):
    x = x.astype(np.float64)
    out = []
    for i, (weights, bias) in enumerate(layers):
        if i and LAYERS[i][0] != LAYERS[i - 1][0]:
            h, w = x.shape[1] // 2, x.shape[2] // 2
            x = x[:, :2 * h, :2 * w].reshape(x.shape[0], h, 2, w, 2).max((2, 4))
        padded = np.pad(x, ((0, 0), (1, 1), (1, 1)))
        y = np.zeros((weights.shape[0], *x.shape[1:]))
        for ky in range(3):
            for kx in range(3):
                y += np.einsum("oi,iyx->oyx", weights[:, :, ky, kx].astype(np.float64),
                               padded[:, ky:ky + x.shape[1], kx:kx + x.shape[2]], optimize=True)
        x = np.maximum(y + bias.astype(np.float64)[:, None, None], 0)
        out.append(x)
    return out


def onnx_model(layers, width, height):
    import onnx
    from onnx import TensorProto, helper, numpy_helper
    nodes, tensors, outputs, last = [], [], [], "x"
    for i, (weights, bias) in enumerate(layers):
        block, place = LAYERS[i][:2]
        name = f"{block}_{place}"
        if i and block != LAYERS[i - 1][0]:
            nodes.append(helper.make_node("MaxPool", [last], [f"pool{name}"], kernel_shape=[2, 2], strides=[2, 2]))
            last = f"pool{name}"
        tensors += [numpy_helper.from_array(weights, f"w{name}"), numpy_helper.from_array(bias, f"b{name}")]
        nodes.append(helper.make_node("Conv", [last, f"w{name}", f"b{name}"], [f"conv{name}"], kernel_shape=[3, 3],
                                      pads=[1, 1, 1, 1], strides=[1, 1]))
        nodes.append(helper.make_node("Relu", [f"conv{name}"], [f"relu{name}"]))
        last = f"relu{name}"
        outputs.append(helper.make_tensor_value_info(last, TensorProto.FLOAT, None))
    graph = helper.make_graph(nodes, "vgg16", [helper.make_tensor_value_info("x", TensorProto.FLOAT, [1, 3, height, width])],
                              outputs, tensors)
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)


def runtime_features(x, layers):
    import onnxruntime
    model = onnx_model(layers, x.shape[2], x.shape[1]).SerializeToString()
    session = onnxruntime.InferenceSession(model, providers=["CPUExecutionProvider"])
    return [y[0] for y in session.run(None, {"x": x[None].astype(np.float32)})]


def figures(features):
    """Per layer: root mean square, mean, greatest, and a mean with weights that tell every place from its neighbours."""
    rows = []
    for f in features:
        c, y, x = np.meshgrid(*(np.arange(n) for n in f.shape), indexing="ij")
        rows.append((np.sqrt((f**2).mean()), f.mean(), f.max(), (f * ((31 * c + 17 * y + 7 * x) % 11 - 5)).mean()))
    return rows


def main():
    import onnx
    import onnxruntime
    width, height = 38, 34
    display = picture(width, height)
    real = pathlib.Path(os.environ["WALE_REAL_DATA"])
    nets = {"oxford": (oxford(real), caffe(display)), "made_up": (made_up(), torch(display))}
    print(f"NumPy {np.__version__}, ONNX Runtime {onnxruntime.__version__}, a picture of {width} x {height} pixels\n")
    print("| weights | layer | root mean square | mean | ONNX Runtime: greatest difference over it |")
    print("|---|---|---|---|---|")
    text = "// Written by bench/peers/vgg_features.py: root mean square, mean, greatest value and weighted mean of each layer.\n"
    for name, (layers, x) in nets.items():
        ours, theirs = numpy_features(x, layers), runtime_features(x, layers)
        text += f"constexpr double k{'Oxford' if name == 'oxford' else 'MadeUp'}[][4] = {{\n"
        for (block, place, *_), row, a, b in zip(LAYERS, figures(ours), ours, theirs):
            print(f"| {name.replace('_', '-')} | relu{block}_{place} | {row[0]:.6g} | {row[1]:.6g} |"
                  f" {np.abs(a - b).max() / row[0]:.1e} |")
            text += "    {" + ", ".join(f"{v:.9g}" for v in row) + "},\n"
        text += "};\n"
    if "--write" in sys.argv:
        (ROOT / "tests/host/fit_vgg_figures.inc").write_text(text)
        model = onnx_model(made_up()[:1], width, height).SerializeToString()
        (ROOT / "tests/host/vgg16_first_layer.onnx").write_bytes(model)


if __name__ == "__main__":
    main()
