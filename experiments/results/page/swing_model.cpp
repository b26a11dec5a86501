#include "experiments/results/page/swing_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using GltfJson = nlohmann::ordered_json;

constexpr int gltf_float = 5126, gltf_unsigned = 5125;
constexpr int gltf_steps = 32;          // keyframes of a period
constexpr double gltf_period = 2.0;     // [s], whatever the frequency: it is for the eye
constexpr double gltf_amplitude = 0.1;  // of the largest extent

template <class Number>
void append_bytes(std::string& bytes, Number number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

/// The two chunks of a file, as accessors are added.
struct GltfFile {
  GltfJson json;
  std::string bytes;

  int accessor(const std::string& content, int component, const char* type, std::size_t count) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}});
    bytes += content;
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  /// With the smallest and largest values, which glTF wants of places. z upwards becomes y upwards.
  int places(const Eigen::Matrix3Xd& points) {
    Eigen::Matrix3Xf turned(3, points.cols());
    turned.row(0) = points.row(0).cast<float>();
    turned.row(1) = points.row(2).cast<float>();
    turned.row(2) = -points.row(1).cast<float>();
    turned.array() += 0.0f;  // -0 is 0
    std::string content(reinterpret_cast<const char*>(turned.data()),
                        sizeof(float) * static_cast<std::size_t>(turned.size()));
    const int at = accessor(content, gltf_float, "VEC3", static_cast<std::size_t>(points.cols()));
    const Eigen::Vector3f low = turned.rowwise().minCoeff(), high = turned.rowwise().maxCoeff();
    json["accessors"][at]["min"] = {low[0], low[1], low[2]};
    json["accessors"][at]["max"] = {high[0], high[1], high[2]};
    return at;
  }

  int numbers(const std::vector<float>& values, bool limits) {
    std::string content;
    for (const float value : values) append_bytes(content, value);
    const int at = accessor(content, gltf_float, "SCALAR", values.size());
    if (limits) {
      json["accessors"][at]["min"] = GltfJson::array({values.front()});
      json["accessors"][at]["max"] = GltfJson::array({values.back()});
    }
    return at;
  }

  int indices(const std::vector<unsigned>& corners) {
    std::string content;
    for (const unsigned corner : corners) append_bytes(content, static_cast<std::uint32_t>(corner));
    return accessor(content, gltf_unsigned, "SCALAR", corners.size());
  }
};

double extent_of(const SwingModel& model) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const SwingModel::Part& part : model.parts) {
    low = low.cwiseMin(part.points.rowwise().minCoeff());
    high = high.cwiseMax(part.points.rowwise().maxCoeff());
  }
  return (high - low).maxCoeff();
}

void check_model(const SwingModel& model) {
  if (model.parts.empty()) throw std::invalid_argument("a model without parts; expected one at least");
  const std::size_t motions = model.parts[0].motion.size();
  for (const SwingModel::Part& part : model.parts) {
    bool fits = part.points.cols() > 0 && !part.corners.empty() && part.motion.size() == motions;
    for (const Eigen::Matrix3Xd& motion : part.motion) fits = fits && motion.cols() == part.points.cols();
    for (const unsigned corner : part.corners) fits = fits && corner < part.points.cols();
    if (!fits) throw std::invalid_argument("a part whose motions or corners do not fit its points");
  }
  for (const SwingModel::Mode& mode : model.modes)
    for (const int motion : {mode.real, mode.quadrature.value_or(mode.real)})
      if (motion < 0 || static_cast<std::size_t>(motion) >= motions)
        throw std::invalid_argument(
            fmt::format("mode '{}' has motion {}; expected 0 to {}", mode.name, motion, motions - 1));
}

void add_animation(const SwingModel::Mode& mode, std::size_t motions, int times, GltfFile& file) {
  std::vector<float> weights;
  for (int step = 0; step <= gltf_steps; ++step) {
    const double phase = 2 * std::numbers::pi * step / gltf_steps;
    std::vector<float> row(motions, 0.0f);
    row[static_cast<std::size_t>(mode.real)] = static_cast<float>(std::cos(phase));
    if (mode.quadrature)
      row[static_cast<std::size_t>(*mode.quadrature)] = static_cast<float>(-std::sin(phase));
    weights.insert(weights.end(), row.begin(), row.end());
  }
  GltfJson channel{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  GltfJson sampler{{"input", times}, {"output", file.numbers(weights, false)}, {"interpolation", "LINEAR"}};
  file.json["animations"].push_back({{"name", mode.name},
                                     {"channels", GltfJson::array({channel})},
                                     {"samplers", GltfJson::array({sampler})}});
}

/// The animation of a motion, and its scale for the page.
void add_history(const MotionHistory& history, GltfFile& file, GltfJson& extras) {
  const double scale = history.largest > 0 ? 1.0 / history.largest : 1.0;
  std::vector<float> times, weights;
  for (Eigen::Index k = 0; k < history.time.size(); ++k) {
    times.push_back(static_cast<float>(history.time[k]));
    for (const double weight : history.weights.col(k)) weights.push_back(static_cast<float>(scale * weight));
  }
  GltfJson sampler{{"input", file.numbers(times, true)},
                   {"output", file.numbers(weights, false)},
                   {"interpolation", "LINEAR"}};
  GltfJson channel{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  file.json["animations"].push_back({{"name", "motion"},
                                     {"channels", GltfJson::array({channel})},
                                     {"samplers", GltfJson::array({sampler})}});
  extras["motion"] = {{"largest_m", history.largest}, {"residual_percent", history.residual_percent}};
}

std::string written(const SwingModel& model, const MotionHistory* history) {
  check_model(model);
  const std::size_t motions = model.parts[0].motion.size();
  const double extent = extent_of(model), moves = gltf_amplitude * (extent > 0 ? extent : 1.0);
  GltfFile file;
  file.json = {{"asset", {{"version", "2.0"}, {"generator", "beamid " BEAMID_VERSION}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}, {"name", "structure"}}}}};
  file.json["materials"].push_back(
      {{"name", "structure"},
       {"doubleSided", true},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.13, 0.45, 0.7, 1.0}}, {"metallicFactor", 0.1}}}});
  GltfJson mesh{{"primitives", GltfJson::array()},
                {"weights", std::vector<double>(motions, 0.0)},
                {"extras", {{"moves_m", moves}, {"modes", GltfJson::array()}}}};
  for (const SwingModel::Part& part : model.parts) {
    GltfJson primitive{{"attributes", {{"POSITION", file.places(part.points)}}},
                       {"indices", file.indices(part.corners)},
                       {"mode", static_cast<int>(part.kind)},
                       {"material", 0},
                       {"targets", GltfJson::array()}};
    for (const Eigen::Matrix3Xd& motion : part.motion)
      primitive["targets"].push_back({{"POSITION", file.places(moves * motion)}});
    mesh["primitives"].push_back(std::move(primitive));
  }
  if (history) add_history(*history, file, mesh["extras"]);
  std::vector<float> seconds;
  for (int step = 0; step <= gltf_steps; ++step)
    seconds.push_back(static_cast<float>(gltf_period * step / gltf_steps));
  const int times = model.modes.empty() ? -1 : file.numbers(seconds, true);
  for (const SwingModel::Mode& mode : model.modes) {
    GltfJson described{{"name", mode.name}, {"frequency_hz", mode.frequency_hz}, {"targets", {mode.real}}};
    if (mode.damping_ratio) described["damping_ratio"] = *mode.damping_ratio;
    if (mode.quadrature) described["targets"].push_back(*mode.quadrature);
    if (mode.beside) described["beside"] = *mode.beside;
    mesh["extras"]["modes"].push_back(std::move(described));
    add_animation(mode, motions, times, file);
  }
  file.json["meshes"].push_back(std::move(mesh));
  file.json["buffers"].push_back({{"byteLength", file.bytes.size()}});

  std::string text = file.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append_bytes(bytes, std::uint32_t{2});
  append_bytes(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + file.bytes.size()));
  append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append_bytes(bytes, static_cast<std::uint32_t>(file.bytes.size()));
  bytes.append("BIN\0", 4);
  return bytes + file.bytes;
}

}  // namespace

std::string binary_gltf(const SwingModel& model) {
  if (model.modes.empty()) throw std::invalid_argument("a model without modes; expected one at least");
  return written(model, nullptr);
}

std::string binary_gltf(const SwingModel& model, const MotionHistory& history) {
  const auto motions = static_cast<Eigen::Index>(model.parts.empty() ? 0 : model.parts[0].motion.size());
  if (history.time.size() == 0 || history.weights.rows() != motions ||
      history.weights.cols() != history.time.size())
    throw std::invalid_argument(
        fmt::format("a motion of {} samples with {} x {} weights; expected {} x the samples, one at least",
                    history.time.size(), history.weights.rows(), history.weights.cols(), motions));
  return written(model, &history);
}

}  // namespace beamid::experiments
